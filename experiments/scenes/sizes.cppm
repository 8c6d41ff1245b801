/// Sizes of boxes that are the same everywhere.
module aabblab.scenes:sizes;

import aabb.std;

namespace aabblab {

/// Edges evenly spread in the logarithm from 1 to a ratio, in ascending order. The i-th is ratio^(i / (count - 1)),
/// multiplied from roots of the ratio, one for each binary digit of the exponent: std::pow differs between libraries.
[[nodiscard]] inline std::vector<double> spread_edges(std::uint32_t count, double ratio) {
    constexpr int digits = 32;
    std::array<double, digits + 1> roots{};
    roots[digits] = ratio;
    for (std::size_t k = digits; k > 0; --k) roots[k - 1] = std::sqrt(roots[k]);
    std::vector<double> edges(count, 1);
    for (std::uint64_t i = 1; i < count; ++i) {
        const std::uint64_t exponent = (i << digits) / (count - 1);
        for (std::size_t k = 0; k <= digits; ++k)
            if (exponent >> k & 1) edges[i] *= roots[k];
    }
    return edges;
}

}  // namespace aabblab
