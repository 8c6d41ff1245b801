module;
#include <Eigen/Core>

module aabblab.scenes:lattice;

import :boxes;

namespace aabblab {

/// Unit cubes side by side on an integer lattice: each touches its neighbours, corners included, so that results depend
/// on closed comparisons, and sorted lists are full of ties. All move by the same step, so that coordinates stay equal.
class lattice final : public generated_boxes {
public:
    static constexpr std::string_view name = "lattice";
    static constexpr std::string_view summary =
        "unit cubes that touch on an integer lattice and move together, so that bounds are equal; the seed has no "
        "effect";

    struct config : scene_size {
        double displacement = 0.25;
    };
    static constexpr auto parameters = std::tuple_cat(
        size_parameters<config>("how many cubes"),
        std::tuple{aabb::number_parameter{"displacement", &config::displacement, 0.0, 1e9,
                                          "displacement of all cubes per frame on each axis, in edges"}});

    lattice(const config& c, std::uint64_t seed)
        : generated_boxes(name, c, seed, 0, ""), displacement_(c.displacement), side_(lattice_side(c.objects)) {}

private:
    /// Shifts the whole lattice along the diagonal. Neighbours touch exactly, since the upper bound of one and the
    /// lower bound of the next are the same sum. With `cube_at`, which adds the edge last, they might differ.
    void place(std::span<aabb::box> boxes) override {
        const double shift = static_cast<double>(frame()) * displacement_;
        for (std::size_t i = 0; i < boxes.size(); ++i) {
            const Eigen::Vector3d cell = lattice_cell(i, side_);
            for (int k = 0; k < 3; ++k) {
                boxes[i].min[k] = static_cast<float>(cell[k] + shift);
                boxes[i].max[k] = static_cast<float>(cell[k] + 1 + shift);
            }
        }
    }

    double displacement_;
    std::uint32_t side_;
};

}  // namespace aabblab
