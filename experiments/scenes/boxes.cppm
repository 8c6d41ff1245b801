module;
#include <Eigen/Core>

/// Common parts of the scenes of boxes.
module aabblab.scenes:boxes;

import aabb.pipeline;
import aabblab.files;
import :parameters;
import :random;
import :spacing;

namespace aabblab {

struct scene_size {
    std::uint32_t objects = 1000;
    std::uint32_t frames = 20;
};

/// The unit of displacements: the mean extent of the boxes, or their mean spacing.
enum class length_unit : unsigned char { extent, spacing };

struct motion_config : scene_size {
    double displacement = 0.1;
    length_unit unit = length_unit::extent;
};
/// The parameters that every kind of moving boxes has: the numbers of boxes and frames, the displacement and its unit.
/// @param help explains the displacement, which kinds apply differently
[[nodiscard]] constexpr auto motion_parameters_with(std::string_view help) {
    return std::tuple_cat(
        size_parameters<scene_size>("how many boxes"),
        std::tuple{
            aabb::number_parameter{"displacement", &motion_config::displacement, 0.0, 1e9, help},
            aabb::choice_parameter{
                "unit", &motion_config::unit, std::array<std::string_view, 2>{"extent", "spacing"},
                "the unit of displacement: the mean extent of a box, or the mean spacing (the edge of the cube of "
                "space per box)"}});
}
inline constexpr auto motion_parameters =
    motion_parameters_with("displacement of each box per frame, along its path if walls reflect it");

/// The displacement as a length, for the mean extent of the boxes and the sides of the world, 0 on a flat axis.
[[nodiscard]] inline double step_of(const motion_config& c, double extent, const aabb::vec3d& sides) {
    return c.displacement * (c.unit == length_unit::extent ? extent : mean_spacing(sides, c.objects));
}

/// The cube with this lowest corner.
[[nodiscard]] inline aabb::box cube_at(const Eigen::Vector3d& corner, double edge) {
    aabb::box b{};
    for (int k = 0; k < 3; ++k) {
        b.min[k] = static_cast<float>(corner[k]);
        b.max[k] = static_cast<float>(corner[k] + edge);
    }
    return b;
}

/// The width of a cube (square, segment) in which uniformly distributed unit cubes overlap two others each on average:
/// a unit cube overlaps those whose corner lies in a cube of edge 2 around its own.
[[nodiscard]] inline double width_for(std::uint32_t objects, int axes) {
    return edge_of(static_cast<double>(objects) * (1 << axes) / 2, axes);
}

/// The edge of the smallest cubic lattice with at least `cells` cells.
[[nodiscard]] inline std::uint32_t lattice_side(std::uint64_t cells) {
    std::uint64_t side = 1;
    while (side * side * side < cells) ++side;
    return static_cast<std::uint32_t>(side);
}
/// The coordinates of a cell by its index; the last axis varies fastest.
[[nodiscard]] inline Eigen::Vector3d lattice_cell(std::uint64_t cell, std::uint64_t side) {
    return Eigen::Matrix<std::uint64_t, 3, 1>(cell / (side * side), cell / side % side, cell % side).cast<double>();
}

/// Edges in geometric progression, ascending from 1 to `ratio`: edge i is ratio^(i / (count - 1)). std::pow differs
/// between libraries, but square roots do not, so a power is the product of the roots ratio^(1/2), ratio^(1/4), ...
/// for which the exponent, as a binary fraction, has the digit 1.
[[nodiscard]] inline std::vector<double> spread_edges(std::uint32_t count, double ratio) {
    constexpr int digits = 32;
    std::array<double, digits + 1> roots{};  // roots[k] = ratio^(2^(k - digits))
    roots[digits] = ratio;
    for (std::size_t k = digits; k > 0; --k) roots[k - 1] = std::sqrt(roots[k]);
    std::vector<double> edges(count, 1);
    for (std::uint64_t i = 1; i < count; ++i) {
        const std::uint64_t exponent = (i << digits) / (count - 1);  // in units of 2^-digits
        for (std::size_t k = 0; k <= digits; ++k)
            if (exponent >> k & 1) edges[i] *= roots[k];
    }
    return edges;
}

/// A scene of boxes that is generated frame by frame. A kind advances its state and places the boxes of a frame.
class generated_boxes : public aabb::box_scene {
public:
    [[nodiscard]] std::size_t objects() const final { return size_.objects; }
    [[nodiscard]] std::size_t frames() const final { return std::size_t{size_.frames} + 1; }

    bool next(std::vector<aabb::box>& boxes) final {
        if (frames_run_ == frames()) return false;
        if (frames_run_++ > 0) advance();
        boxes.resize(objects());
        place(boxes);
        return true;
    }

protected:
    /// @param bytes_each memory that the kind holds per object
    /// @param noun follows the name in messages, unless the name is a noun itself
    generated_boxes(std::string_view name, const scene_size& size, std::uint64_t seed, double bytes_each,
                    std::string_view noun = " scene")
        : random_(seed), size_(size) {
        require_memory(
            "a " + std::string(name) + std::string(noun) + " of " + std::to_string(size.objects) + " objects",
            size.objects * (bytes_each + sizeof(aabb::box)));
    }

    virtual void advance() {}
    virtual void place(std::span<aabb::box> boxes) = 0;
    /// The index of the current frame, in `advance` and in `place`.
    [[nodiscard]] std::size_t frame() const { return frames_run_ - 1; }

    random_source random_;

private:
    scene_size size_;
    std::size_t frames_run_ = 0;
};

/// Boxes that drift with points: by default, unit cubes with their lowest corner there.
class drifting_boxes : public generated_boxes {
protected:
    drifting_boxes(std::string_view name, const scene_size& size, std::uint64_t seed, double further_bytes_each = 0)
        : generated_boxes(name, size, seed, drifting_points::bytes_each + further_bytes_each) {}

    /// Places points in a cube (square, segment) of this width, with random directions and the step of `step_of`.
    void drift(const motion_config& c, double width, double extent, const aabb::vec3d& sides, int axes = 3) {
        const double step = step_of(c, extent, sides);
        points_ = {c.objects, axes, width, {step, step}, random_};
    }
    void drift(const motion_config& c, double width, double extent, double side) {
        drift(c, width, extent, {side, side, side});
    }
    /// Unit cubes that drift along the first `axes` axes, with the density of `width_for`.
    void drift(const motion_config& c, int axes = 3) {
        const double width = width_for(c.objects, axes);
        aabb::vec3d sides{};
        for (int k = 0; k < axes; ++k) sides[k] = width + 1;
        drift(c, width, 1, sides, axes);
    }

    void advance() override { points_.advance(random_); }
    void place(std::span<aabb::box> boxes) final {
        for (std::size_t i = 0; i < boxes.size(); ++i) boxes[i] = box_at(points_[i], i);
    }
    [[nodiscard]] virtual aabb::box box_at(const Eigen::Vector3d& point, std::size_t /*object*/) const {
        return cube_at(point, 1);
    }

    drifting_points points_;
};

}  // namespace aabblab
