module;
#include <algorithm>
#include <cassert>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

module aabb.pipeline;

import aabb.base;
import aabb.geometry;

namespace aabb {

pipeline::pipeline(const mesh_scene& scene, global_stage& global, local_stage& local)
    : scene_(scene), global_(&global), local_(local) {
    add_models();
    world_.emplace(scene);
    for (std::uint32_t object = 0; object < scene.mesh_of.size(); ++object) global.insert(object);
}

pipeline::pipeline(const mesh_scene& scene, local_stage& local) : scene_(scene), local_(local) {
    add_models();
}

void pipeline::add_models() {
    assert(std::ranges::all_of(scene_.mesh_of, [&](std::uint32_t m) { return m < scene_.meshes.size(); }));
    for (const mesh& m : scene_.meshes) local_.add_model(m);
}

void pipeline::update(std::span<const pose> poses) {
    frame_.begin();
    searched_ = false;
    require_ieee_arithmetic();
    // Refitting refuses a mesh of which no box could be made.
    for (std::uint32_t m = 0; m < scene_.meshes.size(); ++m)
        if (scene_.deforms(m)) local_.refit(m);
    if (world_)
        world_->update(poses);
    else
        require_poses(scene_, poses);
    poses_.assign(poses.begin(), poses.end());
    if (global_) global_->update(boxes());
    frame_.taken();
}

void pipeline::search() {
    frame_.require_taken();
    searched_ = false;
    candidates_.clear();
    if (global_) {
        global_->search(candidates_);
    } else {
        for (std::uint32_t b = 0; b < poses_.size(); ++b)
            for (std::uint32_t a = 0; a < b; ++a) candidates_.push_back({a, b});
    }
    searched_ = true;
}

void pipeline::detect() {
    contacts_.clear();
    if (!searched_)
        throw input_error("there are no candidates to decide on: search was not called, or did not succeed");
    assert(poses_.size() == scene_.mesh_of.size());
    append_whole(contacts_, [&] {
        for (const auto [a, b] : candidates_) {
            triangle_pairs_.clear();
            local_.all_pairs(scene_.mesh_of[a], poses_[a], scene_.mesh_of[b], poses_[b], triangle_pairs_);
            for (const auto [s, t] : triangle_pairs_) contacts_.push_back({a, b, s, t});
        }
    });
}

std::size_t pipeline::bytes() const noexcept {
    return (world_ ? world_->bytes() : 0) + bytes_of(poses_) + bytes_of(candidates_) + bytes_of(triangle_pairs_) +
           bytes_of(contacts_);
}

}  // namespace aabb
