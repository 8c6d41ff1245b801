module;
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <utility>
#include <vector>

module aabb.extreme;

import aabb.geometry;
import aabb.pipeline;
import :draws;
import :known_scenes;
import :making;
import :scene;

namespace aabb {

namespace {

constexpr std::uint32_t objects = 72;
constexpr std::size_t frame_count = 6;

using presence = std::vector<std::vector<std::uint8_t>>;

extreme_scene scene_of(std::string name, std::string summary, std::function<std::unique_ptr<box_scene>()> make) {
    extreme_scene made{.name = std::move(name), .summary = std::move(summary)};
    made.make_boxes = std::move(make);
    return made;
}

box_frames elsewhere_in_each(float size) {
    draws random(31);
    box_frames all(frame_count);
    for (std::vector<box>& boxes : all)
        for (std::uint32_t i = 0; i < objects; ++i) boxes.push_back(box_at(random.point(0, 10), random.point(0, size)));
    return all;
}

std::unique_ptr<box_scene> teleporting() {
    return std::make_unique<known_boxes>(elsewhere_in_each(4));
}

std::unique_ptr<box_scene> huge_and_tiny() {
    box_frames all = elsewhere_in_each(4);
    for (std::size_t frame = 0; frame < all.size(); ++frame)
        for (box& b : all[frame])
            for (int k = 0; k < 3; ++k) {
                const float scale = frame % 2 == 0 ? 1e9F : 1e-9F;
                b.min[k] *= scale;
                b.max[k] *= scale;
            }
    return std::make_unique<known_boxes>(std::move(all));
}

/// @param is_there of an object in a frame
template <class IsThere>
std::unique_ptr<box_scene> population(IsThere is_there) {
    box_frames all = elsewhere_in_each(4);
    presence present(all.size(), std::vector<std::uint8_t>(objects));
    for (std::size_t frame = 0; frame < all.size(); ++frame)
        for (std::uint32_t i = 0; i < objects; ++i) {
            present[frame][i] = static_cast<std::uint8_t>(is_there(frame, i));
            // An absent object stands where nothing else is.
            if (!present[frame][i]) all[frame][i] = bounds_of(vec3f{1000 + static_cast<float>(i), 0, 0});
        }
    return std::make_unique<known_boxes>(std::move(all), std::move(present));
}

std::unique_ptr<box_scene> comings_and_goings() {
    return population([](std::size_t frame, std::uint32_t i) { return (frame + i) % 3 != 0; });
}

std::unique_ptr<box_scene> all_leave() {
    return population([](std::size_t frame, std::uint32_t) { return frame % 3 != 1; });
}

std::unique_ptr<box_scene> all_change() {
    return population([](std::size_t frame, std::uint32_t i) { return (i < objects / 2) == (frame % 2 == 0); });
}

}  // namespace

std::vector<extreme_scene> box_change_scenes() {
    return {
        scene_of("teleport", "everything is elsewhere in each frame", teleporting),
        scene_of("huge_and_tiny", "in turn 10^9 times as large and as small", huge_and_tiny),
        scene_of("comings_and_goings", "a third of the objects leaves in each frame, another comes back",
                 comings_and_goings),
        scene_of("all_leave", "all leave, all come back", all_leave),
        scene_of("all_change", "one half leaves as the other comes", all_change),
    };
}

}  // namespace aabb
