module;
#include <boost/math/distributions/students_t.hpp>

module aabblab.statistics;

namespace aabblab {

namespace {

/// SplitMix64 (Steele, Lea, Flood 2014): the next number of the sequence that `state` is in. The standard library's
/// distributions differ between libraries, and the same data must give the same verdict everywhere.
std::uint64_t next_random(std::uint64_t& state) {
    std::uint64_t z = (state += 0x9e3779b97f4a7c15U);
    z = (z ^ (z >> 30U)) * 0xbf58476d1ce4e5b9U;
    z = (z ^ (z >> 27U)) * 0x94d049bb133111ebU;
    return z ^ (z >> 31U);
}

/// A number from 0 to `count` - 1, uniform up to a bias of less than `count` in 2^64.
std::size_t pick(std::uint64_t& state, std::size_t count) {
    return static_cast<std::size_t>(next_random(state) % count);
}

/// The indices 0 to `count` - 1, in order or drawn with replacement.
std::vector<std::size_t> indices_of(std::size_t count, bool drawn, std::uint64_t& state) {
    std::vector<std::size_t> indices(count);
    std::iota(indices.begin(), indices.end(), std::size_t{0});
    if (drawn)
        for (std::size_t& index : indices) index = pick(state, count);
    return indices;
}

double median_of(std::span<double> values) {
    const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
    std::ranges::nth_element(values, middle);
    if (values.size() % 2 == 1) return *middle;
    return (*middle + *std::max_element(values.begin(), middle)) / 2;
}

/// The variance of a statistic over bootstrap resamples of one level; the other two levels stay as measured.
double variance_of(const sample_size& size, level drawn, const std::function<double(const resample&)>& statistic) {
    std::uint64_t state = 1;
    std::vector<double> values;
    for (std::size_t i = 0; i < draws_per_level; ++i) {
        const double value = statistic(resample(size.processes, size.seeds, drawn, next_random(state)));
        // A draw may consist of empty cells only if the results are incomplete.
        if (std::isfinite(value)) values.push_back(value);
    }
    if (values.size() < 2) return 0;
    const auto count = static_cast<double>(values.size());
    const double mean = std::accumulate(values.begin(), values.end(), 0.0) / count;
    double squares = 0;
    for (const double value : values) squares += (value - mean) * (value - mean);
    return squares / (count - 1);
}

}  // namespace

sample_size cells::size() const {
    std::size_t repeats = 1;
    for (const std::vector<double>& cell : values_) repeats = std::max(repeats, cell.size());
    return {processes_, seeds_, repeats};
}

resample::resample(std::size_t processes, std::size_t seeds, level drawn, std::uint64_t random)
    : drawn_(drawn),
      random_(random),
      processes_(indices_of(processes, drawn == level::processes, random_)),
      seeds_(indices_of(seeds, drawn == level::seeds, random_)) {}

/// The mean, over the drawn processes and seeds (a cell each), of the median of the repeats in a cell. If repeats are
/// the resampled level, they are drawn with replacement, too. NaN if all cells are empty.
double resample::mean_of(const cells& measured) const {
    double sum = 0;
    std::size_t count = 0;
    std::uint64_t random = random_;
    std::vector<double> repeats;
    for (const std::size_t process : processes_)
        for (const std::size_t seed : seeds_) {
            if (process >= measured.processes() || seed >= measured.seeds()) continue;
            const std::span<const double> cell = measured.at(process, seed);
            if (cell.empty()) continue;
            repeats.assign(cell.begin(), cell.end());
            if (drawn_ == level::repeats)
                for (double& value : repeats) value = cell[pick(random, cell.size())];
            sum += median_of(repeats);
            ++count;
        }
    return count > 0 ? sum / static_cast<double>(count) : std::nan("");
}

interval estimate::range(double miss) const {
    if (!(error > 0)) return {value, value};
    const double radius = error * quantile(complement(boost::math::students_t(degrees), miss));
    return {value - radius, value + radius};
}

double estimate::p_if_above(double limit) const {
    if (!(error > 0)) return value >= limit ? 1 : 0;
    return cdf(complement(boost::math::students_t(degrees), (limit - value) / error));
}

double estimate::p_if_below(double limit) const {
    if (!(error > 0)) return value <= limit ? 1 : 0;
    return cdf(boost::math::students_t(degrees), (limit - value) / error);
}

/// Estimates a statistic. Its variance is the sum of those between processes, seeds and repeats (noise), each over
/// bootstrap resamples times n / (n - 1), as the bootstrap underestimates it. The degrees of freedom follow
/// Satterthwaite (1946): sum^2 / (sum of variance^2 / degrees).
estimate bootstrap(const sample_size& size, const std::function<double(const resample&)>& statistic) {
    estimate result{.value = statistic(resample(size.processes, size.seeds, level::none, /*random=*/0))};
    const auto variance = [&](level drawn, std::size_t count) {
        return count < 2
                   ? 0
                   : variance_of(size, drawn, statistic) * static_cast<double>(count) / static_cast<double>(count - 1);
    };
    const double noise = variance(level::repeats, size.repeats);
    // The observed variance between processes, and between seeds, includes the noise of repeats, which is subtracted.
    const double seen_of_processes = variance(level::processes, size.processes);
    const double seen_of_seeds = variance(level::seeds, size.seeds);
    const double of_processes = std::max(0.0, seen_of_processes - noise);
    const double of_seeds = std::max(0.0, seen_of_seeds - noise);
    const double sum = of_processes + of_seeds + noise;
    if (!(sum > 0)) return result;
    // Subtracting the noise adds no information, so the degrees of freedom follow the observed variance.
    const auto term = [](double part, double seen, std::size_t degrees) {
        return degrees > 0 && part > 0 ? seen * seen / static_cast<double>(degrees) : 0;
    };
    result.error = std::sqrt(sum);
    result.degrees =
        sum * sum /
        (term(of_processes, seen_of_processes, size.processes - 1) + term(of_seeds, seen_of_seeds, size.seeds - 1) +
         term(noise, noise, size.processes * size.seeds * (size.repeats - 1)));
    return result;
}

estimate bootstrap(const cells& measured) {
    return bootstrap(measured.size(), [&](const resample& d) { return d.mean_of(measured); });
}

/// The mean of n independent estimates. Its variance is what their errors imply (`within`, the sum of error^2 / n^2)
/// or, if greater, what their spread implies (`between`, its sample variance / n). The degrees of freedom follow
/// Satterthwaite (1946).
estimate mean_of(std::span<const estimate> estimates) {
    if (estimates.size() == 1) return estimates.front();
    const auto count = static_cast<double>(estimates.size());
    double mean = 0, within = 0, degrees = 0, between = 0;
    for (const estimate& e : estimates) mean += e.value / count;
    for (const estimate& e : estimates) {
        const double variance = e.error * e.error / (count * count);
        within += variance;
        degrees += variance * variance / e.degrees;
        between += (e.value - mean) * (e.value - mean) / (count - 1) / count;
    }
    const double sum = within + std::max(0.0, between - within);
    if (!(sum > 0)) return {mean, 0, 1};
    if (between > within) degrees += between * between / (count - 1);
    return {mean, std::sqrt(sum), degrees > 0 ? sum * sum / degrees : 1};
}

/// a - b of independent estimates; the degrees of freedom follow Satterthwaite (1946).
estimate difference_of(const estimate& a, const estimate& b) {
    const double var_a = a.error * a.error;
    const double var_b = b.error * b.error;
    const double sum = var_a + var_b;
    if (!(sum > 0)) return {a.value - b.value, 0, 1};
    return {a.value - b.value, std::sqrt(sum), sum * sum / (var_a * var_a / a.degrees + var_b * var_b / b.degrees)};
}

/// Quartiles and median: a share p of n sorted values is at position p (n - 1), interpolated between values.
quartiles quartiles_of(std::vector<double> values) {
    std::ranges::sort(values);
    const auto quantile_at = [&](double share) {
        const double position = share * static_cast<double>(values.size() - 1);
        const auto below = static_cast<std::size_t>(position);
        const std::size_t above = std::min(below + 1, values.size() - 1);
        return values[below] + (values[above] - values[below]) * (position - static_cast<double>(below));
    };
    return {quantile_at(0.25), quantile_at(0.5), quantile_at(0.75)};
}

/// The least-squares line through points: its slope, and the mean of y, which it has at the mean of x.
fitted_line line_through(std::span<const double> x, std::span<const double> y) {
    const auto count = static_cast<double>(x.size());
    double mean_x = 0, mean_y = 0;
    for (std::size_t i = 0; i < x.size(); ++i) {
        mean_x += x[i] / count;
        mean_y += y[i] / count;
    }
    double xx = 0, xy = 0;
    for (std::size_t i = 0; i < x.size(); ++i) {
        xx += (x[i] - mean_x) * (x[i] - mean_x);
        xy += (x[i] - mean_x) * (y[i] - mean_y);
    }
    return {xy / xx, mean_y};
}

}  // namespace aabblab
