module;
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <numeric>
#include <span>
#include <string>
#include <vector>

module aabblab.play;

import :player;
import aabb;
import aabb.validation;

namespace aabblab {

namespace {

double length_of(const aabb::vec3d& v) {
    return std::sqrt(aabb::dot(v, v));
}

}  // namespace

judge::judge(const scene_play& scene) : scene_(scene) {
    constexpr std::size_t most_for_brute_force = 20000;
    box_engine_ = scene.objects() <= most_for_brute_force ? "brute_force" : "cgal";
    boxes_ = aabb::make_box_engine(box_engine_);
    if (!scene.meshes()) return;
    for (std::uint32_t object = 0; object < scene.objects(); ++object) boxes_->insert(object);
    triangles_ = aabb::make_mesh_engine("cgal");
    for (const aabb::mesh& m : scene.meshes()->meshes) {
        triangles_->add_model(m);
        spheres_.push_back(sphere_around(m));
    }
}

std::string judge::name() const {
    return triangles_ ? box_engine_ + " for boxes, cgal on all pairs of objects for triangles" : box_engine_;
}

void judge::play(std::span<const aabb::box> boxes) {
    pairs_.clear();
    contacts_.clear();
    for (const std::uint32_t object : scene_.departures()) boxes_->remove(object);
    for (const std::uint32_t object : scene_.arrivals()) boxes_->insert(object);
    boxes_->update(boxes);
    boxes_->search(pairs_);
    std::ranges::sort(pairs_);
    if (!triangles_) return;
    follow_meshes();
    const std::vector<std::uint32_t>& mesh_of = scene_.meshes()->mesh_of;
    std::vector<aabb::index_pair> found;
    for (const auto [a, b] : near_objects()) {
        found.clear();
        triangles_->all_pairs(mesh_of[a], scene_.poses()[a], mesh_of[b], scene_.poses()[b], found);
        for (const auto [s, t] : found) contacts_.push_back({a, b, s, t});
    }
    std::ranges::sort(contacts_);
}

void judge::follow_meshes() {
    const std::vector<aabb::mesh>& meshes = scene_.meshes()->meshes;
    for (std::uint32_t m = 0; m < meshes.size(); ++m) {
        if (!scene_.meshes()->deforms(m)) continue;
        triangles_->refit(m);
        spheres_[m] = sphere_around(meshes[m]);
    }
}

judge::sphere judge::sphere_around(const aabb::mesh& m) {
    const aabb::box bounds = aabb::bounds_of(m);
    sphere around{};
    for (int k = 0; k < 3; ++k) around.centre[k] = (double{bounds.min[k]} + double{bounds.max[k]}) / 2;
    double reach = 0;
    for (const aabb::vec3f& v : m.vertices) {
        const aabb::vec3d p{v[0], v[1], v[2]};
        around.radius = std::max(around.radius, length_of(p - around.centre));
        reach = std::max(reach, length_of(p));
    }
    // Generous: all that rounding and a pose's distance from a rotation can do is less than a 100,000th of the reach.
    around.radius += 0.01 * reach;
    return around;
}

std::vector<aabb::index_pair> judge::near_objects() const {
    std::vector<sphere> placed;
    for (std::size_t object = 0; object < scene_.objects(); ++object) {
        const aabb::pose& p = scene_.poses()[object];
        const sphere& local = spheres_[scene_.meshes()->mesh_of[object]];
        sphere world{p.translation, local.radius + 1e-9 * length_of(p.translation)};
        for (int i = 0; i < 3; ++i)
            for (int j = 0; j < 3; ++j) world.centre[i] += p.rotation[3 * i + j] * local.centre[j];
        placed.push_back(world);
    }
    const auto low = [&](std::uint32_t object) { return placed[object].centre[0] - placed[object].radius; };
    std::vector<std::uint32_t> by_low(placed.size());
    std::iota(by_low.begin(), by_low.end(), 0U);
    std::ranges::sort(by_low, {}, low);
    std::vector<aabb::index_pair> near;
    for (std::size_t i = 0; i < by_low.size(); ++i) {
        const sphere& one = placed[by_low[i]];
        for (std::size_t j = i + 1; j < by_low.size() && low(by_low[j]) <= one.centre[0] + one.radius; ++j) {
            const sphere& other = placed[by_low[j]];
            if (length_of(one.centre - other.centre) <= one.radius + other.radius)
                near.push_back(aabb::ordered_pair(by_low[i], by_low[j]));
        }
    }
    return near;
}

}  // namespace aabblab
