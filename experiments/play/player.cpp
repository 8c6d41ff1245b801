module;
#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

module aabblab.play;

import :player;
import aabb;
import aabblab.scenes;

namespace aabblab {

scene_play::scene_play(const scene_choice& choice) {
    const auto info = std::ranges::find(scene_kinds(), choice.kind, &scene_info::name);
    if (info != scene_kinds().end() && info->has_meshes)
        meshes_ = make_mesh_scene(choice);
    else
        box_scene_ = make_box_scene(choice);
}

std::size_t scene_play::objects() const {
    return meshes_ ? meshes_->mesh_of.size() : box_scene_->objects();
}

std::size_t scene_play::frames() const {
    return meshes_ ? meshes_->frames() : box_scene_->frames();
}

bool scene_play::next() {
    if (meshes_) return meshes_->next(poses_);
    if (!box_scene_->next(boxes_)) return false;
    note_changes(box_scene_->present());
    return true;
}

void scene_play::note_changes(std::span<const std::uint8_t> present) {
    arrivals_.clear();
    departures_.clear();
    present_.resize(boxes_.size(), 0);
    for (std::uint32_t object = 0; object < boxes_.size(); ++object) {
        const bool is_present = present.empty() || present[object] != 0;
        if (is_present == (present_[object] != 0)) continue;
        present_[object] = is_present;
        (is_present ? arrivals_ : departures_).push_back(object);
    }
}

player::player(const contender& who, const scene_play& scene, aabb::instrumentation counted)
    : scene_(scene), global_(who.make_global(counted)) {
    if (scene.meshes()) {
        local_ = who.make_local(counted);
        pipeline_ = std::make_unique<aabb::pipeline>(*scene.meshes(), *global_, *local_);
    }
}

void player::update() {
    if (pipeline_) return pipeline_->update(scene_.poses());
    for (const std::uint32_t object : scene_.departures()) global_->remove(object);
    for (const std::uint32_t object : scene_.arrivals()) global_->insert(object);
    global_->update(scene_.boxes());
}

void player::search() {
    if (pipeline_) return pipeline_->search();
    pairs_.clear();
    global_->search(pairs_);
}

void player::detect() {
    if (pipeline_) pipeline_->detect();
}

const std::vector<aabb::index_pair>& player::sorted_pairs() {
    if (pipeline_) pairs_.assign(pipeline_->candidates().begin(), pipeline_->candidates().end());
    std::ranges::sort(pairs_);
    return pairs_;
}

const std::vector<aabb::contact>& player::sorted_contacts() {
    if (pipeline_) contacts_.assign(pipeline_->contacts().begin(), pipeline_->contacts().end());
    std::ranges::sort(contacts_);
    return contacts_;
}

aabb::work_counters player::counters() const {
    aabb::work_counters all = global_->counters();
    if (local_)
        for (std::size_t i = 0; i < all.counts.size(); ++i) all.counts[i] += local_->counters().counts[i];
    return all;
}

std::vector<aabb::part_bytes> player::local_bytes() const {
    if (!local_) return {};
    std::vector<aabb::part_bytes> parts = local_->bytes();
    std::size_t triangles = 0;
    std::size_t vertices = 0;
    for (const aabb::mesh& m : scene_.meshes()->meshes) {
        triangles += aabb::bytes_of(m.triangles);
        vertices += aabb::bytes_of(m.vertices);
    }
    parts.push_back({"triangles", triangles});
    parts.push_back({"vertices", vertices});
    return parts;
}

std::size_t player::buffer_bytes() const {
    return pipeline_ ? pipeline_->bytes() : aabb::bytes_of(pairs_);
}

std::vector<std::string> player::left_out() const {
    std::vector<std::string> all = global_->left_out();
    if (!local_) all.emplace_back("no local detection: no meshes, no trees, no triangle test");
    for (std::string& sentence : local_ ? local_->left_out() : std::vector<std::string>{})
        if (std::ranges::find(all, sentence) == all.end()) all.push_back(std::move(sentence));
    return all;
}

std::optional<double> player::box_inflation() const {
    if (!local_) return std::nullopt;
    double sum = 0;
    const std::size_t meshes = scene_.meshes()->meshes.size();
    for (std::uint32_t m = 0; m < meshes; ++m) {
        const std::optional<aabb::tree_survey> seen = local_->survey(m);
        if (!seen) return std::nullopt;
        sum += seen->area_inflation;
    }
    return sum / static_cast<double>(meshes);
}

void tally::add(const std::vector<aabb::index_pair>& pairs, const std::vector<aabb::contact>& contacts) {
    candidates_ += pairs.size();
    if (meshes_) {
        contacts_ += contacts.size();
        for (const aabb::contact& c : contacts) digest_.add(std::array{frame_, c.a, c.b, c.triangle_a, c.triangle_b});
    } else {
        digest_.add(frame_, pairs);
    }
    ++frame_;
}

std::optional<std::uint64_t> tally::contacts() const {
    return meshes_ ? std::optional(contacts_) : std::nullopt;
}

}  // namespace aabblab
