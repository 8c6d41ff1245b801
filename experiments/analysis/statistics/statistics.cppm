/// Decides claims: computes intervals by a bootstrap over processes, seeds and repeats, and turns them into outcomes.
/// It does not depend on the kind of measurement.
export module aabblab.statistics;

import aabb.std;

export namespace aabblab {

struct quartiles {
    double low, median, high;
};
/// Interpolates between the two nearest values; `values` must not be empty.
[[nodiscard]] quartiles quartiles_of(std::vector<double> values);

/// A straight line through points, by least squares.
struct fitted_line {
    double slope, mean_y;
};
[[nodiscard]] fitted_line line_through(std::span<const double> x, std::span<const double> y);

struct interval {
    double low, high;
};

/// The number of processes, of seeds, and of repeats per process and seed.
struct sample_size {
    std::size_t processes, seeds, repeats;
};

/// Logarithms of ratios in cells, one per process and seed: repeats within a cell differ by noise only. Every process
/// runs all seeds, so the two factors are crossed.
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
    std::size_t processes_, seeds_;
    std::vector<std::vector<double>> values_;
};

/// The level that is resampled, with replacement.
enum class level : unsigned char { none, processes, seeds, repeats };

/// The measurements with one level resampled. The same draw serves several conditions of an experiment, because their
/// cells share processes and seeds.
class resample {
public:
    resample(std::size_t processes, std::size_t seeds, level drawn, std::uint64_t random);

    /// The mean over the non-empty cells of the median of their repeats; NaN if the condition was not measured.
    [[nodiscard]] double mean_of(const cells& measured) const;

private:
    level drawn_;
    std::uint64_t random_;                        // the state of the generator
    std::vector<std::size_t> processes_, seeds_;  // indices, drawn or in order
};

/// A statistic with its standard error.
struct estimate {
    double value = 0;
    double error = 0;    ///< standard error
    double degrees = 1;  ///< of freedom

    /// False if it was not measured.
    [[nodiscard]] bool is_known() const { return std::isfinite(value); }
    /// Interval by Student's t. @param miss the probability that the true value lies below it, and that it lies above
    [[nodiscard]] interval range(double miss = 0.025) const;
    /// One-sided p-values: the probability of this estimate if the true value were at or above the limit, or below.
    [[nodiscard]] double p_if_above(double limit) const;
    [[nodiscard]] double p_if_below(double limit) const;
};

inline constexpr std::size_t draws_per_level = 1000;

/// Bootstraps level by level: resamples processes, then seeds, then repeats. The variance of a level beyond the noise
/// of repeats has one degree of freedom less than there are processes or seeds, so that processes that disagree widen
/// the interval, and processes that agree do not. The result is deterministic.
[[nodiscard]] estimate bootstrap(const sample_size& size, const std::function<double(const resample&)>& statistic);
/// Estimates the mean of one condition.
[[nodiscard]] estimate bootstrap(const cells& measured);

/// The mean of independent estimates, of several machines or scenes. As in the bootstrap, estimates that disagree widen
/// the interval, with one degree of freedom less than there are estimates.
[[nodiscard]] estimate mean_of(std::span<const estimate> estimates);

/// a - b of two independent estimates, with the degrees of freedom of Satterthwaite (1946).
[[nodiscard]] estimate difference_of(const estimate& a, const estimate& b);

/// The ratio that a claim expects.
enum class expectation : unsigned char {
    less,     ///< it is less than 1
    not_more  ///< it is not more than 1
};

/// The position of a ratio: relative to the equivalence band, 1/1.05 to 1.05, in `evidence_of`, or to 1 in
/// `direction_of`.
enum class outcome : unsigned char { less, same, more, undecided };

inline constexpr double equivalence_band = 0.05;

/// The outcome with the smallest p-value.
struct evidence {
    outcome nearest;
    double p;
};
/// @param log_ratio the estimate of the logarithm of a ratio
[[nodiscard]] evidence evidence_of(const estimate& log_ratio);

/// The nearest outcome if the 95 % interval confirms it, otherwise undecided.
[[nodiscard]] outcome decide(const evidence& e);
/// Decides several at once by Holm's step-down rule (1979), which keeps the probability of any wrong outcome below 5 %.
[[nodiscard]] std::vector<outcome> decide_together(std::span<const evidence> family);

enum class support : unsigned char { favours, no_difference, contradicts, undecided };

/// One-sided p-values of the statements about where a ratio lies relative to the band: the probability of the
/// measurement if the statement were false.
struct tails {
    double less;      ///< it is below the band
    double not_less;  ///< it is not below the band
    double not_more;  ///< it is not above the band
    double more;      ///< it is above the band

    /// It is within the band: both one-sided tests must show it (Schuirmann 1987).
    [[nodiscard]] double same() const { return std::max(not_less, not_more); }
};
/// @param log_ratio the estimate of the logarithm of a ratio
/// @param band 0.05 for 1/1.05 to 1.05; with 0, no ratio counts as the same
[[nodiscard]] tails tails_of(const estimate& log_ratio, double band = equivalence_band);

/// The probability in each tail of a 95 % interval.
inline constexpr double one_sided = 0.025;

/// The region in which a ratio is shown to lie: below, within or above the band (Goeman, Solari and Stijnen 2010); its
/// whole interval at this level lies there. An interval over an edge of the band leaves the region undecided.
[[nodiscard]] outcome direction_of(const tails& p, double level = one_sided);
/// The support for a claim, whose margin is the band's edge: a claim of less is favoured by an interval below the band,
/// one of not more by an interval that ends below the band's upper edge. An interval beyond the margin contradicts the
/// claim; within the band it shows no difference. An interval over the margin is undecided.
[[nodiscard]] support support_of(expectation expected, const tails& p, double level = one_sided);

/// A claim about a ratio, with the measured p-values.
struct tested {
    expectation expected;
    tails p;
};
/// The level at which each of several is decided by Holm's step-down rule, which keeps the probability of any wrong
/// outcome below 5 % (for directions: Shaffer 1980). It is 0 for an endpoint that cannot be decided.
[[nodiscard]] std::vector<double> levels_together(std::span<const tested> family);

enum class verdict_kind : unsigned char { holds, in_part, no_difference, does_not_hold, undecided };

/// How the primary endpoints of a claim decide it; fixed with them, before the measurements.
enum class verdict_rule : unsigned char {
    every,  ///< the claim speaks of all of them: one that is decided otherwise refutes it
    cases   ///< they are the cases that the claim leaves open: it holds in part if it does in some
};

/// Judges a claim by its primary endpoints. A verdict other than undecided is one that further measurements of
/// undecided endpoints cannot change:
/// - holds, or no difference, if all agree;
/// - in `cases`, holds in part, if some endpoints favour it and some are decided otherwise;
/// - in `every`, does not hold, if any contradicts it, or shows no difference while another favours it;
/// - otherwise undecided, if any endpoint is, or if there are none;
/// - otherwise does not hold.
[[nodiscard]] verdict_kind verdict_of(std::span<const support> primary, verdict_rule rule = verdict_rule::cases);

[[nodiscard]] std::string text_of(support verdict);
[[nodiscard]] std::string text_of(verdict_kind verdict);

}  // namespace aabblab
