module;
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

module aabblab.statistics;

namespace aabblab {

quartiles quartiles_of(std::vector<double> values) {
    std::ranges::sort(values);
    const auto at = [&](double share) {
        const double place = share * static_cast<double>(values.size() - 1);
        const auto below = static_cast<std::size_t>(place);
        const std::size_t above = std::min(below + 1, values.size() - 1);
        return values[below] + (values[above] - values[below]) * (place - static_cast<double>(below));
    };
    return {at(0.25), at(0.5), at(0.75)};
}

interval median_interval(std::vector<double> values) {
    std::ranges::sort(values);
    // The chance that fewer than `cut` + 1 of the values lie below the median.
    const auto n = static_cast<double>(values.size());
    double chance = std::pow(0.5, n);
    double sum = chance;
    std::size_t cut = 0;
    for (; sum <= 0.025; sum += chance) {
        chance *= (n - static_cast<double>(cut)) / static_cast<double>(cut + 1);
        ++cut;
    }
    const std::size_t low = cut > 0 ? cut - 1 : 0;
    return {values[low], values[values.size() - 1 - low]};
}

}  // namespace aabblab
