module;
#include <array>
#include <cstdint>
#include <limits>
#include <span>
#include <utility>
#include <vector>

module aabb.extreme;

import aabb.geometry;
import :draws;
import :known_scenes;
import :making;
import :scene;

namespace aabb {

namespace {

constexpr float least = std::numeric_limits<float>::denorm_min();
constexpr float least_normal = std::numeric_limits<float>::min();
constexpr float most = std::numeric_limits<float>::max();

/// Two frames of boxes, each end of which is one of these numbers.
box_frames with_ends(std::span<const float> ends, std::uint32_t objects, std::uint32_t seed) {
    draws random(seed);
    const auto end = [&] { return ends[random.below(static_cast<std::uint32_t>(ends.size()))]; };
    box_frames all(2);
    for (std::vector<box>& boxes : all)
        for (std::uint32_t i = 0; i < objects; ++i) {
            box& b = boxes.emplace_back();
            for (int k = 0; k < 3; ++k) {
                b.min[k] = end();
                b.max[k] = end();
                if (b.min[k] > b.max[k]) std::swap(b.min[k], b.max[k]);
            }
        }
    return all;
}

box_frames denormals() {
    std::vector<float> ends;
    for (int i = -12; i <= 12; ++i) ends.push_back(static_cast<float>(i) * least);
    return with_ends(ends, 80, 21);
}

box_frames signed_zeros() {
    constexpr std::array<float, 8> ends{-1, -least_normal, -least, -0.0F, 0.0F, least, least_normal, 1};
    return with_ends(ends, 70, 22);
}

box_frames greatest_floats() {
    constexpr std::array<float, 5> ends{-most, -1, 0, 1, most};
    return with_ends(ends, 70, 23);
}

/// Of about ten in size, where floats are a sixteenth apart at a million, 64 apart at 10^9.
box_frames far_out(float offset) {
    draws random(24);
    box_frames all(2);
    for (std::vector<box>& boxes : all)
        for (std::uint32_t i = 0; i < 80; ++i) {
            const vec3f low = random.point(0, 40);
            boxes.push_back(box_at({offset + low[0], offset + low[1], -offset - low[2]}, random.point(0, 20)));
        }
    return all;
}

}  // namespace

std::vector<extreme_scene> box_place_scenes() {
    return {
        scene_of_boxes("denormals", "ends are small multiples of the least float", denormals),
        scene_of_boxes("signed_zeros", "-0 against +0, and the numbers next to them", signed_zeros),
        scene_of_boxes("greatest_floats", "boxes that reach to the greatest floats", greatest_floats),
        scene_of_boxes("far_1e6", "a million from the origin", [] { return far_out(1e6F); }),
        scene_of_boxes("far_1e9", "10^9 from it, where floats are 64 apart", [] { return far_out(1e9F); }),
    };
}

}  // namespace aabb
