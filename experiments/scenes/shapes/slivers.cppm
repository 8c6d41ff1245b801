module aabblab.scenes:slivers;

import :shape;

namespace aabblab {

/// Triangles of length 100 along (1, 1, 1) and width 0.001, in a row of width 10 across it: all of their boxes overlap,
/// but no triangles intersect. A second row offset by half a gap, 5 √½ / n along (1, -1, 0), intersects nothing either.
struct slivers {
    static constexpr std::string_view name = "slivers";
    static constexpr std::string_view summary = "thin triangles in a row along a diagonal, whose boxes all overlap";

    using config = shape_size<3000>;
    static constexpr auto parameters = config::parameters(2, "how many triangles");

    /// Adds thin triangles along the diagonal (1, 1, 1), side by side in a row along (1, -1, 0), each as wide along
    /// (1, 1, -2). `add` takes the coordinates of a vertex along these three orthogonal axes.
    [[nodiscard]] static aabb::mesh make(const config& c) {
        constexpr double half_length = 28.867513459481287;  // 50 √⅓ along each axis
        constexpr double across = 7.0710678118654755;       // 10 √½ along x, and back along y
        constexpr double width = 0.0004082482904638631;     // 0.001 √⅙ along x and y, and twice back along z
        aabb::mesh m;
        const auto add = [&](double along, double aside, double up) {
            m.vertices.push_back({static_cast<float>(along + aside + up), static_cast<float>(along - aside + up),
                                  static_cast<float>(along - 2 * up)});
        };
        for (std::uint32_t i = 0; i < c.triangles; ++i) {
            const double aside = across * (static_cast<double>(i) / c.triangles - 0.5);
            add(-half_length, aside, 0);
            add(-half_length, aside, width);
            add(half_length, aside, 0);
            m.triangles.push_back({3 * i, 3 * i + 1, 3 * i + 2});
        }
        return m;
    }
};

}  // namespace aabblab
