module aabblab.atlas;

import aabb.policy;
import aabb.registry;
import aabblab.metrics;

namespace aabblab {

namespace {

std::string label_of(candidate_name name) {
    std::ranges::replace(name.choices.all, "none", "");
    return name.engine.empty() ? text_in_line(name.choices) : name.engine;
}

}  // namespace

const atlas_line* atlas_scene::find(std::string_view label) const {
    const auto line = std::ranges::find(lines, label, &atlas_line::label);
    return line != lines.end() ? &*line : nullptr;
}

const atlas_line& atlas_scene::fastest(span_of_time of) const {
    const atlas_line* best = nullptr;
    for (const atlas_line& line : lines)
        if (!line.automatic && (!best || line.ms(of) < best->ms(of))) best = &line;
    return *best;
}

double atlas_scene::least_ms(span_of_time of) const {
    double least = fastest(of).ms(of);
    for (const atlas_line& line : lines) least = std::min(least, line.ms(of));
    return least;
}

double atlas_scene::number(std::string_view parameter) const {
    const auto set = std::ranges::find(scene.settings, parameter, &aabb::setting::name);
    if (set != scene.settings.end()) return number_or_nan(set->value);
    const std::vector<aabb::parameter_info>& parameters = scene_named(scene.kind).parameters;
    const auto info = std::ranges::find(parameters, parameter, &aabb::parameter_info::name);
    return info != parameters.end() ? number_or_nan(info->fallback) : std::numeric_limits<double>::quiet_NaN();
}

std::vector<atlas_scene> without_columns(std::vector<atlas_scene> atlas) {
    for (atlas_scene& scene : atlas)
        std::erase_if(scene.lines, [](const atlas_line& line) {
            return line.automatic || line.label.find("columns") != std::string::npos;
        });
    std::erase_if(atlas, [](const atlas_scene& scene) { return scene.lines.empty(); });
    return atlas;
}

estimate log_ratio(const atlas_line& arm, const atlas_line& base, span_of_time of) {
    cells ratios(1, 1);
    const std::vector<double>& above = arm.times(of);
    const std::vector<double>& below = base.times(of);
    for (std::size_t repeat = 0; repeat < std::min(above.size(), below.size()); ++repeat)
        ratios.add(0, 0, std::log(above[repeat] / below[repeat]));
    return bootstrap(ratios);
}

std::vector<atlas_scene> read_atlas(const std::filesystem::path& folder, bool unseen) {
    const row_value& frame = measured("frame_ms");
    const row_value& whole = measured("whole_ms");
    std::vector<atlas_scene> atlas;
    std::map<scene_choice, std::size_t> places;
    for (const row& r : verified_rows(folder)) {
        const std::optional<double> frame_ms = frame(r);
        const std::optional<double> whole_ms = whole(r);
        if (r.status != "exact" || frame_ms.value_or(0) <= 0 || whole_ms.value_or(0) <= 0) continue;
        const auto [place, is_new] = places.emplace(r.scene, atlas.size());
        if (is_new) atlas.push_back({r.scene, unseen, measure_scene(r.scene), {}});
        std::vector<atlas_line>& lines = atlas[place->second].lines;
        const std::string label = label_of(r.name);
        auto line = std::ranges::find(lines, label, &atlas_line::label);
        if (line == lines.end()) line = lines.insert(line, {label, r.name.is_automatic(), {}, {}});
        line->frame_ms.push_back(*frame_ms);
        line->whole_ms.push_back(*whole_ms);
    }
    std::erase_if(atlas, [](const atlas_scene& s) { return std::ranges::all_of(s.lines, &atlas_line::automatic); });
    return atlas;
}

}  // namespace aabblab
