/// The claims of the paper, one a file, each decided from measurements by the rule of aabblab.statistics.
export module aabblab.claims;

import aabb.std;
import aabblab.conditions;
import aabblab.figures;
import aabblab.tables;
import aabblab.statistics;
import aabb.registry;
import aabblab.metrics;

export namespace aabblab {

/// What is compared, and so how a sentence tells it.
enum class quantity : unsigned char { time, bytes, box_tests, work, slowdown };

/// One ratio of a claim: where it was measured, what it is, and, once it is decided, what it says.
struct endpoint {
    factors where{};
    factors observed{};  ///< measured there, so no part of what tells it from others: inversions an element
    std::vector<estimate> log_ratios{};  ///< by machine
    double ratio = 0;
    interval range{};                        ///< 95 %, of this endpoint alone
    std::optional<expectation> expected{};   ///< in a draft empty where it is the claim's
    support found = support::undecided;      ///< beside all that are decided with it
    outcome direction = outcome::undecided;  ///< the same
    support alone = support::undecided;      ///< what its own interval says, as if there were no others
    bool is_primary = false;
    quantity compared = quantity::time;
    /// What a sentence calls the line of endpoints that it is on: "on drifting boxes". None where it is not told.
    std::optional<std::string> subject{};
    std::string along{};   ///< the factor that orders the line; empty where nothing does
    std::string source{};  ///< of which rows it is: "figure1: frame_cpu_ms of sort=shell over sort=insertion"

    /// Whether every machine measured it.
    [[nodiscard]] bool known() const {
        return !log_ratios.empty() && std::ranges::all_of(log_ratios, &estimate::known);
    }
    /// Over all machines.
    [[nodiscard]] estimate log_ratio() const { return mean_of(log_ratios); }
};

struct claim_result {
    std::string id{};        ///< "C1"
    std::string claim{};     ///< what the paper says
    std::string measured{};  ///< which ratio of what
    std::string remark{};    ///< a sentence beside the verdict
    std::string lead{};      ///< what the sentence begins with where "up to twice as fast" says too little
    expectation expected = expectation::less;
    verdict_kind verdict = verdict_kind::undecided;
    std::string sentence{};  ///< the verdict in words: which way, how much and where
    std::string brief{};     ///< the same of the lines that primary endpoints are on
    std::string because{};   ///< the figures that decide
    bool has_primary = false;
    endpoint primary{};                      ///< the first of those that are
    std::vector<endpoint> secondary{};       ///< all others, further primary ones first
    std::vector<std::string> experiments{};  ///< whose configs made it
    std::vector<factors> scenes{};           ///< of these experiments
    std::vector<named_table> tables{};
    std::vector<figure> figures{};
};

/// A line of CMakeLists.txt, which tests/paper/recompute.py reads too.
struct listed_claim {
    std::string id;
    std::size_t primaries;  ///< how many endpoints decide it
    expectation expected;   ///< of its primary endpoints, but for those that say otherwise themselves
};
/// All of them, in the order of their lines.
[[nodiscard]] std::vector<listed_claim> listed_claims();

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
/// Every primary endpoint of a claim.
[[nodiscard]] std::vector<endpoint> primaries_of(const claim_result& claim);
/// And every other one.
[[nodiscard]] std::vector<endpoint> secondaries_of(const claim_result& claim);
/// Whether the outcome depends on the choice: "no", "yes", or "undecided" where an alternative cannot be told.
[[nodiscard]] std::string dependence_of(const open_choice& choice);

/// All that the paper's experiments show.
struct reproduction {
    std::vector<claim_result> claims;
    std::vector<std::string> headline;  ///< the whole in three sentences
    std::string disturbance;            ///< a sentence, where the machine was not quiet
    std::vector<open_choice> choices;
    std::vector<named_table> tables;  ///< table 1
    std::vector<figure> figures;      ///< beside those of claims
    named_table bands;                ///< the verdicts under narrower and wider bands of no difference
    named_table null_control;         ///< ratios where there is nothing to be found
};
/// @param machines the results of every experiment, of one machine or of several. Of several a ratio is their mean, and
/// what is found is what every one of them finds; tables, figures, what the paper leaves open and the null control are
/// the first one's.
[[nodiscard]] reproduction judged(std::span<const measurements> machines);
[[nodiscard]] reproduction judged(const measurements& results);

/// "holds", "holds in part", "no difference", …
[[nodiscard]] std::string text_of(const claim_result& claim);
/// "brownian, objects 10,000, displacement 0.1"
[[nodiscard]] std::string text_of(const factors& where);
/// "0.334 (0.328 to 0.341)"
[[nodiscard]] std::string ratio_text(const endpoint& e);
/// Three decimals, so that 1.048 is not taken for the band's edge; fewer from 10 on, four below 0.01.
[[nodiscard]] std::string ratio_digits_of(double ratio);

/// The verdict in words, from all endpoints of a claim: a clause for each line of them.
[[nodiscard]] std::string sentence_of(std::span<const endpoint> all, const std::string& lead = {});
/// Claim by claim: verdict, primary ratio with its interval, and where it was measured.
[[nodiscard]] table verdict_table(const reproduction& all);
/// The same in few words, as README has it.
[[nodiscard]] table brief_table(const reproduction& all);
/// What the paper leaves open.
[[nodiscard]] table choice_table(const reproduction& all);

}  // namespace aabblab

// What the parts of the module share. They see what is imported above.
namespace aabblab {

/// Whether all of these factors have these values there; one without a value must be missing.
[[nodiscard]] bool has(const factors& place, const factors& wanted);

/// A claim before it is judged.
struct draft {
    claim_result claim;
    std::vector<factors> primary;  ///< an endpoint that has all factors of one of these decides the claim
    std::vector<endpoint> endpoints{};
    std::vector<endpoint> beside{};  ///< told at the end of the sentence, by their own intervals, and not judged

    endpoint& add(endpoint e);
};

/// A claim as its line in CMakeLists.txt has it.
struct claim_source {
    listed_claim listed;
    draft (*make)(const measurements& m);
};
/// Defined in a generated unit.
[[nodiscard]] std::vector<claim_source> claim_sources();

/// By its own 95 % interval.
[[nodiscard]] endpoint decided_alone(endpoint e, double band = equivalence_band);

/// Endpoints without a finite ratio (a composition was wrong, an experiment has not run) are left out. Primary ones
/// are decided together over all claims, the others together within theirs.
/// @returns them by claim, in their order
[[nodiscard]] std::vector<std::vector<endpoint>> decided(std::span<const draft> drafts, double band);
/// By the rule of aabblab.statistics.
[[nodiscard]] verdict_kind verdict_of(std::span<const endpoint> all);

/// How many are found to be so.
[[nodiscard]] inline std::size_t count_of(std::span<const endpoint> all, support what) {
    return static_cast<std::size_t>(std::ranges::count(all, what, &endpoint::found));
}

/// Whether a sentence tells them together.
[[nodiscard]] inline bool is_same_line(const endpoint& a, const endpoint& b) {
    return a.subject == b.subject && a.compared == b.compared;
}
/// Where it was measured and what was found there.
[[nodiscard]] factors place_of(const endpoint& e);
/// The clause on the line of one of them.
[[nodiscard]] std::string clause_of(std::span<const endpoint> all, const endpoint& one);
/// What it all comes to, in three sentences.
[[nodiscard]] std::vector<std::string> headline_of(std::span<const claim_result> claims);
/// Whether the machine was quiet: a sentence where it was not.
[[nodiscard]] std::string disturbance_of(std::span<const measurements> machines);

/// The verdicts under bands of 0, 3, 5 and 10 %.
[[nodiscard]] named_table bands_table(std::span<const draft> drafts);

/// Endpoints a row each, the factors in which they differ as columns.
[[nodiscard]] table endpoint_table(std::span<const endpoint> all,
                                   const std::function<std::string(const endpoint&)>& outcome);

/// A row for each place, of columns that say where it is: the factors in which they differ.
[[nodiscard]] table place_table(std::span<const factors> places);
[[nodiscard]] std::vector<factors> places_of(const std::vector<condition>& conditions);

/// The conditions of an experiment that have these factors.
[[nodiscard]] std::vector<const condition*> having(const std::vector<condition>& all, const factors& wanted);

/// The ratio of two compositions in one condition.
/// @param metric by its name
/// @param more factors beside the condition's own
[[nodiscard]] endpoint endpoint_of(const condition& c, const selection& arm, const selection& base,
                                   const std::string& metric, factors more = {});
/// The mean of one less that of the other; of conditions between which nothing is played in the same repeat, so that
/// cells of one process and seed are compared.
[[nodiscard]] estimate between(const cells& above, const cells& below);
/// The same, told on a line.
[[nodiscard]] endpoint told(endpoint e, const std::string& subject, const std::string& along = "",
                            quantity compared = quantity::time);

/// The median over all repeats; empty where it was not measured.
[[nodiscard]] std::optional<double> median_of(const condition& c, const selection& who, const row_value& of);
/// Inversions for each element of the list that is sorted.
[[nodiscard]] std::optional<double> inversions_of(const condition& c);

/// Cells of tables, "-" where nothing was measured.
[[nodiscard]] std::string digits_cell(const std::optional<double>& value);
[[nodiscard]] std::string ratio_cell(const endpoint& e);

/// A composition as figures and tables call it.
struct method {
    std::string label;
    selection who;
};
/// Adds to a table with a row for each condition the time a frame of each method but the first, over that of the first.
void add_ratios(table& t, const std::vector<condition>& conditions, std::span<const method> methods);

/// A figure over two logarithmic axes.
[[nodiscard]] figure log_log(const std::string& name, const std::string& caption, const std::string& x,
                             const std::string& y);
/// A ratio with its 95 % interval as a point of a figure.
[[nodiscard]] figure_point point_of(double x, const endpoint& e);
/// The level of what ratios are formed with.
[[nodiscard]] series level_of(const std::string& label, double x = 1);
/// A series of medians over the conditions of an experiment, in the order of x.
[[nodiscard]] series series_of(const std::string& label, std::span<const condition* const> conditions,
                               const std::string& x, const selection& who, const row_value& of);
/// One for each method.
[[nodiscard]] std::vector<series> series_of(std::span<const method> methods,
                                            std::span<const condition* const> conditions, const std::string& x,
                                            const row_value& of);
/// Ratios against the number of huge boxes, a line for each edge over the side of the world.
/// @param wanted factors of the ratios that are shown
[[nodiscard]] std::vector<series> lines_by_span(std::span<const endpoint> ratios, const factors& wanted);

/// The condition's mesh in a few letters: "noise_sphere:triangles=1000", "elephant.off".
[[nodiscard]] std::string mesh_of(const condition& c);
[[nodiscard]] bool is_brownian(const condition& c);

/// The condition that claims on global search are decided in first: 10,000 cubes that drift by a tenth of their edge.
inline const factors drifting{{"scene", "brownian"}, {"objects", "10000"}, {"displacement", "0.1"}};
/// Those of other claims, which what the paper leaves open is held against.
inline const factors large_spheres{{"meshes", "noise_sphere:triangles=100000"}};
inline const factors large_crowd{{"density", "0.3"}, {"objects", "60"}};  ///< of models that touch

inline const selection traditional{{kind::sort, "insertion"}, {kind::partition, "none"}, {kind::sweep, "one_axis"}};
inline const selection improved{
    {kind::sort, "shell"}, {kind::partition, "axial_cut:axes=2"}, {kind::sweep, "one_axis"}};
/// Shell sort without the cut.
inline const selection uncut{{kind::sort, "shell"}, {kind::partition, "none"}, {kind::sweep, "one_axis"}};
inline constexpr const char* compressed = "compressed:leaf_test=triangle_box";

/// "10,000"; what is no whole number as it is.
[[nodiscard]] std::string number_text(const std::string& value);

/// The growth of each sort's work, which what the paper leaves open is held against.
[[nodiscard]] draft c2_claim(const measurements& m);

[[nodiscard]] std::vector<open_choice> open_choices(const measurements& m);
[[nodiscard]] std::vector<named_table> table1(const measurements& m);
[[nodiscard]] named_table null_control(const measurements& m);

}  // namespace aabblab
