/// An atlas of the fastest composition or engine per scene, computed from the rows of experiments, with the regret of
/// using one of them everywhere, laws of the borders between two of them, and verdicts on published statements. Times
/// are processor times of the thread.
export module aabblab.atlas;

import aabb.std;
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
    bool is_held_out = false;                 ///< not in the map, or kept to test a law that is fitted to the others
    scene_measures measures;                  ///< of recorded ones, those of measures.csv only
    std::vector<atlas_candidate> candidates;  ///< exact ones
    scene_defaults defaults{};                ///< of its parameters when it was run; empty in older results

    /// Null if the scene has no such candidate.
    [[nodiscard]] const atlas_candidate* find(std::string_view label) const;
    /// The one with the least time of those that match, except `auto`, which is no fixed composition; null if none
    /// matches.
    [[nodiscard]] const atlas_candidate* fastest_if(const std::function<bool(const atlas_candidate&)>& matches,
                                                    atlas_time time = atlas_time::per_frame) const;
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

/// Writes measures.csv beside the rows of an experiment: what the atlas uses of the measures of its scenes.
void write_measures(const std::filesystem::path& folder, std::span<const scene_choice> scenes);
/// Removes measures.csv, if it exists, since a new run may have other scenes.
void remove_measures(const std::filesystem::path& folder);

/// Reads the scenes of an experiment from its results folder. Their measures are those of measures.csv; in results of
/// earlier versions, which have no such file, each scene is generated again.
/// @throws aabb::input_error if measures.csv lacks a scene.
[[nodiscard]] std::vector<atlas_scene> read_atlas(const std::filesystem::path& folder, bool is_held_out);

/// Writes a table of the times from which all others follow: a row per exact, timed repeat in these results folders.
void write_times(const std::filesystem::path& file, std::span<const std::filesystem::path> folders);

/// The numbers of scenes in which each composition or engine is the fastest, one row each.
[[nodiscard]] table winners_table(const std::vector<atlas_scene>& atlas);
/// One row per scene: its measures, the fastest, the lead over the second, and the ratio of `auto` to the fastest.
[[nodiscard]] table cells_table(const std::vector<atlas_scene>& atlas);
/// The regret of using one of them everywhere, relative to the fastest of each scene, including `auto`.
[[nodiscard]] table regrets_table(const std::vector<atlas_scene>& atlas, atlas_time time);

/// One term of a law: a number computed from the measures of a scene.
struct border_term {
    std::string name;
    double (*value)(const scene_measures& m);
};

/// The values of a growing parameter where two candidates take the same time, and the law that predicts it. Candidates
/// that differ only in parameters, such as the skin of a Verlet list, count as one, their fastest.
struct border_kind {
    std::string name;           ///< of the config that measures it; that of its unseen scenes ends in "_unseen"
    std::string before, after;  ///< the strategies that are faster below, and above
    std::string parameter;      ///< the one that grows
    atlas_time time;
    std::vector<border_term> terms;  ///< of the logarithm of the position, besides a constant
};
[[nodiscard]] const std::vector<border_kind>& border_kinds();

/// A border among scenes that differ in one parameter only.
struct border {
    std::string settings;  ///< the other parameters
    bool is_unseen = false;
    /// The value of the parameter; 0 if the candidates that win above win in every scene, infinite if the others do.
    double position = 0;
    interval played{};          ///< the least and the greatest value of the parameter
    std::vector<double> terms;  ///< 1, and the terms of the law in the last scene
};
/// The borders of a kind among scenes that were timed to find them; none where a scene has no such measure.
[[nodiscard]] std::vector<border> borders_of(const border_kind& kind, const std::vector<atlas_scene>& scenes);

/// The logarithm of a border's position as a linear function of terms, by least squares.
struct border_law {
    const border_kind* kind = nullptr;
    std::vector<border> borders{};
    std::vector<estimate> coefficients{};  ///< of the constant and of the terms
    std::vector<double> inverse{};         ///< (X'X)^-1 by rows, with the terms of the fitted borders as rows of X
    double deviation = 0;                  ///< standard deviation of the residuals
    double degrees = 1;                    ///< of freedom

    /// The logarithm of the position that a new border with these terms has; its `range` is the prediction interval.
    [[nodiscard]] estimate predicted(std::span<const double> terms) const;
    /// Whether the 95 % prediction interval contains the position, or reaches beyond the scenes if that does.
    [[nodiscard]] bool contains(const border& b) const;
};
/// The law fitted to those borders that are not unseen and lie among their scenes; none if they do not determine it.
[[nodiscard]] std::optional<border_law> law_of(const border_kind& kind, std::vector<border> borders);
/// What the letters in formulas stand for.
inline constexpr std::string_view legend_of_laws =
    "p is the number of pairs per box, r the longest edge over the median one, i the inversions per box and frame over "
    "the two thirds power of the number of boxes.";
/// The law in words, and how many unseen borders it contains.
[[nodiscard]] std::string sentence_of(const border_law& law);
/// One row per law: its formula, the factor within which it predicts, and how many unseen borders it contains.
[[nodiscard]] table laws_table(const std::vector<border_law>& laws);
/// One row per coefficient, with its 95 % interval.
[[nodiscard]] table coefficients_table(const std::vector<border_law>& laws);
/// One row per border: its position and the prediction.
[[nodiscard]] table borders_table(const std::vector<border_law>& laws);
/// The measured over the predicted positions, a figure per law.
[[nodiscard]] std::vector<figure> border_figures(const std::vector<border_law>& laws);

/// One ratio on which the verdict on a statement depends.
struct judged_ratio {
    std::string where;       ///< the scenes: "10,000 boxes, a tenth moves"
    std::string candidates;  ///< "bullet_sap over bullet_dbvt"
    std::size_t scenes = 0;
    double ratio = 0;
    interval range{};
    support verdict = support::undecided;
};
/// A published statement about broad phases.
struct statement_text {
    std::string id;
    std::string source;    ///< author, year, title, section or file
    std::string link;      ///< empty if none is known
    std::string quote;     ///< at most a line of it
    std::string says;      ///< as it is judged
    std::string played;    ///< what stands for the algorithms of the source
    bool is_proxy = true;  ///< whether any of these is not the one that the source describes
};
struct judged_statement {
    statement_text text;
    verdict_kind verdict = verdict_kind::undecided;
    std::vector<judged_ratio> ratios{};
};
/// Verdicts on published statements about broad phases, by the same rule as claims of the paper: ratios of times per
/// frame, geometric means over scenes, decided as one family.
[[nodiscard]] std::vector<judged_statement> judged_statements(const std::vector<atlas_scene>& atlas);
/// "holds", or "holds (proxy)".
[[nodiscard]] std::string verdict_text(const judged_statement& s);
[[nodiscard]] table statements_table(const std::vector<judged_statement>& judged);
[[nodiscard]] table ratios_table(const std::vector<judged_statement>& judged);
[[nodiscard]] std::vector<std::string> labels_in_statements();

[[nodiscard]] std::vector<figure> atlas_figures(const std::vector<atlas_scene>& atlas);

/// Writes the figures, atlas.md and atlas.html to the folder, and as CSV every table, also those that the page omits.
void write_atlas(const std::filesystem::path& folder, const std::vector<atlas_scene>& atlas,
                 const std::vector<border_law>& laws);

}  // namespace aabblab

// Shared by the units of the module.
namespace aabblab {

/// The name of an engine, or the strategies of a composition other than `none`.
[[nodiscard]] std::string label_of(candidate_name name);
/// Whether a row counts: exact, with times per frame and of all frames above 0.
[[nodiscard]] bool is_timed(const row& r);

/// The measures of a measures.csv.
struct recorded_measures {
    std::filesystem::path file;
    std::map<std::string, scene_measures> by_scene;  ///< by kind, parameters and seed

    /// @throws aabb::input_error if the file lacks the scene.
    [[nodiscard]] const scene_measures& of(const scene_choice& scene) const;
};
/// Empty if there is no file.
/// @throws aabb::input_error with file and line if it is malformed.
[[nodiscard]] std::optional<recorded_measures> read_measures(const std::filesystem::path& folder);

using scene_filter = std::function<bool(const atlas_scene&)>;

/// A ratio of times over a set of scenes: of a candidate, expected to be the faster one, to another, its baseline.
struct statement_ratio {
    std::string where, candidate, baseline;
    scene_filter scenes;
    /// A divisor of the ratio, if set: the same ratio in these scenes, for statements of what a candidate suffers from.
    scene_filter reference_scenes = nullptr;
    expectation expected = expectation::less;
    double band = equivalence_band;  // of no difference: 0.05 for 1/1.05 to 1.05, 1 for 1/2 to 2
};

struct statement {
    statement_text text;
    std::vector<statement_ratio> ratios;
};

/// Published statements on broad phases, each with the ratios of times that decide it.
[[nodiscard]] const std::vector<statement>& statements();

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
