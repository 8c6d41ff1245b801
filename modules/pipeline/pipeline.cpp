module;
#include <algorithm>
#include <cassert>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <utility>
#include <vector>

module aabb.pipeline;

import aabb.base;
import aabb.geometry;

namespace aabb {

pipeline::pipeline(const mesh_scene& scene, global_stage& global, local_stage& local)
    : scene_(scene), global_(&global), local_(local) {
    if (mesh_division division = global.divide(scene); !division.empty()) divided_.emplace(scene, std::move(division));
    add_models();
    if (!divided_) world_.emplace(scene);
    const auto count = divided_ ? divided_->pieces() : static_cast<std::uint32_t>(scene.mesh_of.size());
    for (std::uint32_t id = 0; id < count; ++id) global.insert(id);
}

pipeline::pipeline(const mesh_scene& scene, local_stage& local) : scene_(scene), local_(local) {
    add_models();
}

void pipeline::add_models() {
    assert(std::ranges::all_of(scene_.mesh_of, [&](std::uint32_t m) { return m < scene_.meshes.size(); }));
    for (std::uint32_t m = 0; m < models(); ++m) local_.add_model(divided_ ? divided_->mesh_of(m) : scene_.meshes[m]);
}

std::uint32_t pipeline::models() const noexcept {
    return divided_ ? divided_->models() : static_cast<std::uint32_t>(scene_.meshes.size());
}

/// Refitting refuses a mesh of which no box could be made.
void pipeline::follow_meshes() {
    if (divided_) divided_->follow();
    for (std::uint32_t m = 0; m < models(); ++m)
        if (divided_ ? divided_->deforms(m) : scene_.deforms(m)) local_.refit(m);
}

void pipeline::update(std::span<const pose> poses) {
    frame_.begin();
    searched_ = false;
    require_ieee_arithmetic();
    follow_meshes();
    if (divided_)
        divided_->place(poses);
    else if (world_)
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
    if (divided_) {
        pieces_.clear();
        global_->search(pieces_);
        // Parts of one object never meet.
        std::erase_if(pieces_, [&](index_pair p) { return divided_->object_of(p.a) == divided_->object_of(p.b); });
        for (const auto [a, b] : pieces_) candidates_.push_back({divided_->object_of(a), divided_->object_of(b)});
    } else if (global_) {
        global_->search(candidates_);
    } else {
        for (std::uint32_t b = 0; b < poses_.size(); ++b)
            for (std::uint32_t a = 0; a < b; ++a) candidates_.push_back({a, b});
    }
    searched_ = true;
}

void pipeline::require_searched() const {
    if (!searched_)
        throw input_error("there are no candidates to decide on: search was not called, or did not succeed");
    assert(poses_.size() == scene_.mesh_of.size());
}

pipeline::model_pair pipeline::models_of(std::size_t candidate) const noexcept {
    if (divided_) return {divided_->model_of(pieces_[candidate].a), divided_->model_of(pieces_[candidate].b)};
    return {scene_.mesh_of[candidates_[candidate].a], scene_.mesh_of[candidates_[candidate].b]};
}

/// @param triangles of the two models
contact pipeline::contact_of(std::size_t candidate, index_pair triangles) const noexcept {
    const auto [a, b] = candidates_[candidate];
    if (!divided_) return {a, b, triangles.a, triangles.b};
    const model_pair models = models_of(candidate);
    return {a, b, divided_->triangle_of(models.a, triangles.a), divided_->triangle_of(models.b, triangles.b)};
}

void pipeline::detect() {
    contacts_.clear();
    require_searched();
    append_whole(contacts_, [&] {
        for (std::size_t i = 0; i < candidates_.size(); ++i) {
            const auto [a, b] = models_of(i);
            triangle_pairs_.clear();
            local_.all_pairs(a, poses_[candidates_[i].a], b, poses_[candidates_[i].b], triangle_pairs_);
            for (const index_pair found : triangle_pairs_) contacts_.push_back(contact_of(i, found));
        }
    });
}

std::optional<contact> pipeline::first_contact() {
    require_searched();
    for (std::size_t i = 0; i < candidates_.size(); ++i) {
        const auto [a, b] = models_of(i);
        if (const auto found = local_.first_pair(a, poses_[candidates_[i].a], b, poses_[candidates_[i].b]))
            return contact_of(i, *found);
    }
    return std::nullopt;
}

std::uint64_t pipeline::count_contacts() {
    require_searched();
    std::uint64_t count = 0;
    for (std::size_t i = 0; i < candidates_.size(); ++i) {
        const auto [a, b] = models_of(i);
        count += local_.count_pairs(a, poses_[candidates_[i].a], b, poses_[candidates_[i].b]);
    }
    return count;
}

std::size_t pipeline::bytes() const noexcept {
    return (world_ ? world_->bytes() : 0) + bytes_of(poses_) + bytes_of(candidates_) + bytes_of(pieces_) +
           bytes_of(triangle_pairs_) + bytes_of(contacts_);
}

}  // namespace aabb
