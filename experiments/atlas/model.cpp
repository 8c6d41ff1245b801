module aabblab.atlas;

import aabblab.fmt;
import aabblab.numbers;
import aabblab.progress;

namespace aabblab {

namespace {

/// A term of the cost model: a count per frame, computed from a scene's measures.
struct term {
    std::string_view name;
    double (*count)(const scene_measures& m);
};

double objects(const scene_measures& m) {
    return static_cast<double>(m.objects);
}
double pairs(const scene_measures& m) {
    return objects(m) * m.pairs_per_object;
}
/// About the share of neighbours that are new in a frame: their relative motion in typical extents, at most 1.
double renewed(const scene_measures& m) {
    if (!m.motion || m.boxes.typical_extent <= 0) return 0;
    return std::min(1.0, m.motion->relative_displacement / m.boxes.typical_extent);
}

constexpr std::array<term, 9> terms{{
    {"frame", [](const scene_measures&) { return 1.0; }},
    {"object", objects},
    {"object log2", [](const scene_measures& m) { return objects(m) * std::log2(std::max(objects(m), 1.0)); }},
    {"pair", pairs},
    {"inversion", [](const scene_measures& m) { return m.motion ? objects(m) * m.motion->inversions : 0; }},
    {"swept pair", [](const scene_measures& m) { return objects(m) * std::ranges::min(m.boxes.overlaps) / 2; }},
    {"object moved", [](const scene_measures& m) { return m.motion ? objects(m) * (1 - m.motion->at_rest) : 0; }},
    {"object renewed", [](const scene_measures& m) { return objects(m) * renewed(m); }},
    {"pair renewed", [](const scene_measures& m) { return pairs(m) * renewed(m); }},
}};

std::vector<double> work_of(const scene_measures& m) {
    std::vector<double> work;
    for (const term& t : terms) work.push_back(t.count(m));
    return work;
}

/// What the cost model of a candidate is fitted to or tested by: its time in ns and its work, for each scene.
/// @param held_out takes the scenes that are kept out of the fit, instead of those of the map
std::vector<timed_work> observations_of(const std::vector<atlas_scene>& atlas, std::string_view label, bool held_out) {
    std::vector<timed_work> observations;
    for (const atlas_scene& scene : atlas) {
        const atlas_candidate* candidate = scene.find(label);
        if (!candidate || scene.is_held_out != held_out) continue;
        // One observation per scene gives each the same weight, whatever its repeats.
        observations.push_back(
            {scene.scene.kind + " " + settings_text(scene.scene), work_of(scene.measures), {1e6 * candidate->ms()}});
    }
    return observations;
}

/// The time per frame that a cost model predicts, in ns.
double predicted_ns(const std::vector<estimate>& costs, const scene_measures& m) {
    double ns = 0;
    const std::vector<double> work = work_of(m);
    for (std::size_t i = 0; i < work.size(); ++i) ns += costs[i].value * work[i];
    return ns;
}

}  // namespace

/// Fits a linear cost model (ns per box, pair and so on) to each candidate with more scenes than terms, and tests it.
std::vector<candidate_model> models_of(const std::vector<atlas_scene>& atlas) {
    std::vector<candidate_model> models;
    const std::vector<std::string> labels = labels_of(atlas);
    progress shown("fitting costs", labels.size());
    for (std::size_t i = 0; i < labels.size(); ++i) {
        const std::string& label = labels[i];
        shown.update(i);
        const std::vector<timed_work> in_map = observations_of(atlas, label, /*held_out=*/false);
        if (in_map.size() <= terms.size()) continue;
        candidate_model m{label, fit_costs(in_map)};
        m.in_map = accuracy_of(in_map, m.costs);
        if (const std::vector<timed_work> held_out = observations_of(atlas, label, /*held_out=*/true);
            !held_out.empty())
            m.held_out = accuracy_of(held_out, m.costs);
        models.push_back(std::move(m));
    }
    return models;
}

/// One row per candidate: the factor by which its model is off, median and worst, in the map and in unseen scenes.
table models_table(const std::vector<candidate_model>& models) {
    table t = empty_table({"candidate"}, {"scenes", "off by", "worst", "unseen scenes", "off by there", "worst there"});
    for (const candidate_model& m : models)
        t.rows.push_back({m.label, grouped(m.in_map.observations), fmt::format("{:.2f}", m.in_map.median),
                          fmt::format("{:.1f}", m.in_map.worst), grouped(m.held_out.observations),
                          fmt::format("{:.2f}", m.held_out.median), fmt::format("{:.1f}", m.held_out.worst)});
    return t;
}

/// One row per candidate: each cost of its linear model in ns per unit, and its 95 % interval, which is not negative.
table costs_table(const std::vector<candidate_model>& models) {
    table t = empty_table({"candidate"});
    for (const term& cost : terms)
        for (const char* part : {"", " low", " high"}) t.columns.push_back({std::string(cost.name) + part});
    for (const candidate_model& m : models) {
        std::vector<std::string>& cells = t.rows.emplace_back(std::vector{m.label});
        for (const estimate& cost : m.costs)
            for (const double ns : {cost.value, std::max(0.0, cost.range().low), cost.range().high})
                cells.push_back(fmt::format("{:.4g}", ns));
    }
    return t;
}

/// The loss by relying on cost models in scenes held out: the time of the predicted winner over that of the fastest.
std::vector<double> regrets_of_models(const std::vector<atlas_scene>& atlas,
                                      const std::vector<candidate_model>& models) {
    std::vector<double> regrets;
    for (const atlas_scene& scene : atlas) {
        if (!scene.is_held_out) continue;
        const atlas_candidate* chosen = nullptr;
        double least_ns = std::numeric_limits<double>::infinity();
        for (const candidate_model& m : models) {
            const atlas_candidate* candidate = scene.find(m.label);
            const double ns = predicted_ns(m.costs, scene.measures);
            if (!candidate || candidate->is_automatic || ns >= least_ns) continue;
            chosen = candidate;
            least_ns = ns;
        }
        if (chosen) regrets.push_back(chosen->ms() / scene.fastest().ms());
    }
    return regrets;
}

}  // namespace aabblab
