/// The claims of the paper, each decided from measurements by the rule of aabblab.statistics. endpoints.toml states
/// what decides a claim, the files c*.cpp compute its ratios.
export module aabblab.claims;

import aabb.std;
import aabblab.conditions;
import aabblab.figures;
import aabblab.tables;
import aabblab.statistics;
import aabb.registry;
import aabblab.metrics;

export namespace aabblab {

/// The compared quantity, which determines the wording of a sentence. Relative times are those over the axial cut's.
enum class quantity : unsigned char { time, bytes, box_tests, work, slowdown, relative_time };

/// One ratio of a claim: its condition, its value and, once decided, its outcome.
struct endpoint {
    factors where{};
    factors observed{};                  ///< measured there, so not part of its identity: inversions per element
    std::vector<estimate> log_ratios{};  ///< by machine
    double ratio = 0;
    interval range{};                          ///< 95 %, of this endpoint alone
    std::optional<expectation> expected{};     ///< in a draft empty if it is the claim's
    support corrected = support::undecided;    ///< with Holm's correction
    outcome direction = outcome::undecided;    ///< with Holm's correction, too
    support uncorrected = support::undecided;  ///< without correction, from its own interval
    bool is_primary = false;                   ///< decides the claim
    bool is_earlier = false;                   ///< decided it in earlier archives
    quantity compared = quantity::time;
    /// The label of the clause that reports it in a sentence: "on drifting cubes". Without one it is not mentioned.
    std::optional<std::string> subject{};
    std::string along{};   ///< the factor that orders the endpoints of the clause; empty if unordered
    std::string source{};  ///< the rows: "figure1: frame_cpu_ms of sort=shell over sort=insertion"

    /// Whether all machines measured it.
    [[nodiscard]] bool is_known() const {
        return !log_ratios.empty() && std::ranges::all_of(log_ratios, &estimate::is_known);
    }
    /// The mean over all machines.
    [[nodiscard]] estimate log_ratio() const { return mean_of(log_ratios); }
};

/// What follows the ratio in reports: "times the memory".
[[nodiscard]] std::string_view unit_of(const endpoint& e);
/// "1.39", "0.342 to 1.39"
[[nodiscard]] std::string span_text(double least, double greatest);

/// A ratio that endpoints.toml names before it is measured.
struct stated_ratio {
    factors where{};       ///< its condition has these factors, and perhaps more
    std::string source{};  ///< as in `endpoint`
    expectation expected = expectation::less;
};

/// What endpoints.toml fixes of a claim before the measurements.
struct stated_claim {
    std::string id{};                          ///< "C1a"
    std::string of{};                          ///< who makes it: "paper", or "SMB", which the paper follows
    std::string claim{};                       ///< what is claimed, in our words
    std::string quote{};                       ///< and in theirs
    std::string regime{};                      ///< where it is claimed
    std::string measured{};                    ///< which ratio of what
    expectation expected = expectation::less;  ///< of ratios without their own
    verdict_rule rule = verdict_rule::every;   ///< from ratios to the verdict
    std::string left_open{};                   ///< what the paper leaves open; the primary ratios are its cases
    std::vector<stated_ratio> primary{};       ///< these decide
    std::vector<stated_ratio> earlier{};       ///< these decided in earlier archives
};

/// All of endpoints.toml.
struct stated_analysis {
    double margin = 0;  ///< the band of no difference
    double level = 0;   ///< of a one-sided test, before Holm's correction
    std::vector<std::uint64_t> seeds{};
    std::vector<std::uint64_t> earlier_seeds{};
    std::vector<stated_claim> claims{};
};
[[nodiscard]] const stated_analysis& stated();
/// The text of endpoints.toml.
[[nodiscard]] std::string_view stated_text();

struct claim_result {
    std::string id{};  ///< "C1a"
    std::string of{};  ///< as in `stated_claim`, like the next ones
    std::string claim{};
    std::string quote{};
    std::string regime{};
    std::string measured{};
    std::string left_open{};
    verdict_rule rule = verdict_rule::every;
    std::string remark{};  ///< an additional sentence
    std::string lead{};    ///< precedes the first label of the sentence, if that needs context
    expectation expected = expectation::less;
    verdict_kind verdict = verdict_kind::undecided;
    std::string sentence{};                  ///< the verdict in words: direction, size and conditions
    std::string brief{};                     ///< the same for clauses with primary endpoints
    std::string evidence{};                  ///< the numbers that decide
    std::vector<endpoint> primaries{};       ///< the primary endpoints; the first stands for the claim in short reports
    std::vector<std::string> missing{};      ///< the primary endpoints that were not measured
    std::vector<endpoint> secondaries{};     ///< the other endpoints
    std::vector<std::string> experiments{};  ///< the experiments that measured it
    std::vector<factors> scenes{};           ///< of these experiments
    std::vector<named_table> tables{};       ///< in a draft, the claim's own; `judged` inserts that of all ratios first
    std::vector<figure> figures{};
};

/// A choice that the paper leaves open: ours, and the claim's primary ratio under the alternatives.
struct open_choice {
    std::string question;
    std::string choice;
    std::string why;
    std::string claim;  ///< its id
    std::string where;  ///< the condition of the ratios
    struct alternative {
        std::string label;
        endpoint measured;
    };
    std::vector<alternative> alternatives;  ///< ours first
};
/// Whether the outcome depends on the choice: "no", "yes", or "undecided" if an alternative is undecided.
[[nodiscard]] std::string dependence_of(const open_choice& choice);

/// The results of the paper's experiments.
struct reproduction {
    std::vector<claim_result> claims;
    std::string headline;     ///< the numbers of verdicts, in a sentence
    std::string disturbance;  ///< a sentence, if the machine was not quiet
    std::vector<open_choice> choices;
    std::vector<named_table> tables;  ///< table 1
    std::vector<figure> figures;      ///< in addition to those of claims
    named_table bands;                ///< the verdicts under narrower and wider bands of no difference
    named_table null_control;         ///< ratios without a true difference
};
/// @param machines the results of all experiments. With several machines, a ratio is their mean, and an outcome must be
/// found on each; tables, figures, open choices and the null control are those of the first one.
[[nodiscard]] reproduction judged(std::span<const measurements> machines);
[[nodiscard]] inline reproduction judged(const measurements& results) {
    return judged({&results, 1});
}

/// "brownian, objects 10,000, displacement 0.1"
[[nodiscard]] std::string text_of(const factors& where);
/// The 95 % interval: "0.328 to 0.341"
[[nodiscard]] std::string range_text(const endpoint& e);
/// "0.334 (0.328 to 0.341)"
[[nodiscard]] std::string ratio_text(const endpoint& e);
/// Three decimals, so that 1.048 does not look like the band's edge; fewer from 10 on, four below 0.01.
[[nodiscard]] std::string ratio_digits_of(double ratio);

/// The verdict in words, from all endpoints of a claim: one clause per subject, "on drifting cubes: 0.500 times the
/// time".
[[nodiscard]] std::string sentence_of(std::span<const endpoint> endpoints, const std::string& lead = {});
/// The verdict of each claim, with the primary ratio, its interval and its condition.
[[nodiscard]] table verdict_table(const reproduction& results);
/// A short version for the README, of the paper's claims only.
[[nodiscard]] table brief_table(const reproduction& results);
[[nodiscard]] table choice_table(const reproduction& results);

}  // namespace aabblab

// Shared by the units of the module, which see the imports above; comments are at the definitions.
namespace aabblab {

/// Whether all of these factors have these values; a factor with an empty value must be missing.
[[nodiscard]] bool matches(const factors& where, const factors& wanted);

/// A claim before it is judged.
struct draft {
    claim_result claim;
    std::vector<endpoint> endpoints{};
    const stated_claim* stated = nullptr;  ///< `judged` sets it

    /// Adds an endpoint that no sentence mentions.
    endpoint& add(endpoint e) { return endpoints.emplace_back(std::move(e)); }
    /// Adds an endpoint to the clause of this subject.
    endpoint& add(endpoint e, const std::string& subject, const std::string& along = "",
                  quantity compared = quantity::time);
};

struct claim_source {
    std::string id;
    draft (*make)(const measurements& m);
};
/// Defined in a generated unit.
[[nodiscard]] std::vector<claim_source> claim_sources();

[[nodiscard]] endpoint decided_alone(endpoint e, double band = equivalence_band);
[[nodiscard]] std::vector<std::vector<endpoint>> decided(std::span<const draft> drafts, double band);
[[nodiscard]] verdict_kind verdict_of(const draft& drafted, std::span<const endpoint> endpoints);

[[nodiscard]] inline std::ptrdiff_t count_of(std::span<const endpoint> endpoints, support what) {
    return std::ranges::count(endpoints, what, &endpoint::corrected);
}

[[nodiscard]] inline bool is_same_clause(const endpoint& a, const endpoint& b) {
    return a.subject == b.subject && a.compared == b.compared;
}
/// The factors of its condition and the observed ones.
[[nodiscard]] factors factors_of(const endpoint& e);
/// An endpoint's outcome as sentences report it, begun like `outcome`. If its region relative to the band is undecided,
/// the claim's margin may still be decided: `not_more`, `not_less`.
enum class wording : unsigned char { less, same, more, not_more, not_less, open };
[[nodiscard]] wording wording_of(const endpoint& e);
/// A number of things and what they do: "1 holds", "3 hold".
struct counted_verb {
    std::ptrdiff_t count;
    std::string_view singular, plural;
};
/// "Of 14 claims, 2 hold, 6 hold in part and 1 is undecided."; counts of 0 are omitted.
[[nodiscard]] std::string counts_text(std::string text, std::initializer_list<counted_verb> counts);
[[nodiscard]] std::string headline_of(std::span<const claim_result> claims);
[[nodiscard]] std::string disturbance_of(std::span<const measurements> machines);
[[nodiscard]] named_table bands_table(std::span<const draft> drafts);
[[nodiscard]] table endpoint_table(std::span<const endpoint> endpoints,
                                   const std::function<std::string(const endpoint&)>& outcome);
[[nodiscard]] table factors_table(std::span<const factors> conditions);
[[nodiscard]] std::vector<factors> factors_of(const std::vector<condition>& conditions);

/// The conditions with these factors.
[[nodiscard]] std::vector<const condition*> matching(const std::vector<condition>& conditions, const factors& wanted);

[[nodiscard]] endpoint endpoint_of(const condition& c, const selection& tested, const selection& baseline,
                                   const std::string& metric, factors more = {});
/// The difference of two means over cells of the same processes and seeds, for conditions that share no repeats.
[[nodiscard]] estimate difference_of_means(const cells& above, const cells& below);

/// The median over all repeats; empty if it was not measured.
[[nodiscard]] std::optional<double> median_of(const condition& c, const selection& tested, const row_value& value);
/// Inversions per element of the sorted list.
[[nodiscard]] std::optional<double> inversions_of(const condition& c);

/// Table cells, "-" if nothing was measured.
[[nodiscard]] std::string digits_cell(const std::optional<double>& value);
[[nodiscard]] inline std::string ratio_cell(const endpoint& e) {
    return e.is_known() ? ratio_text(decided_alone(e)) : "-";
}

/// A composition and its label in figures and tables.
struct method {
    std::string label;
    selection tested;
};
void add_ratios(table& t, const std::vector<condition>& conditions, std::span<const method> methods);

[[nodiscard]] inline figure log_log(const std::string& name, const std::string& caption, const std::string& x,
                                    const std::string& y, std::vector<series> lines = {}) {
    return {name, caption, {x, true}, {y, true}, std::move(lines)};
}
/// A ratio with its 95 % interval as a point of a figure.
[[nodiscard]] figure_point point_of(double x, const endpoint& e);
/// The level 1 of ratios, which is that of their baseline.
[[nodiscard]] inline series level_of(const std::string& label, double x = 1) {
    return {label, series_style::level, {{x, 1}}};
}
/// The position of a condition on the x axis of a figure.
using condition_number = std::function<double(const condition&)>;
[[nodiscard]] inline double objects_of(const condition& c) {
    return number_of(c.scene(), "objects");
}
[[nodiscard]] series series_of(const std::string& label, std::span<const condition* const> conditions,
                               const condition_number& x, const selection& tested, const row_value& value);
[[nodiscard]] std::vector<series> series_of(std::span<const method> methods,
                                            std::span<const condition* const> conditions, const condition_number& x,
                                            const row_value& value);
[[nodiscard]] std::vector<series> lines_by_span(std::span<const endpoint> ratios, const factors& wanted,
                                                const std::string& level);

/// The condition's mesh: "noise_sphere:triangles=1000", "elephant.off".
[[nodiscard]] inline std::string mesh_of(const condition& c) {
    return value_of(c.scene(), "meshes");
}
[[nodiscard]] inline bool is_brownian(const condition& c) {
    return value_of(c.scene(), "scene") == "brownian";
}

/// The first primary condition of claims on the broad phase: 10,000 cubes that drift by a tenth of their edge.
inline const factors drifting{{"scene", "brownian"}, {"objects", "10000"}, {"displacement", "0.1"}};
/// Conditions of other claims, with which open choices are compared.
inline const factors large_spheres{{"meshes", "noise_sphere:triangles=100000"}};
inline const factors large_crowd{{"density", "0.3"}, {"objects", "60"}};  ///< of models that touch

// None is made of another: clang 19 does not initialise the inline variables of a module in their order.
inline const selection traditional{{kind::sort, "insertion"}, {kind::partition, "none"}, {kind::sweep, "one_axis"}};
inline const selection cut{{kind::sort, "insertion"}, {kind::partition, "axial_cut:axes=2"}, {kind::sweep, "one_axis"}};
inline const selection improved{
    {kind::sort, "shell"}, {kind::partition, "axial_cut:axes=2"}, {kind::sweep, "one_axis"}};
inline const selection uncut{{kind::sort, "shell"}, {kind::partition, "none"}, {kind::sweep, "one_axis"}};
inline constexpr const char* compressed = "compressed:leaf_test=triangle_box";

/// Explains a column `unit` of tables.
inline constexpr const char* unit_legend =
    " The unit is that of the displacement: extent, the mean edge of a box; spacing; if empty, a cube's edge.";

/// "10,000 to 100,000": groups the digits of integers among words; other words are unchanged.
[[nodiscard]] std::string number_text(const std::string& value);

/// The growth of each sort's work, with which open choices are compared.
[[nodiscard]] draft c2_claim(const measurements& m);

[[nodiscard]] std::vector<open_choice> open_choices(const measurements& m);
[[nodiscard]] std::vector<named_table> table1(const measurements& m);
[[nodiscard]] named_table null_control(const measurements& m);

}  // namespace aabblab
