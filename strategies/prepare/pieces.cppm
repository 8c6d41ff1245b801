/// Division of large objects into pieces.
export module aabb.prepare.pieces;

import aabb.policy;
import aabb.std;

#pragma clang fp contract(off) reassociate(off) reciprocal(off)  // see aabb.base:floating_point

export namespace aabb {

/// The configuration shared by the two strategies that divide large objects.
class dividing_prepare {
public:
    static constexpr std::array leaves_out{absence::neighbour_list};

    struct config {
        double size = 4;
    };
    static constexpr std::tuple parameters{number_parameter{"size", &config::size, 0.0,
                                                            std::numeric_limits<double>::max(),
                                                            "the longest extent that is not split, in mean extents"}};

    dividing_prepare() = default;
    explicit dividing_prepare(const config& c) : config_(c) {}

protected:
    config config_;
};

/// Limit per axis.
inline constexpr std::size_t most_pieces = 16;

/// The least number of pieces no longer than `longest`, with a tolerance of 1%, so that rounding errors cut nothing.
[[nodiscard]] inline std::size_t piece_count(double extent, double longest) noexcept {
    if (!(extent > longest)) return 1;
    const double wanted = std::min(std::ceil(extent / longest - 0.01), static_cast<double>(most_pieces));
    return static_cast<std::size_t>(wanted);
}

/// Rejects a division into more pieces than any search gains from.
/// @param strategy name of the strategy whose parameter `size` leads to the pieces
/// @throws input_error
inline void require_few_pieces(std::string_view strategy, std::size_t pieces, std::size_t objects) {
    const std::size_t most = 65'536 + 16 * objects;
    if (pieces > most)
        throw input_error(std::string(strategy) + ": this size makes more than " + std::to_string(most) +
                          " pieces of " + std::to_string(objects) + " objects; a greater size makes fewer");
}

}  // namespace aabb
