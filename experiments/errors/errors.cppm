/// Measures the errors of triangle tests and other inexact methods against their run time.
export module aabblab.errors;

import aabb.geometry;
import aabb.policy;
import aabb.std;
import aabb.validation;
import aabblab.configs;
import aabblab.figures;
import aabblab.results;
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
    quartiles ns_per_pair{};            ///< wall time over batches; the methods alternate within each
    /// Processor time per pair: the median over batches with its 95 % interval, by a bootstrap. Results of earlier
    /// versions have none; with fewer than four batches there is no interval.
    std::optional<double> cpu_ns{}, cpu_ns_low{}, cpu_ns_high{};

    [[nodiscard]] std::uint64_t wrong() const { return false_negatives + false_positives; }
    [[nodiscard]] double error() const { return static_cast<double>(wrong()) / static_cast<double>(count); }
    /// Processor time per pair, or, if it was not measured, wall time.
    [[nodiscard]] double ns() const { return cpu_ns.value_or(ns_per_pair.median); }
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

/// Each method in a group: the mean over its sets of the time per pair, and the error rates in the set in which it errs
/// most. A mean of error rates over classes of hard pairs would depend on which classes there are.
[[nodiscard]] table error_summary(std::span<const error_point> points, pair_group group);

/// False negatives + false positives of each method, one column per set of the group; scenes of meshes are numbered to
/// keep the headers short.
[[nodiscard]] table errors_by_set(std::span<const error_point> points, pair_group group);
/// The scene of each numbered column, "scene 1: mesh_pair frames=2"; empty if the columns are not numbered.
[[nodiscard]] std::vector<std::string> scenes_by_number(std::span<const error_point> points, pair_group group);

/// Work-precision diagrams of a group (Hairer, Nørsett, Wanner, Solving Ordinary Differential Equations I, 1993, II.4):
/// error over run time, one curve per method over its parameter, with 95 % intervals, on logarithmic axes. Real pairs
/// have a panel per scene; of generated ones, mostly adversarial, the error is that in the worst class. A
/// line joins the Pareto front; methods without errors are drawn on the level 1/N. Empty if no method errs.
[[nodiscard]] std::optional<figure> group_figure(std::span<const error_point> points, pair_group group);

/// Sentences about both ends of the Pareto front of a group, the fastest method and the one with the fewest errors, and
/// about sets in which no method errs, which have no figure.
[[nodiscard]] std::string group_statement(std::span<const error_point> points, pair_group group);

/// One figure per group, and one per set in which any method errs.
[[nodiscard]] std::vector<figure> error_figures(std::span<const error_point> points);

/// A point of a curve, by the strategies in the rows.
struct curve_point {
    std::string curve;    ///< its label
    candidate_name name;  ///< results of earlier versions know only what their config names: other kinds are empty
    /// The number of scenes, over all seeds, in which the run has rows; unknown in results of earlier versions.
    std::optional<std::uint64_t> scenes;

    [[nodiscard]] bool matches(const candidate_name& row_name) const;
    [[nodiscard]] std::string text() const;
};

/// A study of compositions as it was run. Figures and sentences are made from it and from rows alone, so that they do
/// not depend on the defaults of the program that makes them.
struct study_record {
    std::string name;
    std::vector<curve_point> points;  ///< by curve
    std::vector<metric_plot> plots;
};

[[nodiscard]] study_record record_of(const error_study& study, std::span<const row> rows);
/// Writes curves.csv and plots.csv.
void write_record(const std::filesystem::path& folder, const study_record& record);
void remove_record(const std::filesystem::path& folder);
/// Reads these files, or, in results of earlier versions, config.toml.
/// @throws aabb::input_error if they are missing or malformed
[[nodiscard]] study_record read_record(const std::filesystem::path& folder);

/// @throws aabb::input_error if a point of a curve has no row, or a row is on no curve, by name
void require_rows(const study_record& record, std::span<const row> rows, const std::filesystem::path& folder);

/// The plots of a study of compositions, one per scene: one curve per method over its parameter, with 95 % intervals of
/// times, on logarithmic axes. Empty for a plot of errors if nothing in the scene errs.
[[nodiscard]] std::vector<figure> metric_figures(const study_record& record, std::span<const row> rows);

/// A sentence per plot about the compositions that are best in either metric, or that none has errors.
[[nodiscard]] std::vector<std::string> metric_statements(const study_record& record, std::span<const row> rows);

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

// Shared by the units of the module.
namespace aabblab {

/// Two numbers of a method; less is better in both.
using cost = std::array<double, 2>;

/// The Pareto front of methods with two costs, by index, ascending in the first cost: those that no other beats in one
/// and equals or beats in the other, of equal ones only one. In that order, the second cost is a new minimum.
[[nodiscard]] std::vector<std::size_t> front_of(std::span<const cost> methods);

/// A curve's points with labels, by which the value of its parameter is read off at each point.
/// @param choices of each point, a strategy by kind, or a triangle test
[[nodiscard]] std::vector<std::string> knob_labels(const std::string& curve,
                                                   std::span<const std::vector<std::string>> choices);

/// Appends to a name without unsafe characters until no figure has it.
[[nodiscard]] std::string unused_file_name(const std::string& name, std::span<const figure> figures);

/// The 95 % interval of a median over measurements, all positive; empty if there are too few.
/// @param logarithms of the measurements by process and seed
[[nodiscard]] std::optional<interval> interval_of(const cells& logarithms);

/// The points of a group, and the names of its sets in order.
[[nodiscard]] std::vector<error_point> of_group(std::span<const error_point> points, pair_group group);
[[nodiscard]] std::vector<std::string> sets_in(std::span<const error_point> points);

/// The results of a method (a test with its parameter) in several sets of pairs.
struct tested_method {
    std::string curve;
    aabb::strategy_choice triangle;
    std::vector<error_point> sets;

    /// The set in which it errs most; of equal ones the first.
    [[nodiscard]] const error_point& worst() const { return *std::ranges::max_element(sets, {}, &error_point::error); }
    /// The mean over the sets of the time per pair.
    [[nodiscard]] double ns() const;
    [[nodiscard]] cost costs() const { return {ns(), worst().error()}; }
};
/// One entry per method, in order of appearance.
[[nodiscard]] std::vector<tested_method> methods_in(std::span<const error_point> points);

}  // namespace aabblab
