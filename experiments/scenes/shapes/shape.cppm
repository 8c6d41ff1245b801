/// Common parts of shapes: their parameter, and rings of vertices with the bands between them.
module aabblab.scenes:shape;

import aabb.geometry;
import aabb.policy;
import aabb.std;

namespace aabblab {

/// @tparam Usual the default number of triangles
template <std::uint32_t Usual>
struct shape_size {
    std::uint32_t triangles = Usual;

    [[nodiscard]] static constexpr auto parameters(std::uint32_t least, std::string_view help) {
        return std::tuple{aabb::integer_parameter{"triangles", &shape_size::triangles, least, 100'000'000U, help}};
    }
};

struct ring_counts {
    std::uint32_t rings;
    std::uint32_t around;  ///< vertices per ring
};

/// Chooses the number of rings, and of vertices around each, so that the number of triangles, 2 · rings · around, is
/// nearest to `triangles`. Among equally near choices, takes the one in which rings is nearest to aspect · around.
[[nodiscard]] inline ring_counts rings_for(std::uint32_t triangles, double aspect) {
    const double half = triangles / 2.0;  // the wanted rings · around
    const double ideal_around = std::fmax(3, std::sqrt(half / aspect));
    ring_counts best{3, 3};
    double best_error = 1e300;
    for (auto around = static_cast<std::uint32_t>(std::fmax(3, ideal_around * 0.7)); around <= ideal_around * 1.4;
         ++around) {
        const double rings = std::fmax(3, std::floor(half / around + 0.5));
        const double off_shape = std::fabs(around / ideal_around - 1);
        const double error = std::fabs(rings * around - half) + off_shape / 2;  // the shape only breaks ties
        if (error >= best_error) continue;
        best = {static_cast<std::uint32_t>(rings), around};
        best_error = error;
    }
    return best;
}

/// Adds a quadrilateral as two triangles, split along the diagonal a-c.
inline void add_quad(aabb::mesh& m, std::uint32_t a, std::uint32_t b, std::uint32_t c, std::uint32_t d) {
    m.triangles.push_back({a, b, c});
    m.triangles.push_back({a, c, d});
}

/// Adds the bands of triangles between consecutive rings.
/// @param index_of the index of a vertex by ring and position, which may be one past the last
void add_bands(aabb::mesh& m, std::uint32_t bands, std::uint32_t around, auto index_of) {
    for (std::uint32_t ring = 0; ring < bands; ++ring)
        for (std::uint32_t i = 0; i < around; ++i)
            add_quad(m, index_of(ring, i), index_of(ring + 1, i), index_of(ring + 1, i + 1), index_of(ring, i + 1));
}

}  // namespace aabblab
