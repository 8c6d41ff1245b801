module;
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>
#include <tuple>
#include <vector>

module aabblab.scenes:explosion;

import aabb.geometry;
import aabb.policy;
import :boxes;
import :drift;
import :random;

namespace aabblab {

/// Unit cubes that fill a cube of their own volume, overlap about eight others each, and creep outwards; after a third
/// of the frames they fly apart, and in the last third they stand still. What serves one third does not serve the next.
class explosion final : public generated_boxes {
public:
    static constexpr std::string_view name = "explosion";
    static constexpr std::string_view summary =
        "unit cubes heaped in a cube that creep outwards, then fly apart, then stand still, a third of the frames each";

    struct config : scene_size {
        /// How far a cube moves in a frame while it flies, in edges; before, a hundredth of that.
        double displacement = 0.5;
    };
    static constexpr auto parameters = std::tuple_cat(
        size_parameters, std::tuple{aabb::number_parameter{"displacement", &config::displacement, 0.0, 1e9,
                                                           "the way of a cube in a frame while it flies, in edges"}});

    explosion(const config& c, std::uint64_t seed)
        : generated_boxes(name, c, seed, sizeof(flying_box)), frames_(c.frames) {
        const double side = cube_root(c.objects);
        flight_ = c.displacement;
        boxes_.reserve(c.objects);
        for (std::uint32_t i = 0; i < c.objects; ++i) {
            flying_box b{};
            for (int k = 0; k < 3; ++k) b.corner[k] = side * random_.within() / 2;
            const double away = std::sqrt(aabb::dot(b.corner, b.corner));
            b.direction = random_.direction();
            for (int k = 0; k < 3 && away > 0; ++k) b.direction[k] = b.corner[k] / away;
            boxes_.push_back(b);
        }
    }

private:
    struct flying_box {
        aabb::vec3d corner;
        aabb::vec3d direction;
    };

    void advance() override {
        ++frame_;
        const double step = 3 * frame_ <= frames_ ? flight_ / 100 : 3 * frame_ <= 2 * frames_ ? flight_ : 0;
        for (flying_box& b : boxes_)
            for (int k = 0; k < 3; ++k) b.corner[k] += step * b.direction[k];
    }

    void place(std::span<aabb::box> boxes) override {
        for (std::size_t i = 0; i < boxes.size(); ++i) boxes[i] = cube_at(boxes_[i].corner, 1);
    }

    std::uint64_t frames_;
    std::uint64_t frame_ = 0;
    double flight_ = 0;
    std::vector<flying_box> boxes_;
};

}  // namespace aabblab
