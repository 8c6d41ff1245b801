/// How claims are decided: intervals by a bootstrap over processes, seeds and repeats, and the rule that turns them
/// into an outcome. Knows nothing of what was measured.
export module aabblab.statistics;

import aabb.std;

export namespace aabblab {

struct quartiles {
    double low;
    double median;
    double high;
};
/// Interpolated between the nearest two values; `values` must not be empty.
[[nodiscard]] quartiles quartiles_of(std::vector<double> values);

/// A straight line through points, by least squares.
struct fitted_line {
    double slope;
    double mean_y;
};
[[nodiscard]] fitted_line line_through(std::span<const double> x, std::span<const double> y);

struct interval {
    double low;
    double high;
};

/// Of measurements: how many processes and seeds, and repeats in each cell of one of each.
struct sample_size {
    std::size_t processes;
    std::size_t seeds;
    std::size_t repeats;
};

/// Logarithms of ratios, in cells of one process and one seed: the repeats of a cell are alike but for noise. All seeds
/// are played in every process, so the two are crossed.
class cells {
public:
    cells(std::size_t processes, std::size_t seeds)
        : processes_(processes), seeds_(seeds), values_(processes * seeds) {}

    void add(std::size_t process, std::size_t seed, double value) { values_[process * seeds_ + seed].push_back(value); }

    [[nodiscard]] std::size_t processes() const { return processes_; }
    [[nodiscard]] std::size_t seeds() const { return seeds_; }
    [[nodiscard]] std::span<const double> at(std::size_t process, std::size_t seed) const {
        return values_[process * seeds_ + seed];
    }
    [[nodiscard]] bool empty() const {
        return std::ranges::all_of(values_, [](const auto& repeats) { return repeats.empty(); });
    }
    [[nodiscard]] sample_size size() const;

private:
    std::size_t processes_;
    std::size_t seeds_;
    std::vector<std::vector<double>> values_;
};

/// What is drawn anew, with replacement.
enum class level : unsigned char { none, processes, seeds, repeats };

/// What was measured, with one level drawn anew. The same draw serves several conditions of an experiment, whose cells
/// share processes and seeds.
class resample {
public:
    resample(std::size_t processes, std::size_t seeds, level drawn, std::uint64_t random);

    /// The mean over the cells of the median of their repeats; NaN where a condition was not measured. Of the seeds or
    /// processes that miss, the others speak.
    [[nodiscard]] double mean_of(const cells& measured) const;

private:
    std::vector<std::size_t> processes_;
    std::vector<std::size_t> seeds_;
    level drawn_;
    std::uint64_t random_;
};

/// A statistic, and how far it may be off.
struct estimate {
    double value = 0;
    double error = 0;    ///< standard error
    double degrees = 1;  ///< of freedom

    /// Whether it was measured.
    [[nodiscard]] bool known() const { return std::isfinite(value); }
    /// By Student's t. @param miss the chance that the true value lies below it, and above it
    [[nodiscard]] interval range(double miss = 0.025) const;
    /// One-sided p-values: how likely it is to see this if the true value were at the limit or above, or below.
    [[nodiscard]] double chance_above(double limit) const;
    [[nodiscard]] double chance_below(double limit) const;
};

inline constexpr std::size_t draws_of_a_level = 1000;

/// Bootstrap by level: processes, seeds and repeats are drawn in turn. What each level adds beyond the noise of repeats
/// is a variance with as many degrees of freedom as there are processes or seeds, less one; the sum has
/// Satterthwaite's. So processes that disagree make a wide interval, and those that agree do not. The same data
/// give the same estimate.
[[nodiscard]] estimate bootstrap(const sample_size& size, const std::function<double(const resample&)>& statistic);
/// Of one condition's mean.
[[nodiscard]] estimate bootstrap(const cells& measured);

/// The mean of what several machines found, each of which knows nothing of the others. As in the bootstrap, machines
/// that disagree make a wide interval, with as many degrees of freedom as there are machines, less one.
[[nodiscard]] estimate mean_of(std::span<const estimate> machines);

/// a - b, of two that know nothing of each other.
[[nodiscard]] estimate difference_of(const estimate& a, const estimate& b);

/// What a claim says of a ratio.
enum class expectation : unsigned char {
    less,     ///< it is less than 1
    not_more  ///< it is not more than 1
};

/// Where the ratio of two things lies: against the band of those that make no difference, 1/1.05 to 1.05, as
/// `evidence_of` has it, or against 1, as `direction_of`.
enum class outcome : unsigned char { less, same, more, undecided };

inline constexpr double equivalence_band = 0.05;

/// The outcome that is nearest to being shown, and its p-value.
struct evidence {
    outcome nearest;
    double p;
};
/// @param log_ratio of the logarithm of a ratio
[[nodiscard]] evidence evidence_of(const estimate& log_ratio);

/// The nearest outcome where the 95 % interval shows it, else undecided.
[[nodiscard]] outcome decide(const evidence& e);
/// Several at once, by Holm's step-down rule: the chance that any outcome is wrong is kept below 5 %.
[[nodiscard]] std::vector<outcome> decide_together(std::span<const evidence> all);

enum class support : unsigned char { favours, no_difference, contradicts, undecided };

/// One-sided p-values of what may be said of a ratio: how likely it is to see what was measured if it were not so.
struct tails {
    double less;          ///< it is below 1
    double more;          ///< it is above 1
    double same;          ///< it is within the band
    double not_more;      ///< it is not above the band
    bool within = false;  ///< the ratio itself lies within the band, wherever its interval reaches
};
/// @param log_ratio of the logarithm of a ratio
/// @param band 0.05 for 1/1.05 to 1.05; 0 for none, in which nothing is the same
[[nodiscard]] tails tails_of(const estimate& log_ratio, double band = equivalence_band);

/// In each tail, as a 95 % interval has it.
inline constexpr double one_sided = 0.025;

/// Which way a ratio goes: the same where it is shown to lie within the band, else less or more where it is shown to
/// lie on one side of 1, by however little. Only what may lie on either side of 1 is undecided.
[[nodiscard]] outcome direction_of(const tails& p, double level = one_sided);
/// The same as a claim takes it. What is not more than the band allows favours a claim of not_more, whatever its
/// direction.
[[nodiscard]] support support_of(expectation expected, const tails& p, double level = one_sided);

/// What a claim says of a ratio, and what was measured.
struct tested {
    expectation expected;
    tails p;
};
/// The level at which each of several is decided, by Holm's step-down rule: the chance that any outcome is wrong is
/// kept below 5 %. 0 where nothing can be said of one.
[[nodiscard]] std::vector<double> levels_together(std::span<const tested> all);

enum class verdict_kind : unsigned char { holds, in_part, no_difference, does_not_hold, undecided };

/// The rule, of the primary endpoints of a claim. What a further measurement of those that are undecided could still
/// change is not said:
/// - holds in part, where some favour it and some are decided otherwise;
/// - else undecided, where one is, or there is none;
/// - holds, or no difference, where all say so;
/// - else does not hold.
[[nodiscard]] verdict_kind verdict_of(std::span<const support> primary);

/// "for", "no difference", "against", "undecided"
[[nodiscard]] std::string text_of(support found);
/// "holds", "holds in part", "no difference", "does not hold", "undecided"
[[nodiscard]] std::string text_of(verdict_kind verdict);

}  // namespace aabblab
