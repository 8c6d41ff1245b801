/// Plays extreme scenes, and pairs of triangles known to be hard, through every composition and engine.
export module aabblab.extreme;

import aabb.extreme;
import aabb.std;
import aabblab.tables;

export namespace aabblab {

enum class contender_role : std::uint8_t { composition, engine, triangle_test };
enum class row_group : std::uint8_t { boxes, meshes, cases };

/// How one contender did in one scene, or with one pair of triangles in every order of corners.
struct extreme_row {
    row_group group = row_group::boxes;
    std::string scene;  ///< or the case
    std::string about;
    std::string kind{};  ///< of a case
    std::string contender;
    std::string precision{};  ///< of the coordinates in which a triangle test decides a case
    contender_role role = contender_role::composition;
    bool must_be_exact = true;
    bool as_expected = true;       ///< otherwise the suite fails
    std::size_t stated_bytes = 0;  ///< that a composition may hold; 0 where none are stated
    aabb::judgement made{};        ///< of a case: how many orders say no, or yes, where the other is true

    /// "moller", "moller in float"
    [[nodiscard]] std::string full_name() const { return contender + (precision.empty() ? "" : " in " + precision); }
};

/// The scenes of `aabb::extreme_scenes`; every class of generated pairs as two meshes; real meshes with zero-area
/// triangles.
struct extreme_list {
    std::vector<aabb::extreme_scene> scenes;
    std::vector<std::string> notes;  ///< what is left out, a sentence each
};
[[nodiscard]] extreme_list all_extreme_scenes(aabb::extreme_size size);

/// Compositions with each named value of their parameters, unless the size is less than full; then engines; then the
/// usual composition with each inexact triangle test.
[[nodiscard]] std::vector<extreme_row> play_scenes(std::span<const aabb::extreme_scene> scenes,
                                                   aabb::extreme_size size);

/// Triangle tests in float and in double, and compositions and engines on two meshes of a triangle each.
[[nodiscard]] std::vector<extreme_row> play_cases(std::span<const aabb::triangle_case> cases);

/// A row a scene: compositions in one column, then engines.
[[nodiscard]] table scene_table(std::span<const extreme_row> rows, row_group group);
/// A row a class of cases: exact tests in one column, compositions in another, then engines.
[[nodiscard]] table case_table(std::span<const extreme_row> rows);

/// What inexact triangle tests get wrong, a column a test; scenes, or classes of cases, that all of them get right are
/// left out.
[[nodiscard]] table inexact_scene_table(std::span<const extreme_row> rows);
[[nodiscard]] table inexact_case_table(std::span<const extreme_row> rows);

/// What those that may be inexact get wrong in scenes of meshes, by class, over all of them.
[[nodiscard]] table class_table(std::span<const extreme_row> rows);

/// The text of an extreme.csv: every row, every number in full.
[[nodiscard]] std::string csv_of(std::span<const extreme_row> rows);
/// The inverse.
/// @throws aabb::input_error with file and line where it is not an extreme.csv.
[[nodiscard]] std::vector<extreme_row> read_extreme_rows(const std::filesystem::path& file);

/// The sentences of refusals, each once, with the scenes that they came in.
[[nodiscard]] std::vector<std::string> refusals_in(std::span<const extreme_row> rows);
/// A sentence for each row that is not as expected.
[[nodiscard]] std::vector<std::string> failures_in(std::span<const extreme_row> rows);
/// How much compositions held in the scenes that state it, a sentence each.
[[nodiscard]] std::vector<std::string> memory_in(std::span<const extreme_row> rows);

}  // namespace aabblab
