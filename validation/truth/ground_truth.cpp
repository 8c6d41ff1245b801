module aabb.truth;

import aabb.engines;

namespace aabb {

namespace {

double length_of(const vec3d& v) {
    return std::sqrt(dot(v, v));
}

}  // namespace

bool judge_intersection(const pose_pair& poses, const triangle3d& s, const triangle3d& t) {
    const bool intersect = exactly_intersect(poses, s, t);
    if (intersect_in_integers(poses, s, t) != intersect)
        throw std::logic_error("CGAL and integers disagree on a pair of triangles: one of them has a bug");
    return intersect;
}

/// Chooses brute force for few boxes, since it has the least that can be wrong, and CGAL where that is too slow.
ground_truth::ground_truth(std::size_t objects, const mesh_scene* meshes, const collision_filter* filter)
    : meshes_(meshes), filter_(filter) {
    constexpr std::size_t brute_force_limit = 20000;
    box_engine_ = objects <= brute_force_limit ? "brute_force" : "cgal";
    boxes_ = make_box_engine(box_engine_);
    if (!meshes) return;
    for (std::uint32_t object = 0; object < objects; ++object) boxes_->insert(object);
    triangles_ = make_mesh_engine("cgal");
    for (const mesh& m : meshes->meshes) {
        triangles_->add_model(m);
        spheres_.push_back(sphere_around(m));
    }
}

std::string ground_truth::name() const {
    return triangles_ ? box_engine_ + " for boxes, cgal on all pairs of objects for triangles" : box_engine_;
}

/// Finds the pairs of boxes and, in a scene of meshes, the contacts of all objects whose bounding spheres overlap.
void ground_truth::compute(const scene_frame& frame) {
    pairs_.clear();
    contacts_.clear();
    for (const std::uint32_t object : frame.departures) boxes_->remove(object);
    for (const std::uint32_t object : frame.arrivals) boxes_->insert(object);
    if (frame.boxes_in_double.empty()) {
        boxes_->update(frame.boxes);
        boxes_->search(pairs_);
    } else {
        // A sweep along x.
        const std::span<const boxd> boxes = frame.boxes_in_double;
        const auto low = [&](std::uint32_t object) { return boxes[object].min[0]; };
        std::vector<std::uint32_t> by_low(boxes.size());
        std::iota(by_low.begin(), by_low.end(), 0U);
        std::ranges::sort(by_low, {}, low);
        for (std::size_t i = 0; i < by_low.size(); ++i)
            for (std::size_t j = i + 1; j < by_low.size() && low(by_low[j]) <= boxes[by_low[i]].max[0]; ++j)
                if (boxes[by_low[i]].overlaps(boxes[by_low[j]])) pairs_.push_back(ordered_pair(by_low[i], by_low[j]));
    }
    if (filter_) filter_->apply(pairs_);
    std::ranges::sort(pairs_);
    if (!triangles_) return;
    update_deformed_meshes();
    const std::vector<std::uint32_t>& mesh_of = meshes_->mesh_of;
    std::vector<index_pair> triangle_pairs;
    for (const auto [a, b] : overlapping_spheres(frame.poses)) {
        if (filter_ && !filter_->keeps(a, b)) continue;
        triangle_pairs.clear();
        triangles_->all_pairs(mesh_of[a], frame.poses[a], mesh_of[b], frame.poses[b], triangle_pairs);
        for (const auto [s, t] : triangle_pairs) contacts_.push_back({a, b, s, t});
    }
    std::ranges::sort(contacts_);
}

/// Refits the models of the meshes that deform, and computes their spheres anew.
void ground_truth::update_deformed_meshes() {
    const std::vector<mesh>& meshes = meshes_->meshes;
    for (std::uint32_t m = 0; m < meshes.size(); ++m) {
        if (!meshes_->deforms(m)) continue;
        triangles_->refit(m);
        spheres_[m] = sphere_around(meshes[m]);
    }
}

/// A sphere that contains the mesh, in the mesh's frame, around the centre of its box.
ground_truth::sphere ground_truth::sphere_around(const mesh& m) {
    const box bounds = bounds_of(m);
    sphere bounding{};
    for (int k = 0; k < 3; ++k) bounding.centre[k] = (double{bounds.min[k]} + double{bounds.max[k]}) / 2;
    bounding.centre = m.frame.vertex(bounding.centre);
    double extent = 0;
    for (std::size_t v = 0; v < m.vertices.size(); ++v) {
        const vec3d p = m.given_vertex(v);
        bounding.radius = std::max(bounding.radius, length_of(p - bounding.centre));
        extent = std::max(extent, length_of(p));
    }
    // A generous margin: the effect of rounding and of inexact rotations is less than a 100,000th of the extent.
    bounding.radius += 0.01 * extent;
    return bounding;
}

/// The pairs of objects whose spheres overlap, by a sweep over their intervals on x.
std::vector<index_pair> ground_truth::overlapping_spheres(std::span<const pose> poses) const {
    std::vector<sphere> spheres;
    for (std::size_t object = 0; object < poses.size(); ++object) {
        const pose& p = poses[object];
        const sphere& local = spheres_[meshes_->mesh_of[object]];
        // A rotation keeps lengths; another map scales them by at most three times its greatest entry.
        const auto size = [](double x) { return std::abs(x); };
        const double scale = orthonormality_error(p) <= 1e-6 ? 1 : 3 * size(std::ranges::max(p.rotation, {}, size));
        constexpr double least = std::numeric_limits<double>::denorm_min();
        sphere world{p.translation, local.radius * scale + 1e-9 * length_of(p.translation) + least};  // for rounding
        for (int i = 0; i < 3; ++i)
            for (int j = 0; j < 3; ++j) world.centre[i] += p.rotation[3 * i + j] * local.centre[j];
        spheres.push_back(world);
    }
    const auto low = [&](std::uint32_t object) { return spheres[object].centre[0] - spheres[object].radius; };
    std::vector<std::uint32_t> by_low(spheres.size());
    std::iota(by_low.begin(), by_low.end(), 0U);
    std::ranges::sort(by_low, {}, low);
    std::vector<index_pair> near;
    for (std::size_t i = 0; i < by_low.size(); ++i) {
        const sphere& first = spheres[by_low[i]];
        for (std::size_t j = i + 1; j < by_low.size() && low(by_low[j]) <= first.centre[0] + first.radius; ++j) {
            const sphere& second = spheres[by_low[j]];
            if (length_of(first.centre - second.centre) <= first.radius + second.radius)
                near.push_back(ordered_pair(by_low[i], by_low[j]));
        }
    }
    return near;
}

}  // namespace aabb
