module aabblab.atlas;

import aabb.policy;

namespace aabblab {

namespace {

/// The logarithm of 1 + p, with p pairs per box: without a list, a frame costs a search per box; with one, a test per
/// listed pair, and a search whenever boxes have moved by the skin (Chialvo and Debenedetti 1990). More pairs favour
/// the search.
double log_of_tested_boxes(const scene_measures& m) {
    return std::log1p(m.pairs_per_object);
}

/// The logarithm of the longest edge over the median one. Where sizes differ, most pairs have a large box, to whose
/// pairs the skin adds few, so that lists are worth their cost for longer.
double log_of_size_ratio(const scene_measures& m) {
    return std::log(m.boxes.size_ratio.value_or(1));
}

/// The logarithm of the inversions per box and frame over the two thirds power of the number of boxes n, on which they
/// do not depend: a box passes those in its displacement, of n per n^(1/3) mean spacings along the axis.
double log_of_inversions(const scene_measures& m) {
    const double inversions = m.motion ? m.motion->inversions : 0;
    return std::log(inversions) - 2.0 / 3 * std::log(static_cast<double>(m.objects));
}

double squared_log_of_inversions(const scene_measures& m) {
    return log_of_inversions(m) * log_of_inversions(m);
}

/// The settings of a scene without one parameter: scenes in which these agree differ in that parameter only.
std::string settings_without(const scene_choice& scene, std::string_view parameter) {
    scene_choice others = scene;
    std::erase_if(others.settings, [&](const aabb::setting& s) { return s.name == parameter || s.name == "frames"; });
    return settings_text(others);
}

/// A scene of a row: the parameter that grows along it, and how the candidates compare.
struct place {
    double value = 0;
    double log_ratio = 0;  ///< of the time of those that are faster below over that of the others
    const atlas_scene* scene = nullptr;
};

/// The fastest candidate with these strategies, whatever their parameters; null if the scene has none.
const atlas_candidate* fastest_of(const atlas_scene& scene, const std::string& family, atlas_time time) {
    return scene.fastest_if([&](const atlas_candidate& candidate) { return family_of(candidate.label) == family; },
                            time);
}

/// The scene's place in its row; none if the candidates were not both timed in it.
std::optional<place> place_of(const border_kind& kind, const atlas_scene& scene) {
    const atlas_candidate* before = fastest_of(scene, kind.before, kind.time);
    const atlas_candidate* after = fastest_of(scene, kind.after, kind.time);
    const double value = scene.number(kind.parameter);
    if (!before || !after || !(value > 0)) return std::nullopt;
    return place{value, std::log(before->ms(kind.time) / after->ms(kind.time)), &scene};
}

/// The number of places below the border. Noise may let the ratio cross 1 several times: the border is where the ratios
/// on the wrong side of 1 are the least, as a sum of logarithms.
std::size_t places_below(std::span<const place> row) {
    double wrong = 0;
    for (const place& p : row) wrong += std::max(0.0, -p.log_ratio);
    double least = wrong;
    std::size_t below = 0;
    for (std::size_t i = 0; i < row.size(); ++i) {
        wrong += row[i].log_ratio;  // place i moves below: it is wrong above 0 instead of below 0
        if (wrong >= least) continue;
        least = wrong;
        below = i + 1;
    }
    return below;
}

/// The value at which the ratio is 1, interpolated between the logarithms of both sides.
double position_in(std::span<const place> row) {
    const std::size_t below = places_below(row);
    if (below == 0) return 0;
    if (below == row.size()) return std::numeric_limits<double>::infinity();
    const place& from = row[below - 1];
    const place& to = row[below];
    // The logarithms are below 0 at `from` and not at `to`, otherwise another split would be less wrong.
    const double share = from.log_ratio / (from.log_ratio - to.log_ratio);
    return from.value * std::pow(to.value / from.value, share);
}

}  // namespace

const std::vector<border_kind>& border_kinds() {
    static const std::vector<border_kind> kinds{
        // The whole time: the first frame makes the first list.
        {"list_borders",
         "neighbour_list + bucket + columns + simd",
         "bucket + columns + simd",
         "displacement",
         atlas_time::whole_run,
         {{"ln(1 + p)", log_of_tested_boxes}, {"ln r", log_of_size_ratio}}},
        // Insertion sort pays i n^(2/3) inversions per box, radix sort a fixed cost per box and one per sort. Where
        // these are equal, n falls as i^(-3/2) if the former decides, and as i^(-3/5) if the latter does: a curve, here
        // to second order.
        {"sort_borders",
         "insertion + simd",
         "radix + simd",
         "objects",
         atlas_time::per_frame,
         {{"ln i", log_of_inversions}, {"(ln i)^2", squared_log_of_inversions}}}};
    return kinds;
}

/// A border for each row of scenes whose parameters are equal but one. The terms are those of its last scene, which has
/// the most boxes if their number grows, so that its measures have the least sampling error.
std::vector<border> borders_of(const border_kind& kind, const std::vector<atlas_scene>& scenes) {
    std::map<std::pair<bool, std::string>, std::vector<place>> rows;
    for (const atlas_scene& scene : scenes)
        if (const std::optional<place> p = place_of(kind, scene))
            rows[{scene.is_held_out, settings_without(scene.scene, kind.parameter)}].push_back(*p);
    std::vector<border> borders;
    for (auto& [key, row] : rows) {
        std::ranges::sort(row, {}, &place::value);
        border b{key.second, key.first, position_in(row), {row.front().value, row.back().value}, {1.0}};
        for (const border_term& term : kind.terms) b.terms.push_back(term.value(row.back().scene->measures));
        if (std::ranges::all_of(b.terms, [](double t) { return std::isfinite(t); })) borders.push_back(std::move(b));
    }
    return borders;
}

}  // namespace aabblab
