module aabblab.atlas;

import aabb.policy;
import aabb.registry;
import aabblab.metrics;

namespace aabblab {

namespace {

/// The name of an engine, or the strategies of a composition other than `none`.
std::string label_of(candidate_name name) {
    std::ranges::replace(name.choices.all, "none", "");
    return name.engine.empty() ? text_in_line(name.choices) : name.engine;
}

}  // namespace

const atlas_line* atlas_scene::find(std::string_view label) const {
    const auto line = std::ranges::find(lines, label, &atlas_line::label);
    return line != lines.end() ? &*line : nullptr;
}

const atlas_line* atlas_scene::fastest_if(span_of_time span,
                                          const std::function<bool(const atlas_line&)>& matches) const {
    const atlas_line* fastest = nullptr;
    for (const atlas_line& line : lines)
        if (!line.automatic && matches(line) && (!fastest || line.ms(span) < fastest->ms(span))) fastest = &line;
    return fastest;
}

double atlas_scene::least_ms(span_of_time span) const {
    double least = fastest(span).ms(span);
    for (const atlas_line& line : lines) least = std::min(least, line.ms(span));
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

estimate log_ratio(const atlas_line& arm, const atlas_line& base, span_of_time span) {
    cells ratios(1, 1);
    const std::vector<double>& arm_ms = arm.times(span);
    const std::vector<double>& base_ms = base.times(span);
    for (std::size_t repeat = 0; repeat < std::min(arm_ms.size(), base_ms.size()); ++repeat)
        ratios.add(0, 0, std::log(arm_ms[repeat] / base_ms[repeat]));
    return bootstrap(ratios);
}

std::vector<atlas_scene> read_atlas(const std::filesystem::path& folder, bool unseen) {
    std::vector<atlas_scene> atlas;
    std::map<scene_choice, std::size_t> places;
    for (const row& r : verified_rows(folder)) {
        const std::optional<double> frame_ms = measured("frame_ms")(r);
        const std::optional<double> whole_ms = measured("whole_ms")(r);
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
