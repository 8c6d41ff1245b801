module aabblab.atlas;

import aabblab.fmt;

namespace aabblab {

namespace {

constexpr const char* kind_of_map = "cloud";

/// The strategies that win the most scenes, in descending order: the series of figures, besides "another".
std::vector<std::string> most_frequent_winners(const std::vector<atlas_scene>& atlas) {
    constexpr std::size_t most_series = 7;
    std::map<std::string, std::size_t> wins;
    for (const atlas_scene& scene : atlas) ++wins[family_of(scene.fastest().label)];
    std::vector<std::string> labels;
    for (const auto& [label, count] : wins) labels.push_back(label);
    std::ranges::stable_sort(labels, [&](const auto& a, const auto& b) { return wins[a] > wins[b]; });
    if (labels.size() > most_series) labels.resize(most_series);
    return labels;
}

/// One series per winner; every panel has all of them, so that a winner looks the same in all panels.
std::vector<series> empty_series(const std::vector<std::string>& winners) {
    std::vector<series> lines;
    for (const std::string& label : winners) lines.push_back({label, series_style::points});
    lines.push_back({"another", series_style::points});
    return lines;
}

void add_point(std::vector<series>& to, const std::string& winner, double x, double y) {
    const auto match = std::ranges::find(to, winner, &series::label);
    (match != to.end() ? *match : to.back()).points.push_back({x, y});
}

/// A map of the fastest candidates in the scene `cloud`, by objects and displacement, a panel per density and sizes.
/// @param winners the strategies with a series of their own
/// @param clouds only scenes with this number of separate clouds, and in which all boxes move
/// @param among empty, or text that names the restricted set of candidates
figure map_of(const std::vector<atlas_scene>& atlas, const std::vector<std::string>& winners, double clouds,
              const std::string& among) {
    figure f{.name = fmt::format("map_{}{:g}", among.empty() ? "" : "classic_", clouds),
             .caption = fmt::format(
                 "The fastest{} in frames after the first, in {}. Each point is a scene, placed by its number "
                 "of objects and their displacement per frame.",
                 among, clouds > 1 ? fmt::format("{:g} separate clouds", clouds) : "one cloud"),
             .x = {"objects", /*logarithmic=*/true},
             .y = {"displacement per frame (mean extents)", /*logarithmic=*/true}};
    std::map<std::pair<double, double>, figure_panel> panels;  // by density and ratio
    for (const atlas_scene& scene : atlas) {
        if (scene.scene.kind != kind_of_map || scene.number("clouds") != clouds || scene.number("moving") != 1)
            continue;
        const std::pair key{scene.number("density"), scene.number("ratio")};
        const auto [panel, is_new] = panels.try_emplace(key);
        if (is_new)
            panel->second = {fmt::format("density {:g}, sizes 1 to {:g}", key.first, key.second),
                             empty_series(winners)};
        add_point(panel->second.lines, family_of(scene.fastest().label), scene.number("objects"),
                  scene.number("displacement"));
    }
    for (auto& [key, panel] : panels) f.panels.push_back(std::move(panel));
    return f;
}

/// A map of the fastest candidates in all scenes in motion, by measures that every kind of scene has.
/// @param winners,among as in `map_of`
figure inversions_map(const std::vector<atlas_scene>& atlas, const std::vector<std::string>& winners,
                      const std::string& among) {
    figure f{.name = among.empty() ? "map_inversions" : "map_classic_inversions",
             .caption = "The fastest" + among +
                        " in frames after the first, in all scenes with motion. Each point is a scene, placed by its "
                        "number of objects and by the inversions on the axis on which boxes overlap least.",
             .x = {"objects", /*logarithmic=*/true},
             .y = {"inversions per object and frame", /*logarithmic=*/true},
             .lines = empty_series(winners)};
    for (const atlas_scene& scene : atlas)
        if (scene.measures.motion && scene.measures.motion->inversions > 0)
            add_point(f.lines, family_of(scene.fastest().label), static_cast<double>(scene.measures.objects),
                      scene.measures.motion->inversions);
    return f;
}

/// The regrets (time over that of the fastest) of using one candidate in all scenes, in ascending order: one curve for
/// each of the candidates with the least medians. Candidates must have been timed in half of the scenes.
figure regret_figure(const std::vector<atlas_scene>& atlas) {
    constexpr std::size_t most_curves = 7;
    constexpr std::size_t least_scenes = 2;
    figure f{.name = "regret",
             .caption =
                 "Regret of using one composition or engine everywhere: its time per frame relative to that of "
                 "the fastest, scene by scene in ascending order.",
             .x = {"share of the scenes"},
             .y = {"regret", /*logarithmic=*/true}};
    for (const std::string& label : labels_of(atlas)) {
        const std::vector<double> regrets = regrets_of(atlas, label, atlas_time::per_frame);
        if (regrets.size() < std::max(least_scenes, atlas.size() / 2)) continue;
        series curve{label};
        for (std::size_t i = 0; i < regrets.size(); ++i)
            curve.points.push_back({(static_cast<double>(i) + 0.5) / static_cast<double>(regrets.size()), regrets[i]});
        f.lines.push_back(std::move(curve));
    }
    std::ranges::stable_sort(f.lines, {}, [](const series& s) { return s.points[s.points.size() / 2].y; });
    if (f.lines.size() > most_curves) f.lines.resize(most_curves);
    return f;
}

/// Adds a map for each number of clouds that occurs, and the map of all scenes in motion.
void add_maps(std::vector<figure>& figures, const std::vector<atlas_scene>& atlas, const std::string& among) {
    const std::vector<std::string> winners = most_frequent_winners(atlas);
    std::vector<double> clouds;
    for (const atlas_scene& scene : atlas)
        if (const double n = scene.number("clouds");
            scene.scene.kind == kind_of_map && std::ranges::find(clouds, n) == clouds.end())
            clouds.push_back(n);
    for (const double n : clouds) figures.push_back(map_of(atlas, winners, n, among));
    figures.push_back(inversions_map(atlas, winners, among));
}

}  // namespace

/// The maps of the fastest candidates, and the curves of their regrets.
std::vector<figure> atlas_figures(const std::vector<atlas_scene>& atlas) {
    std::vector<figure> figures;
    add_maps(figures, atlas, /*among=*/"");
    // Columns win nearly everywhere: a second set of maps compares the others.
    if (const auto others = without_columns(atlas); !others.empty())
        add_maps(figures, others, " of the candidates without columns");
    figures.push_back(regret_figure(atlas));
    return figures;
}

}  // namespace aabblab
