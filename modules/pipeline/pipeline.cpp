module;
#include <algorithm>
#include <cassert>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

module aabb.pipeline;

import aabb.base;
import aabb.geometry;

namespace aabb {

pipeline::pipeline(const mesh_scene& scene, global_stage& global, local_stage& local)
    : scene_(scene), global_(global), local_(local), boxes_(scene.mesh_of.size()) {
    assert(std::ranges::all_of(scene.mesh_of, [&](std::uint32_t m) { return m < scene.meshes.size(); }));
    for (const mesh& m : scene.meshes) {
        local_.add_model(m);
        mesh_bounds_.push_back(bounds_of(m));
    }
    for (std::uint32_t object = 0; object < scene.mesh_of.size(); ++object) global_.insert(object);
}

void pipeline::update(std::span<const pose> poses) {
    frame_.begin();
    searched_ = false;
    require_ieee_arithmetic();
    if (poses.size() != boxes_.size())
        throw input_error("the scene has " + std::to_string(boxes_.size()) + " objects, but the frame has " +
                          std::to_string(poses.size()) + " poses");
    poses_.assign(poses.begin(), poses.end());
    for (std::uint32_t m = 0; m < scene_.meshes.size(); ++m)
        if (scene_.deforms(m)) {
            local_.refit(m);
            mesh_bounds_[m] = bounds_of(scene_.meshes[m]);
        }
    for (std::size_t object = 0; object < poses.size(); ++object) {
        try {
            require_rigid(poses[object]);
        } catch (const input_error& error) {
            throw input_error("object " + std::to_string(object) + ": " + error.what());
        }
        boxes_[object] = world_bounds(mesh_bounds_[scene_.mesh_of[object]], poses[object]);
        if (!is_valid(boxes_[object]))
            throw input_error("object " + std::to_string(object) + " lies beyond the range of float");
    }
    global_.update(boxes_);
    frame_.taken();
}

void pipeline::search() {
    frame_.require_taken();
    searched_ = false;
    candidates_.clear();
    global_.search(candidates_);
    assert(std::ranges::all_of(candidates_, [&](index_pair p) { return p.a < p.b && p.b < boxes_.size(); }));
    searched_ = true;
}

void pipeline::detect() {
    contacts_.clear();
    if (!searched_)
        throw input_error("there are no candidates to decide on: search was not called, or did not succeed");
    assert(poses_.size() == boxes_.size());
    append_whole(contacts_, [&] {
        for (const auto [a, b] : candidates_) {
            triangle_pairs_.clear();
            local_.all_pairs(scene_.mesh_of[a], poses_[a], scene_.mesh_of[b], poses_[b], triangle_pairs_);
            for (const auto [s, t] : triangle_pairs_) contacts_.push_back({a, b, s, t});
        }
    });
}

std::size_t pipeline::bytes() const noexcept {
    return bytes_of(mesh_bounds_) + bytes_of(poses_) + bytes_of(boxes_) + bytes_of(candidates_) +
           bytes_of(triangle_pairs_) + bytes_of(contacts_);
}

}  // namespace aabb
