/// Measures the errors of triangle tests and other inexact methods against their run time.
export module aabblab.errors;

import aabb.geometry;
import aabb.policy;
import aabb.std;
import aabb.validation;
import aabblab.configs;
import aabblab.figures;
import aabblab.scenes;
import aabblab.statistics;
import aabblab.tables;

export namespace aabblab {

/// The errors of one method on one set of pairs.
struct error_point {
    std::string pairs;  ///< the class or scene: "random", "mesh_pair meshes=elephant.off"
    bool in_double = false;
    std::string curve;  ///< its label
    aabb::strategy_choice triangle;
    std::uint64_t count = 0;
    std::uint64_t intersecting = 0;     ///< the ground truth, by CGAL's exact predicates
    std::uint64_t false_negatives = 0;  ///< intersecting pairs that it rejects
    std::uint64_t false_positives = 0;  ///< disjoint pairs that it reports
    quartiles ns_per_pair{};            ///< over batches; the methods alternate within each

    [[nodiscard]] std::uint64_t wrong() const { return false_negatives + false_positives; }
};

/// Runs every method on every set of pairs that it supports.
/// @param finished if set, receives all points so far after each set
std::vector<error_point> measure_errors(const error_study& study,
                                        const std::function<void(std::span<const error_point>)>& finished = {});

/// The text of an errors.csv: a row per method and set of pairs, with all digits.
[[nodiscard]] std::string csv_of(std::span<const error_point> points);
/// @throws aabb::input_error with file and line if it is not an errors.csv.
[[nodiscard]] std::vector<error_point> read_error_rows(const std::filesystem::path& file);

/// Sets of pairs that are reported together.
enum class pair_group : std::uint8_t { of_floats, of_doubles, of_meshes };
/// The groups that occur, in the order of the enumeration.
[[nodiscard]] std::vector<pair_group> groups_in(std::span<const error_point> points);
/// "generated triangle pairs with float coordinates"
[[nodiscard]] std::string_view title_of(pair_group group);

/// Each method over all sets of a group: its error rates, and the mean over the sets of the time per pair.
[[nodiscard]] table error_summary(std::span<const error_point> points, pair_group group);

/// False negatives + false positives of each method, one column per set of the group; scenes of meshes are numbered to
/// keep the headers short.
[[nodiscard]] table errors_by_set(std::span<const error_point> points, pair_group group);
/// The scene of each numbered column, "scene 1: mesh_pair frames=2"; empty if the columns are not numbered.
[[nodiscard]] std::vector<std::string> scenes_by_number(std::span<const error_point> points, pair_group group);

/// Error over run time in all sets of a group, one curve per method over its parameter, on logarithmic axes. A line
/// joins the Pareto front; methods without errors are drawn on the level 1/N.
[[nodiscard]] figure group_figure(std::span<const error_point> points, pair_group group);

/// A sentence about both ends of the Pareto front of a group: the fastest method, and the one with the fewest errors.
[[nodiscard]] std::string group_statement(std::span<const error_point> points, pair_group group);

/// One figure per group, and one per set.
[[nodiscard]] std::vector<figure> error_figures(std::span<const error_point> points);

/// The plots of a study of compositions, one per scene: one curve per method over its parameter, on logarithmic axes.
/// @param scenes the results of their runs
[[nodiscard]] std::vector<figure> metric_figures(const error_study& study, std::span<const scene_summary> scenes);

/// A sentence per plot about the compositions that are best in either metric.
[[nodiscard]] std::vector<std::string> metric_statements(const error_study& study,
                                                         std::span<const scene_summary> scenes);

/// The intersections that one test constructs for the hits of one class, compared with CGAL's exact construction.
struct hit_point {
    std::string pairs;  ///< the class
    bool in_double = false;
    std::string triangle;
    std::uint64_t tried = 0;               ///< pairs
    std::uint64_t count = 0;               ///< hits that it constructed
    std::array<std::uint64_t, 5> kinds{};  ///< hits by kind
    std::uint64_t different = 0;           ///< hits with a wrong kind or number of corners
    std::uint64_t outside = 0;             ///< hits with a coordinate error above the stated bound
    aabb::corner_errors greatest{};        ///< the maximum over the hits
    quartiles ns_per_hit{};                ///< over batches; the tests alternate within each

    [[nodiscard]] bool is_right() const { return different + outside == 0; }
};

/// Generates pairs of each set until the set has the requested number of hits, and runs every constructing test on the
/// hits, those of libraries on one batch in sixteen. It stops after a thousand pairs per requested hit, because hits
/// are rare in some classes.
/// @param finished if set, receives all points so far after each set
std::vector<hit_point> measure_hits(std::span<const pair_set> sets,
                                    const std::function<void(std::span<const hit_point>)>& finished = {});

/// The text of an intersections.csv: a row per test and set, with all digits.
[[nodiscard]] std::string csv_of(std::span<const hit_point> points);

[[nodiscard]] table hit_summary(std::span<const hit_point> points, bool in_double);

}  // namespace aabblab
