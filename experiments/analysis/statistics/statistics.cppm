module;
#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

/// How claims are decided: intervals by a bootstrap over processes, seeds and repeats, and the rule that turns them
/// into an outcome. Knows nothing of what was measured.
export module aabblab.statistics;

export namespace aabblab {

struct quartiles {
    double low;
    double median;
    double high;
};
/// Interpolated between the nearest two values; `values` must not be empty.
[[nodiscard]] quartiles quartiles_of(std::vector<double> values);

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
    [[nodiscard]] bool empty() const;
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
    [[nodiscard]] bool known() const;
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

/// a - b, of two that know nothing of each other.
[[nodiscard]] estimate difference_of(const estimate& a, const estimate& b);

/// What a claim says of a ratio.
enum class expectation : unsigned char {
    less,     ///< it is less than 1
    not_more  ///< it is not more than 1
};

/// Where the ratio of two things lies against the band of those that make no difference, 1/1.05 to 1.05.
enum class outcome : unsigned char {
    less,      ///< the interval lies below the band
    same,      ///< within it
    more,      ///< above it
    undecided  ///< it cannot be told
};

inline constexpr double equivalence_band = 0.05;

/// The outcome that is nearest to being shown, and its p-value. Where no more is expected than not_more, `same` stands
/// for all that is not more.
struct evidence {
    outcome nearest;
    double p;
};
/// @param log_ratio of the logarithm of a ratio
[[nodiscard]] evidence evidence_of(const estimate& log_ratio, expectation expected = expectation::less);

/// The nearest outcome where the 95 % interval shows it, else undecided.
[[nodiscard]] outcome decide(const evidence& e);
/// Several at once, by Holm's step-down rule: the chance that any outcome is wrong is kept below 5 %.
[[nodiscard]] std::vector<outcome> decide_together(std::span<const evidence> all);

enum class support : unsigned char { favours, no_difference, contradicts, undecided };
[[nodiscard]] support support_of(expectation expected, outcome found);

enum class verdict_kind : unsigned char { holds, holds_when, no_difference, does_not_hold, undecided };

/// The rule. The primary endpoint decides; where a secondary one does not agree, the claim holds only under conditions:
/// - primary undecided: undecided;
/// - primary favours: holds, if every secondary does, else holds when: what is undecided has not been shown;
/// - primary otherwise: holds when, if a secondary favours, else no difference or does not hold, as the primary says.
[[nodiscard]] verdict_kind verdict_of(support primary, std::span<const support> secondary);

}  // namespace aabblab
