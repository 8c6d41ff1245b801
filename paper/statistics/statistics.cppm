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
/// Holds the median of what the values are drawn from with a confidence of 95 % or more, whatever the distribution:
/// from the order statistics that a sign test would not reject. With fewer than six values it is all their range, which
/// is less sure. `values` must not be empty.
[[nodiscard]] interval median_interval(std::vector<double> values);

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

private:
    std::size_t processes_;
    std::size_t seeds_;
    std::vector<std::vector<double>> values_;
};

/// One draw with replacement of processes, of seeds, and of the repeats in every cell. The same draw serves several
/// conditions of an experiment, whose cells share processes and seeds.
class resample {
public:
    /// What was measured, as it is.
    resample(std::size_t processes, std::size_t seeds);
    resample(std::size_t processes, std::size_t seeds, std::uint64_t random);

    /// The mean over the drawn cells of the median of their drawn repeats; empty cells have no part in it.
    [[nodiscard]] double mean_of(const cells& measured) const;

private:
    std::vector<std::size_t> processes_;
    std::vector<std::size_t> seeds_;
    std::uint64_t random_ = 0;
    bool as_measured_;
};

/// A statistic with the distribution that resampling gives it.
struct estimate {
    double value = 0;
    std::vector<double> draws;  ///< sorted

    /// @param miss the share of the draws that may lie below it, and above it
    [[nodiscard]] interval range(double miss = 0.025) const;
};

inline constexpr std::size_t draws_of_an_estimate = 4000;

/// Bootstrap with processes and seeds drawn crosswise (the "pigeonhole bootstrap", A. Owen, 2007) and repeats within.
/// Few processes show too little of what differs between them, so deviations are widened by sqrt(n / (n - 1)), n the
/// lesser number of processes and seeds above 1. The same data give the same draws.
[[nodiscard]] estimate bootstrap(std::size_t processes, std::size_t seeds,
                                 const std::function<double(const resample&)>& statistic);
/// Of one condition's mean.
[[nodiscard]] estimate bootstrap(const cells& measured);

/// Where the ratio of two things lies against the band of those that make no difference, 1/1.05 to 1.05.
enum class outcome : unsigned char {
    less,  ///< the interval lies below the band
    same,  ///< within it
    more,  ///< above it
    open   ///< it cannot be told
};

inline constexpr double equivalence_band = 0.05;

/// The outcome that is nearest to being shown, and the chance to see it by accident.
struct evidence {
    outcome nearest;
    double p;
};
/// @param log_ratio of the logarithm of a ratio
[[nodiscard]] evidence evidence_of(const estimate& log_ratio);

/// The nearest outcome where the 95 % interval shows it, else open.
[[nodiscard]] outcome decide(const evidence& e);
/// Several at once, by Holm's step-down rule: the chance that any outcome is wrong is kept below 5 %.
[[nodiscard]] std::vector<outcome> decide_together(std::span<const evidence> all);

/// What a claim says of a ratio.
enum class expectation : unsigned char {
    less,     ///< it is less than 1
    not_more  ///< it is not more than 1
};

enum class support : unsigned char { favours, no_difference, contradicts, open };
[[nodiscard]] support support_of(expectation expected, outcome found);

enum class verdict_kind : unsigned char { holds, holds_when, no_difference, does_not_hold, undecided };

/// The rule. The primary endpoint decides; where a secondary one is otherwise, the claim holds only under conditions:
/// - primary open: undecided;
/// - primary favours: holds, if no secondary contradicts or shows no difference, else holds when;
/// - primary otherwise: holds when, if a secondary favours, else no difference or does not hold, as the primary says.
[[nodiscard]] verdict_kind verdict_of(support primary, std::span<const support> secondary);

}  // namespace aabblab
