/// Runs every composition and engine on extreme scenes and on pairs of triangles that are known to be hard.
export module aabblab.extreme;

import aabb.extreme;
import aabb.std;
import aabblab.tables;

export namespace aabblab {

enum class candidate_role : std::uint8_t { composition, engine, triangle_test };
enum class row_group : std::uint8_t { boxes, meshes, cases };

/// The result of one candidate in one scene, or on one pair of triangles in every order of corners.
struct extreme_row {
    row_group group = row_group::boxes;
    std::string scene;  ///< or the name of the case
    std::string about;
    std::string kind{};  ///< the class of a case
    std::string candidate;
    std::string precision{};  ///< of the coordinates of a case, for triangle tests
    candidate_role role = candidate_role::composition;
    bool must_be_exact = true;
    bool as_expected = true;        ///< if false, the suite fails
    std::size_t stated_bytes = 0;   ///< memory bound of a composition; 0 if none is stated
    aabb::extreme_result result{};  ///< for a case, counts the orders of corners with a wrong result

    /// "moller", "moller in float"
    [[nodiscard]] std::string full_name() const { return candidate + (precision.empty() ? "" : " in " + precision); }
};

/// The scenes of `aabb::extreme_scenes`, every class of generated pairs as two meshes, and degenerate meshes.
struct extreme_list {
    std::vector<aabb::extreme_scene> scenes;
    std::vector<std::string> notes;  ///< a sentence per omission
};
[[nodiscard]] extreme_list all_extreme_scenes(aabb::extreme_size size);

/// Runs compositions, at full size with each named value of their parameters, then engines, then the default
/// composition with each inexact triangle test.
[[nodiscard]] std::vector<extreme_row> run_extreme_scenes(std::span<const aabb::extreme_scene> scenes,
                                                          aabb::extreme_size size);

/// Runs triangle tests in float and in double, and compositions and engines on two meshes of one triangle each.
[[nodiscard]] std::vector<extreme_row> run_triangle_cases(std::span<const aabb::triangle_case> cases);

/// One row per scene: compositions in one column, then engines.
[[nodiscard]] table scene_table(std::span<const extreme_row> rows, row_group group);
/// One row per class of cases: exact tests in one column, compositions in another, then engines.
[[nodiscard]] table case_table(std::span<const extreme_row> rows);

/// The errors of inexact triangle tests, one column per test; scenes or classes without errors are omitted.
[[nodiscard]] table inexact_scene_table(std::span<const extreme_row> rows);
[[nodiscard]] table inexact_case_table(std::span<const extreme_row> rows);

/// The errors of candidates that may be inexact, by class of difference, summed over the scenes of meshes.
[[nodiscard]] table class_table(std::span<const extreme_row> rows);

/// The text of an extreme.csv: one line per row, with all digits.
[[nodiscard]] std::string csv_of(std::span<const extreme_row> rows);
/// The inverse of `csv_of`.
/// @throws aabb::input_error with file and line if it is not an extreme.csv.
[[nodiscard]] std::vector<extreme_row> read_extreme_rows(const std::filesystem::path& file);

/// The distinct reasons of rejections, each with the scenes in which it occurs.
[[nodiscard]] std::vector<std::string> rejections_in(std::span<const extreme_row> rows);
/// A sentence for each row that is not as expected.
[[nodiscard]] std::vector<std::string> failures_in(std::span<const extreme_row> rows);
/// A sentence per scene that limits memory: the most that any composition holds in it, and the limit.
[[nodiscard]] std::vector<std::string> memory_in(std::span<const extreme_row> rows);

}  // namespace aabblab
