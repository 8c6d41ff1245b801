/// How many pieces something long is cut into.
export module aabb.prepare.pieces;

import aabb.base;
import aabb.std;

// Sums and products as they are written: see aabb.base:floating_point.
#pragma clang fp contract(off) reassociate(off) reciprocal(off)

export namespace aabb {

/// On an axis.
inline constexpr std::size_t most_pieces = 16;

/// As few as are no longer than that, by more than a hundredth: so rounding cuts nothing.
[[nodiscard]] inline std::size_t piece_count(double extent, double longest) noexcept {
    if (!(extent > longest)) return 1;
    const double wanted = std::min(std::ceil(extent / longest - 0.01), static_cast<double>(most_pieces));
    return static_cast<std::size_t>(wanted);
}

/// More than so many no search would gain by.
/// @param strategy whose parameter `size` made them
/// @throws input_error
inline void require_few_pieces(std::string_view strategy, std::size_t pieces, std::size_t objects) {
    const std::size_t most = 65'536 + 16 * objects;
    if (pieces > most)
        throw input_error(std::string(strategy) + ": this size makes more than " + std::to_string(most) +
                          " pieces of " + std::to_string(objects) + " objects; a greater one makes fewer");
}

}  // namespace aabb
