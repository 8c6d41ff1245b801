module;
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

/// The claims of the paper, one a file, each decided from measurements by the rule of aabblab.statistics.
export module aabblab.claims;

import aabblab.conditions;
import aabblab.figures;
import aabblab.tables;
import aabblab.statistics;
import aabb.registry;
import aabblab.metrics;

export namespace aabblab {

/// One ratio of a claim: where it was measured, what it is, and what it says.
struct endpoint {
    factors where;
    double ratio = 0;
    interval range{};  ///< 95 %, of this endpoint alone
    support found = support::undecided;
    support alone = support::undecided;  ///< what its own interval says, as if there were no others
};

/// A table of a report.
struct named_table {
    std::string name;  ///< of its files
    std::string caption;
    table content;
};

struct claim_result {
    std::string id;        ///< "C1"
    std::string claim;     ///< what the paper says
    std::string measured;  ///< which ratio of what
    expectation expected = expectation::less;
    verdict_kind verdict = verdict_kind::undecided;
    std::string when;     ///< of "holds when": "when objects is at least 10000", "in 3 of 8 conditions"
    std::string because;  ///< one sentence with the figure that decides
    bool has_primary = false;
    endpoint primary;
    std::vector<endpoint> secondary;
    std::vector<std::string> experiments;  ///< whose configs made it
    std::vector<factors> scenes;           ///< of these experiments
    std::vector<named_table> tables;
    std::vector<figure> figures;
};

/// Something that the paper leaves open: what we chose, and what the claim's primary ratio is under other choices.
struct open_choice {
    std::string question;
    std::string choice;
    std::string why;
    std::string claim;  ///< its id
    std::string where;  ///< the condition that the ratios are of
    struct alternative {
        std::string label;
        endpoint measured;
    };
    std::vector<alternative> alternatives;  ///< ours first
};
/// Whether the outcome depends on the choice: "no", "yes", or "undecided" where an alternative cannot be told.
[[nodiscard]] std::string dependence_of(const open_choice& choice);

/// All that the paper's experiments show.
struct reproduction {
    std::vector<claim_result> claims;
    std::vector<open_choice> choices;
    std::vector<named_table> tables;  ///< table 1
    std::vector<figure> figures;      ///< of all claims together
    named_table null_control;         ///< ratios where there is nothing to be found
};
/// @param results the folder with those of every experiment
[[nodiscard]] reproduction judged(const measurements& results);

/// The simplest condition on one or two factors that tells the endpoints that favour a claim from those that are
/// decided otherwise: "objects is at least 10000", "sort is insertion or displacement is 1". None that is met by an
/// endpoint which is undecided among many, but decided otherwise when taken alone. Empty where there is none so simple.
/// Two factors need two endpoints on either side, lest some pair of them always fits, and no single factor that is
/// nearly right.
[[nodiscard]] std::string simplest_condition(std::span<const endpoint> all);

/// One condition that tells most of them apart, and how many; empty where there is none.
[[nodiscard]] std::string nearest_condition(std::span<const endpoint> all);

/// "holds when objects is at least 10000", "no difference", …
[[nodiscard]] std::string text_of(const claim_result& claim);
[[nodiscard]] std::string text_of(support found);
/// "brownian, objects 10,000, displacement 0.1"
[[nodiscard]] std::string text_of(const factors& where);
/// "0.334 (0.328 to 0.341)"
[[nodiscard]] std::string ratio_text(const endpoint& e);
/// Three decimals, so that 1.048 is not taken for the band's edge; fewer from 10 on, four below 0.01.
[[nodiscard]] std::string ratio_digits_of(double ratio);

/// Claim by claim: verdict, primary ratio with its interval, and where it was measured.
[[nodiscard]] table verdict_table(const reproduction& all);
/// What the paper leaves open.
[[nodiscard]] table choice_table(const reproduction& all);

}  // namespace aabblab

// What the parts of the module share.
namespace aabblab {

/// A ratio on its way to be judged.
struct candidate {
    factors where;
    estimate log_ratio;
    bool primary = false;
    std::optional<expectation> expected{};  ///< where it is not the claim's
};

/// Endpoint by its own 95 % interval.
[[nodiscard]] endpoint endpoint_of(const candidate& c, expectation expected);

/// Decides a claim: the primary candidate by its interval, all others together. Writes the sentence and the table of
/// endpoints. Candidates without a finite ratio (a composition was wrong, an experiment has not run) are left out.
void judge(claim_result& claim, std::vector<candidate> candidates);

/// Endpoints a row each, the factors in which they differ as columns.
[[nodiscard]] table endpoint_table(std::span<const endpoint> all,
                                   const std::function<std::string(const endpoint&)>& outcome);

/// Columns of a table that say where its rows were measured: the factors in which they differ.
class place_columns {
public:
    explicit place_columns(std::span<const factors> places);
    explicit place_columns(const std::vector<condition>& conditions);

    [[nodiscard]] std::vector<column> head() const;
    [[nodiscard]] std::vector<std::string> cells(const factors& place) const;

private:
    std::vector<std::string> names_;
};

/// The ratio of two compositions in one condition.
/// @param more factors beside the condition's own
[[nodiscard]] candidate candidate_of(const condition& c, const selection& arm, const selection& base,
                                     const row_value& of, factors more = {});

/// A ratio with its 95 % interval as a point of a figure.
[[nodiscard]] figure_point point_of(double x, const candidate& c);

/// A series of medians over the conditions of an experiment, in the order of x.
[[nodiscard]] series series_of(const std::string& label, std::span<const condition* const> conditions,
                               const std::string& x, const selection& who, const row_value& of);

/// The condition's mesh in a few letters: "noise_sphere:triangles=1000", "elephant.off".
[[nodiscard]] std::string mesh_of(const condition& c);

/// The conditions of primary endpoints, in the full and in the quick size.
[[nodiscard]] bool is_primary_of_c7(const condition& c);
[[nodiscard]] bool is_primary_of_c11(const condition& c);

inline const selection traditional{{kind::sort, "insertion"}, {kind::partition, "none"}, {kind::sweep, "one_axis"}};
inline const selection improved{{kind::sort, "shell"}, {kind::partition, "axial_cut"}, {kind::sweep, "one_axis"}};

[[nodiscard]] claim_result improved_search(const measurements& m);
[[nodiscard]] claim_result linear_sort(const measurements& m);
[[nodiscard]] claim_result shell_sort(const measurements& m);
[[nodiscard]] claim_result more_segments(const measurements& m);
[[nodiscard]] claim_result cut_against_grid(const measurements& m);
[[nodiscard]] claim_result triangle_for_box(const measurements& m);
[[nodiscard]] claim_result compressed_tree(const measurements& m);
[[nodiscard]] claim_result balanced_tree(const measurements& m);
[[nodiscard]] claim_result large_objects_split(const measurements& m);
[[nodiscard]] claim_result one_cut_a_box(const measurements& m);
[[nodiscard]] claim_result whole_algorithm(const measurements& m);
[[nodiscard]] claim_result fewer_box_tests(const measurements& m);

[[nodiscard]] std::vector<open_choice> open_choices(const measurements& m);
[[nodiscard]] std::vector<named_table> table1(const measurements& m);
[[nodiscard]] named_table null_control(const measurements& m);

}  // namespace aabblab
