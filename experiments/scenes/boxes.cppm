module;
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <tuple>
#include <vector>

/// What the kinds of scenes of boxes share.
module aabblab.scenes:boxes;

import aabb.geometry;
import aabb.pipeline;
import aabb.policy;
import aabblab.files;
import :drift;
import :random;
import :spacing;

namespace aabblab {

struct scene_size {
    std::uint32_t objects = 1000;
    std::uint32_t frames = 20;
};
inline constexpr std::tuple size_parameters{
    aabb::integer_parameter{"objects", &scene_size::objects, 0U, 0x7fffffffU, "how many boxes"},
    aabb::integer_parameter{"frames", &scene_size::frames, 0U, 0x7ffffffeU, "frames after the first one"}};

/// What a displacement is a fraction of: the mean extent of the boxes, or their mean spacing.
enum class length_unit : unsigned char { extent, spacing };

struct motion_config : scene_size {
    /// How far a box moves in a frame.
    double displacement = 0.1;
    length_unit unit = length_unit::extent;
};
/// @param way what `displacement` is
template <class Config>
[[nodiscard]] constexpr auto displacement_parameters(std::string_view way) {
    return std::tuple{
        aabb::number_parameter{"displacement", &Config::displacement, 0.0, 1e9, way},
        aabb::choice_parameter{
            "unit", &Config::unit, std::array<std::string_view, 2>{"extent", "spacing"},
            "what displacement is a fraction of: the mean extent of a box, or the mean spacing (the edge of the "
            "cube that each box would have for itself)"}};
}
inline constexpr auto motion_parameters = std::tuple_cat(
    size_parameters,
    displacement_parameters<motion_config>("the way of every box in a frame, unfolded where walls reflect it"));

/// `displacement` as a length.
/// @param extent of the boxes, mean
/// @param sides of the world, 0 on a flat axis
template <class Config>
[[nodiscard]] double step_of(const Config& c, double extent, const aabb::vec3d& sides) {
    return c.displacement * (c.unit == length_unit::extent ? extent : mean_spacing(sides, c.objects));
}

/// The cube with this lowest corner.
[[nodiscard]] inline aabb::box cube_at(const aabb::vec3d& corner, double edge) {
    aabb::box b{};
    for (int k = 0; k < 3; ++k) {
        b.min[k] = static_cast<float>(corner[k]);
        b.max[k] = static_cast<float>(corner[k] + edge);
    }
    return b;
}

/// The width of a cube (square, segment) in which each of so many unit cubes overlaps two others on average, wherever
/// their corners lie in it: one overlaps another whose corner lies in a cube of edge 2 around its own.
[[nodiscard]] inline double width_for(std::uint32_t objects, int axes) {
    return edge_of(static_cast<double>(objects) * (1 << axes) / 2, axes);
}

/// The corners of unit cubes that drift on the first `axes` axes in a world of that width.
[[nodiscard]] inline drifting_points drifting_corners(const motion_config& c, int axes, random_source& random) {
    const double width = width_for(c.objects, axes);
    aabb::vec3d sides{};
    for (int k = 0; k < axes; ++k) sides[k] = width + 1;
    const double step = step_of(c, 1, sides);
    return {c.objects, axes, width, {step, step}, random};
}

inline void place_cubes(const drifting_points& corners, std::span<aabb::box> boxes) {
    for (std::size_t i = 0; i < boxes.size(); ++i) boxes[i] = cube_at(corners[i], 1);
}

/// A scene of boxes that is made as it is played. A kind moves what it holds and places the boxes of a frame.
class generated_boxes : public aabb::box_scene {
public:
    [[nodiscard]] std::size_t objects() const final { return size_.objects; }
    [[nodiscard]] std::size_t frames() const final { return std::size_t{size_.frames} + 1; }

    bool next(std::vector<aabb::box>& boxes) final {
        if (frame_ == frames()) return false;
        if (frame_++ > 0) advance();
        boxes.resize(objects());
        place(boxes);
        return true;
    }

protected:
    /// @param bytes_each what the kind holds of an object
    generated_boxes(std::string_view name, const scene_size& size, std::uint64_t seed, double bytes_each)
        : random_(seed), size_(size) {
        require_memory("a " + std::string(name) + " scene of " + std::to_string(size.objects) + " objects",
                       size.objects * (bytes_each + sizeof(aabb::box)));
    }

    /// From one frame to the next.
    virtual void advance() {}
    virtual void place(std::span<aabb::box> boxes) = 0;

    random_source random_;

private:
    scene_size size_;
    std::size_t frame_ = 0;
};

}  // namespace aabblab
