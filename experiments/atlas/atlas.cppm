/// Which composition or engine wins in which scene: a map made of the rows of experiments, with what it costs to use
/// one of them everywhere, where the borders lie, and what it says of statements of others.
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

/// What is held against what.
enum class span_of_time : unsigned char {
    frame,  ///< a frame after the first, a mean
    whole   ///< all frames, making the stages included
};

/// One composition or engine in one scene, by repeat; who was not repeated has fewer.
struct atlas_line {
    std::string label;  ///< what it is composed of, without kinds that do nothing: "bucket + columns + simd"
    bool automatic = false;
    std::vector<double> frame_ms;
    std::vector<double> whole_ms;

    [[nodiscard]] const std::vector<double>& times(span_of_time of) const {
        return of == span_of_time::frame ? frame_ms : whole_ms;
    }
    /// The median over repeats.
    [[nodiscard]] double ms(span_of_time of) const { return quartiles_of(times(of)).median; }
};

struct atlas_scene {
    scene_choice scene;
    bool unseen = false;  ///< not of the map: there to judge what was learnt on it
    scene_measures measures;
    std::vector<atlas_line> lines;  ///< exact ones

    /// None where it did not play.
    [[nodiscard]] const atlas_line* find(std::string_view label) const;
    /// The fastest that is not `auto`.
    [[nodiscard]] const atlas_line& fastest(span_of_time of) const;
    /// Time of the fastest, `auto` among them.
    [[nodiscard]] double least_ms(span_of_time of) const;
    /// A parameter of the scene as a number, its default where it is not set; NaN where it has none of that name.
    [[nodiscard]] double number(std::string_view parameter) const;
};

/// The same scenes without `columns`, which wins nearly everywhere, and without `auto`, which takes it: what is left to
/// whoever has neither.
[[nodiscard]] std::vector<atlas_scene> without_columns(std::vector<atlas_scene> atlas);

/// Of the ratio of two lines' times, over the repeats that both have.
[[nodiscard]] estimate log_ratio(const atlas_line& arm, const atlas_line& base, span_of_time of);

/// Those of an experiment whose results are in the folder, as far as they are there. Scenes are made, to be measured.
/// @param unseen whether the scenes are apart from the map
[[nodiscard]] std::vector<atlas_scene> read_atlas(const std::filesystem::path& folder, bool unseen);

/// Who wins, and where: a line for everybody.
[[nodiscard]] table winners_table(const std::vector<atlas_scene>& atlas);
/// Scene by scene: what it is like, who is the fastest and by how much, and the time of `auto` over that.
[[nodiscard]] table cells_table(const std::vector<atlas_scene>& atlas);
/// What it costs to use one of them everywhere, against the fastest of each scene, `auto` among them.
[[nodiscard]] table regrets_table(const std::vector<atlas_scene>& atlas, span_of_time of);

/// Where the fastest of one scene becomes slower than that of the next, along one parameter, all others equal. Lines
/// that differ in parameters only, as lists by their margin, are one: the fastest of them.
struct border {
    std::string before;
    std::string after;
    std::string parameter;
    std::string others;  ///< of the scene
    double at = 0;
    interval range{};  ///< 95 %, within the two scenes
};
[[nodiscard]] std::vector<border> borders_of(const std::vector<atlas_scene>& atlas);
[[nodiscard]] table borders_table(const std::vector<border>& all);
/// All borders between the same two along the same parameter in one line.
[[nodiscard]] table borders_summary(const std::vector<border>& all);

/// One ratio that a statement is judged by.
struct judged_ratio {
    std::string where;
    std::string what;  ///< "bullet_sap over bullet_dbvt"
    std::size_t scenes = 0;
    double ratio = 0;
    interval range{};
    support found = support::undecided;
};
struct judged_statement {
    std::string id;
    std::string source;
    std::string says;
    verdict_kind verdict = verdict_kind::undecided;
    std::vector<judged_ratio> ratios;
};
/// What others have published of broad phases, and what was found here, each judged as claims of the paper are: ratios
/// of times of a frame, geometric means over scenes, decided together.
[[nodiscard]] std::vector<judged_statement> judged_statements(const std::vector<atlas_scene>& atlas);
[[nodiscard]] table statements_table(const std::vector<judged_statement>& all);
[[nodiscard]] table ratios_table(const std::vector<judged_statement>& all);
/// Labels that statements speak of.
[[nodiscard]] std::vector<std::string> labels_in_statements();

/// What a line's frame takes, as a sum of costs of what a scene's measures count, fitted to the scenes of the map; and
/// how many times too long or too short that is, there and in the scenes that it was not fitted to.
struct line_model {
    std::string label;
    std::vector<estimate> costs;  ///< ns, of each term
    accuracy seen;
    accuracy unseen;
};
[[nodiscard]] std::vector<line_model> models_of(const std::vector<atlas_scene>& atlas);
[[nodiscard]] table models_table(const std::vector<line_model>& models);
[[nodiscard]] table costs_table(const std::vector<line_model>& models);
/// Of who is predicted to be the fastest, in each scene that the models were not fitted to.
[[nodiscard]] std::vector<double> regrets_of_models(const std::vector<atlas_scene>& atlas,
                                                    const std::vector<line_model>& models);

[[nodiscard]] std::vector<figure> atlas_figures(const std::vector<atlas_scene>& atlas);

/// Writes atlas.md, a page, the tables as CSV and the figures into the folder.
void write_atlas(const std::filesystem::path& folder, const std::vector<atlas_scene>& atlas);

}  // namespace aabblab
