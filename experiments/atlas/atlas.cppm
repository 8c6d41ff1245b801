/// An atlas of the fastest composition or engine per scene, computed from the rows of experiments, with the regret of
/// using one of them everywhere, the borders between winners, and verdicts on published statements.
export module aabblab.atlas;

import aabb.std;
import aabblab.calibrate;
import aabblab.figures;
import aabblab.measures;
import aabblab.results;
import aabblab.scenes;
import aabblab.statistics;
import aabblab.tables;

export namespace aabblab {

enum class atlas_time : unsigned char {
    per_frame,  ///< the mean per frame after the first
    whole_run   ///< all frames, including the construction of the stages
};

/// The times of one composition or engine in one scene, by repeat; early stopping leaves slow candidates one repeat.
struct atlas_candidate {
    std::string label;  ///< its strategies other than `none`: "bucket + columns + simd"
    bool is_automatic = false;
    std::vector<double> frame_ms{}, whole_ms{};

    [[nodiscard]] const std::vector<double>& times(atlas_time time) const {
        return time == atlas_time::per_frame ? frame_ms : whole_ms;
    }
    /// The median over repeats.
    [[nodiscard]] double ms(atlas_time time = atlas_time::per_frame) const { return quartiles_of(times(time)).median; }
};

struct atlas_scene {
    scene_choice scene;
    bool is_held_out = false;  ///< not in the map, but kept to test models that are fitted to the map
    scene_measures measures;
    std::vector<atlas_candidate> candidates;  ///< exact ones
    scene_defaults defaults{};                ///< of its parameters when it was run; empty in older results

    /// Null if the scene has no such candidate.
    [[nodiscard]] const atlas_candidate* find(std::string_view label) const;
    /// The one with the least time per frame of those that match, except `auto`, which is no fixed composition; null if
    /// none matches.
    [[nodiscard]] const atlas_candidate* fastest_if(const std::function<bool(const atlas_candidate&)>& matches) const;
    [[nodiscard]] const atlas_candidate& fastest() const {
        return *fastest_if([](const atlas_candidate&) { return true; });
    }
    /// The least time of any candidate, including `auto`.
    [[nodiscard]] double least_ms(atlas_time time) const;
    /// A parameter of the scene as a number, by default its default value; NaN if the scene has no such parameter.
    [[nodiscard]] double number(std::string_view parameter) const;
};

/// The scenes without `columns`, which wins nearly everywhere, and without `auto`, which selects it.
[[nodiscard]] std::vector<atlas_scene> without_columns(std::vector<atlas_scene> atlas);

/// The logarithm of the ratio of two candidates' times per frame, over the repeats that both have.
[[nodiscard]] estimate log_ratio(const atlas_candidate& candidate, const atlas_candidate& baseline);

/// Reads the scenes of an experiment from its results folder. Each scene is generated again to compute its measures.
[[nodiscard]] std::vector<atlas_scene> read_atlas(const std::filesystem::path& folder, bool is_held_out);

/// The numbers of scenes in which each composition or engine is the fastest, one row each.
[[nodiscard]] table winners_table(const std::vector<atlas_scene>& atlas);
/// One row per scene: its measures, the fastest, the lead over the second, and the ratio of `auto` to the fastest.
[[nodiscard]] table cells_table(const std::vector<atlas_scene>& atlas);
/// The regret of using one of them everywhere, relative to the fastest of each scene, including `auto`.
[[nodiscard]] table regrets_table(const std::vector<atlas_scene>& atlas, atlas_time time);

/// The value of one parameter, all others equal, at which the fastest of one scene and of the next swap places.
/// Candidates that differ only in parameters, such as the skin of a Verlet list, count as one, their fastest.
struct border {
    std::string before, after, parameter;
    std::string others;  ///< the other settings of the scene
    double position = 0;
    interval range{};  ///< 95 %, clamped to the two scenes
};
[[nodiscard]] std::vector<border> borders_of(const std::vector<atlas_scene>& atlas);
[[nodiscard]] table borders_table(const std::vector<border>& borders);
/// One row for all borders between the same two candidates along the same parameter.
[[nodiscard]] table borders_summary(const std::vector<border>& borders);

/// One ratio on which the verdict on a statement depends.
struct judged_ratio {
    std::string where;       ///< the scenes: "10,000 boxes, a tenth moves"
    std::string candidates;  ///< "bullet_sap over bullet_dbvt"
    std::size_t scenes = 0;
    double ratio = 0;
    interval range{};
    support verdict = support::undecided;
};
struct judged_statement {
    std::string id, source, says;
    verdict_kind verdict = verdict_kind::undecided;
    std::vector<judged_ratio> ratios{};
};
/// Verdicts on published statements about broad phases, by the same rule as claims of the paper: ratios of times per
/// frame, geometric means over scenes, decided as one family.
[[nodiscard]] std::vector<judged_statement> judged_statements(const std::vector<atlas_scene>& atlas);
[[nodiscard]] table statements_table(const std::vector<judged_statement>& judged);
[[nodiscard]] table ratios_table(const std::vector<judged_statement>& judged);
[[nodiscard]] std::vector<std::string> labels_in_statements();

/// A linear cost model of the time per frame: the costs of the terms that a scene's measures count, fitted to the
/// scenes of the map, and the factor by which it is off there and in the scenes held out.
struct candidate_model {
    std::string label;
    std::vector<estimate> costs;  ///< ns per unit of each term
    accuracy in_map{};
    accuracy held_out{};
};
[[nodiscard]] std::vector<candidate_model> models_of(const std::vector<atlas_scene>& atlas);
[[nodiscard]] table models_table(const std::vector<candidate_model>& models);
[[nodiscard]] table costs_table(const std::vector<candidate_model>& models);
/// The regret of choosing the candidate with the least predicted time, in each held-out scene.
[[nodiscard]] std::vector<double> regrets_of_models(const std::vector<atlas_scene>& atlas,
                                                    const std::vector<candidate_model>& models);

[[nodiscard]] std::vector<figure> atlas_figures(const std::vector<atlas_scene>& atlas);

/// Writes the figures, atlas.md and atlas.html to the folder, and as CSV every table, also those that the page omits.
void write_atlas(const std::filesystem::path& folder, const std::vector<atlas_scene>& atlas);

}  // namespace aabblab

// Shared by the units of the module.
namespace aabblab {

/// All labels, in the order of their first appearance.
[[nodiscard]] inline std::vector<std::string> labels_of(const std::vector<atlas_scene>& atlas) {
    std::vector<std::string> labels;
    for (const atlas_scene& scene : atlas)
        for (const atlas_candidate& candidate : scene.candidates)
            if (std::ranges::find(labels, candidate.label) == labels.end()) labels.push_back(candidate.label);
    return labels;
}

/// The strategies in a label without their parameters: "neighbour_list + bucket + columns + simd".
[[nodiscard]] inline std::string family_of(std::string_view label) {
    std::string family;
    for (std::size_t i = 0; i < label.size(); ++i) {
        if (label[i] == ':') i = std::min(label.find(' ', i), label.size());
        if (i < label.size()) family += label[i];
    }
    return family;
}

/// A candidate's regrets, its time over that of the fastest, in the scenes in which it was timed, ascending.
[[nodiscard]] inline std::vector<double> regrets_of(const std::vector<atlas_scene>& atlas, const std::string& label,
                                                    atlas_time time) {
    std::vector<double> regrets;
    for (const atlas_scene& scene : atlas)
        if (const atlas_candidate* candidate = scene.find(label))
            regrets.push_back(candidate->ms(time) / scene.least_ms(time));
    std::ranges::sort(regrets);
    return regrets;
}

/// The logarithm of the ratio of two candidates' times per frame in a scene, with its standard error. Without repeats,
/// as after early stopping, the error is √(2 s²), with the variance s² of logarithms pooled over all candidates of the
/// scene; NaN if none was repeated.
[[nodiscard]] inline estimate log_ratio_in(const atlas_scene& scene, const atlas_candidate& candidate,
                                           const atlas_candidate& baseline) {
    const estimate of_repeats = log_ratio(candidate, baseline);
    if (of_repeats.error > 0) return of_repeats;
    double squares = 0, degrees = 0;
    for (const atlas_candidate& any : scene.candidates) {
        const auto count = static_cast<double>(any.frame_ms.size());
        double mean = 0;
        for (const double ms : any.frame_ms) mean += std::log(ms) / count;
        for (const double ms : any.frame_ms) squares += (std::log(ms) - mean) * (std::log(ms) - mean);
        degrees += count - 1;
    }
    if (degrees == 0) return {.value = std::nan("")};
    return {of_repeats.value, std::sqrt(2 * squares / degrees), degrees};
}

}  // namespace aabblab
