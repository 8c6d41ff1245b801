module;
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <numeric>
#include <span>
#include <vector>

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

/// Evenly from 0 to `count` - 1, but for less than `count` in 2^64.
std::size_t pick(std::uint64_t& state, std::size_t count) {
    return static_cast<std::size_t>(next_random(state) % count);
}

std::vector<std::size_t> picks(std::uint64_t& state, std::size_t count) {
    std::vector<std::size_t> all(count);
    for (std::size_t& one : all) one = pick(state, count);
    return all;
}

double median_of(std::span<double> values) {
    const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
    std::ranges::nth_element(values, middle);
    if (values.size() % 2 == 1) return *middle;
    return (*middle + *std::max_element(values.begin(), middle)) / 2;
}

}  // namespace

bool cells::empty() const {
    return std::ranges::all_of(values_, [](const std::vector<double>& repeats) { return repeats.empty(); });
}

resample::resample(std::size_t processes, std::size_t seeds)
    : processes_(processes), seeds_(seeds), as_measured_(true) {
    std::iota(processes_.begin(), processes_.end(), std::size_t{0});
    std::iota(seeds_.begin(), seeds_.end(), std::size_t{0});
}

resample::resample(std::size_t processes, std::size_t seeds, std::uint64_t random)
    : random_(random), as_measured_(false) {
    processes_ = picks(random_, processes);
    seeds_ = picks(random_, seeds);
}

double resample::mean_of(const cells& measured) const {
    double sum = 0;
    std::size_t count = 0;
    std::uint64_t random = random_;
    std::vector<double> repeats;
    for (const std::size_t process : processes_)
        for (const std::size_t seed : seeds_) {
            const std::span<const double> cell = measured.at(process, seed);
            if (cell.empty()) continue;
            repeats.assign(cell.begin(), cell.end());
            if (!as_measured_)
                for (double& value : repeats) value = cell[pick(random, cell.size())];
            sum += median_of(repeats);
            ++count;
        }
    return count > 0 ? sum / static_cast<double>(count) : std::nan("");
}

interval estimate::range(double miss) const {
    const auto last = static_cast<double>(draws.size() - 1);
    return {draws[static_cast<std::size_t>(std::floor(miss * last))],
            draws[static_cast<std::size_t>(std::ceil((1 - miss) * last))]};
}

estimate bootstrap(std::size_t processes, std::size_t seeds, const std::function<double(const resample&)>& statistic) {
    estimate result{statistic(resample(processes, seeds)), {}};
    const std::size_t fewest = processes < 2 ? seeds : seeds < 2 ? processes : std::min(processes, seeds);
    const double widened = fewest < 2 ? 1 : std::sqrt(static_cast<double>(fewest) / static_cast<double>(fewest - 1));
    std::uint64_t state = 1;
    while (result.draws.size() < draws_of_an_estimate) {
        const double drawn = statistic(resample(processes, seeds, next_random(state)));
        // A draw may consist of empty cells only, where results are not complete.
        if (std::isfinite(drawn))
            result.draws.push_back(result.value + widened * (drawn - result.value));
        else if (!std::isfinite(result.value))
            return {result.value, {result.value}};
    }
    std::ranges::sort(result.draws);
    return result;
}

estimate bootstrap(const cells& measured) {
    return bootstrap(measured.processes(), measured.seeds(), [&](const resample& d) { return d.mean_of(measured); });
}

}  // namespace aabblab
