module aabblab.scenes:square;

import :shape;

namespace aabblab {

/// A floor: an upward facing square in z = 0, divided into n² squares of two triangles.
struct square {
    static constexpr std::string_view name = "square";
    static constexpr std::string_view summary = "a flat square of side 100 that faces up, as a floor";

    /// The number of triangles is the greatest 2 n² that is not above the parameter.
    using config = shape_size<2>;
    static constexpr auto parameters = config::parameters(2, "about how many triangles");

    /// Divides the square into n² squares of two triangles each, with the greatest 2 n² up to the wanted number.
    [[nodiscard]] static aabb::mesh make(const config& c) {
        constexpr float side = 100;
        std::uint32_t n = 1;
        while (2 * (n + 1ULL) * (n + 1ULL) <= c.triangles) ++n;
        aabb::mesh m;
        const auto at = [&](std::uint32_t i) { return side * (static_cast<float>(i) / static_cast<float>(n) - 0.5F); };
        for (std::uint32_t y = 0; y <= n; ++y)
            for (std::uint32_t x = 0; x <= n; ++x) m.vertices.push_back({at(x), at(y), 0});
        for (std::uint32_t y = 0; y < n; ++y)
            for (std::uint32_t x = 0; x < n; ++x) {
                const std::uint32_t corner = y * (n + 1) + x;
                add_quad(m, corner, corner + 1, corner + n + 2, corner + n + 1);
            }
        return m;
    }
};

}  // namespace aabblab
