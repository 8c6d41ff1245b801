/// Error against run time: what methods get wrong, and the time that they take for it.
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

/// What one method got wrong on one set of pairs.
struct error_point {
    std::string pairs;  ///< of which kind: "random", "mesh_pair meshes=elephant.off"
    bool in_double = false;
    std::string curve;  ///< its label
    aabb::strategy_choice triangle;
    std::uint64_t count = 0;
    std::uint64_t intersecting = 0;     ///< of them, by CGAL's exact predicates
    std::uint64_t false_negatives = 0;  ///< intersecting, but it said no
    std::uint64_t false_positives = 0;  ///< apart, but it said yes
    quartiles ns_a_pair{};              ///< over batches, in which all methods take turns

    [[nodiscard]] std::uint64_t wrong() const { return false_negatives + false_positives; }
};

/// Plays every method on every set of pairs that it takes. Generated pairs are made batch by batch, so that their
/// number costs no memory.
/// @param finished where there is one, takes all points so far, after each set
std::vector<error_point> measure_errors(const error_study& study,
                                        const std::function<void(std::span<const error_point>)>& finished = {});

/// The text of an errors.csv: a row for each method and set of pairs, every number in full.
[[nodiscard]] std::string csv_of(std::span<const error_point> points);
/// The inverse.
/// @throws aabb::input_error with file and line where it is not an errors.csv.
[[nodiscard]] std::vector<error_point> read_error_rows(const std::filesystem::path& file);

/// Sets of pairs that are told together.
enum class pair_group : std::uint8_t { of_floats, of_doubles, of_meshes };
/// In this order.
[[nodiscard]] std::vector<pair_group> groups_in(std::span<const error_point> points);
/// "generated triangles of floats"
[[nodiscard]] std::string_view title_of(pair_group group);

/// Each method over all sets of a group: shares of false answers, and the time a pair as the mean over the sets.
[[nodiscard]] table error_summary(std::span<const error_point> points, pair_group group);

/// What each method gets wrong in each set of a group, a column a set, scenes of meshes by number: false negatives +
/// false positives.
[[nodiscard]] table errors_by_set(std::span<const error_point> points, pair_group group);

/// Error over run time in all sets of a group, a curve a method over its knob, both logarithmic. What nothing else is
/// both faster and more exact than is joined by a line; no error stands on the level 1/N.
[[nodiscard]] figure group_figure(std::span<const error_point> points, pair_group group);

/// The fastest and the most exact of a group in a sentence.
[[nodiscard]] std::string group_statement(std::span<const error_point> points, pair_group group);

/// The figure of each group, and of each of its sets.
[[nodiscard]] std::vector<figure> error_figures(std::span<const error_point> points);

/// The plots of a study of compositions, one for each scene: a curve a method over its knob, both axes logarithmic.
/// @param scenes what came out of playing them
[[nodiscard]] std::vector<figure> metric_figures(const error_study& study, std::span<const scene_summary> scenes);

/// What has the least of either metric, in each of these plots, a sentence each.
[[nodiscard]] std::vector<std::string> metric_statements(const error_study& study,
                                                         std::span<const scene_summary> scenes);

/// What one test that constructs gave for the hits of one class, against CGAL's exact construction.
struct hit_point {
    std::string pairs;  ///< of which class
    bool in_double = false;
    std::string triangle;
    std::uint64_t tried = 0;               ///< pairs
    std::uint64_t count = 0;               ///< hits among them that it constructed
    std::array<std::uint64_t, 5> kinds{};  ///< hits by kind
    std::uint64_t different = 0;           ///< hits whose kind or number of corners is not the exact one
    std::uint64_t outside = 0;             ///< hits with a coordinate off by more than the error that was stated
    aabb::corner_errors greatest{};        ///< of all hits
    quartiles ns_a_hit{};                  ///< over batches, in which the tests take turns

    [[nodiscard]] bool is_right() const { return different + outside == 0; }
};

/// Makes pairs of each set until it has as many hits as the set says, and has every test that constructs construct
/// them, those of libraries one batch of hits in sixteen. Where hits are rare it stops at a thousand pairs for each one
/// that is wanted.
/// @param finished where there is one, takes all points so far, after each set
std::vector<hit_point> measure_hits(std::span<const pair_set> sets,
                                    const std::function<void(std::span<const hit_point>)>& finished = {});

/// The text of an intersections.csv: a row for each test and set, every number in full.
[[nodiscard]] std::string csv_of(std::span<const hit_point> points);

/// The same of one precision, for the screen.
[[nodiscard]] table hit_summary(std::span<const hit_point> points, bool in_double);

}  // namespace aabblab
