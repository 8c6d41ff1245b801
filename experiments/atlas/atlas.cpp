module aabblab.atlas;

import aabb.policy;
import aabb.registry;
import aabblab.metrics;

namespace aabblab {

namespace {

/// The scene with the defaults of its run in place of today's.
scene_choice completed(scene_choice scene, const scene_defaults& defaults) {
    for (const aabb::setting& s : defaults.parameters)
        if (std::ranges::find(scene.settings, s.name, &aabb::setting::name) == scene.settings.end())
            scene.settings.push_back(s);
    return scene;
}

}  // namespace

std::string label_of(candidate_name name) {
    std::ranges::replace(name.choices.all, "none", "");
    return name.engine.empty() ? label_of(name.choices) : name.engine;
}

bool is_timed(const row& r) {
    return r.status == "exact" && measured("frame_cpu_ms")(r).value_or(0) > 0 &&
           measured("whole_cpu_ms")(r).value_or(0) > 0;
}

const atlas_candidate* atlas_scene::find(std::string_view label) const {
    const auto candidate = std::ranges::find(candidates, label, &atlas_candidate::label);
    return candidate != candidates.end() ? &*candidate : nullptr;
}

const atlas_candidate* atlas_scene::fastest_if(const std::function<bool(const atlas_candidate&)>& matches,
                                               atlas_time time) const {
    const atlas_candidate* fastest = nullptr;
    for (const atlas_candidate& candidate : candidates)
        if (!candidate.is_automatic && matches(candidate) && (!fastest || candidate.ms(time) < fastest->ms(time)))
            fastest = &candidate;
    return fastest;
}

double atlas_scene::least_ms(atlas_time time) const {
    double least = std::numeric_limits<double>::infinity();
    for (const atlas_candidate& candidate : candidates) least = std::min(least, candidate.ms(time));
    return least;
}

double atlas_scene::number(std::string_view parameter) const {
    const std::vector<aabb::setting> settings = completed(scene, defaults).settings;
    const auto set = std::ranges::find(settings, parameter, &aabb::setting::name);
    if (set != settings.end()) return number_or_nan(set->value);
    const std::vector<aabb::parameter_info>& parameters = scene_named(scene.kind).parameters;
    const auto info = std::ranges::find(parameters, parameter, &aabb::parameter_info::name);
    return info != parameters.end() ? number_or_nan(info->fallback) : std::numeric_limits<double>::quiet_NaN();
}

/// The atlas without candidates with the partition `columns`, which wins nearly every scene, and without `auto`, which
/// selects it: for maps that compare the others. Scenes without a candidate are left out.
std::vector<atlas_scene> without_columns(std::vector<atlas_scene> atlas) {
    for (atlas_scene& scene : atlas)
        std::erase_if(scene.candidates, [](const atlas_candidate& candidate) {
            return candidate.is_automatic || candidate.label.find("columns") != std::string::npos;
        });
    std::erase_if(atlas, [](const atlas_scene& scene) { return scene.candidates.empty(); });
    return atlas;
}

/// Repeats are paired: candidates take turns within each, so that both met the same speed of the machine.
estimate log_ratio(const atlas_candidate& candidate, const atlas_candidate& baseline) {
    cells ratios(/*processes=*/1, /*seeds=*/1);
    for (std::size_t repeat = 0; repeat < std::min(candidate.frame_ms.size(), baseline.frame_ms.size()); ++repeat)
        ratios.add(0, 0, std::log(candidate.frame_ms[repeat] / baseline.frame_ms[repeat]));
    return bootstrap(ratios);
}

/// Groups the exact, timed rows of an experiment by scene and by candidate (composition or engine), a time per repeat.
/// Scenes in which only `auto` was timed are left out, since `auto` cannot win.
/// @param is_held_out whether the scenes are outside the map, or kept out of fits
std::vector<atlas_scene> read_atlas(const std::filesystem::path& folder, bool is_held_out) {
    std::vector<atlas_scene> atlas;
    const std::vector<scene_defaults> defaults = read_scene_defaults(folder);
    const std::optional<recorded_measures> recorded = read_measures(folder);
    std::map<scene_choice, std::size_t> indices;
    for (const row& r : verified_rows(folder)) {
        if (!is_timed(r)) continue;
        const auto [index, is_new] = indices.emplace(r.scene, atlas.size());
        if (is_new) {
            const auto stated = std::ranges::find(defaults, r.scene.kind, &scene_defaults::kind);
            const scene_defaults of_kind = stated != defaults.end() ? *stated : scene_defaults();
            const scene_measures measures =
                recorded ? recorded->of(r.scene) : measure_scene(completed(r.scene, of_kind));
            atlas.push_back({r.scene, is_held_out, measures, {}, of_kind});
        }
        std::vector<atlas_candidate>& candidates = atlas[index->second].candidates;
        const std::string label = label_of(r.name);
        auto candidate = std::ranges::find(candidates, label, &atlas_candidate::label);
        if (candidate == candidates.end()) candidate = candidates.emplace(candidate, label, r.name.is_automatic());
        candidate->frame_ms.push_back(*measured("frame_cpu_ms")(r));
        candidate->whole_ms.push_back(*measured("whole_cpu_ms")(r));
    }
    std::erase_if(atlas,
                  [](const auto& s) { return std::ranges::all_of(s.candidates, &atlas_candidate::is_automatic); });
    return atlas;
}

}  // namespace aabblab
