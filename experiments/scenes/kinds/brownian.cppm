module aabblab.scenes:brownian;

import :boxes;

namespace aabblab {

/// Unit cubes that drift in a cube. As in Broadmark's Brownian scenes, their speed is up to 0.75 of the world's side
/// per second, a frame takes 1/30 s, and one hundredth of them change direction every frame.
class brownian final : public drifting_boxes {
public:
    static constexpr std::string_view name = "brownian";
    static constexpr std::string_view summary =
        "unit cubes that drift in a cube with reflecting walls; a hundredth of them change direction in every frame";

    struct config : scene_size {
        double density = 0.1;
        std::optional<double> displacement;
    };
    static constexpr auto parameters = std::tuple_cat(
        size_parameters<config>("how many cubes"),
        std::tuple{aabb::number_parameter{"density", &config::density, 1e-30, 1e6,
                                          "volume of the cubes over that of the world"},
                   aabb::number_parameter{"displacement", &config::displacement, 0.0, 1e9,
                                          "greatest displacement of a cube per frame, in edges; auto: 1/40 of the "
                                          "world's side"}});

    brownian(const config& c, std::uint64_t seed) : drifting_boxes(name, c, seed) {
        const double side = cube_root(c.objects / c.density);
        points_ = {c.objects, 3, side - 1, {0, c.displacement.value_or(0.75 * side / 30)}, random_};
    }
};

}  // namespace aabblab
