module aabb.extreme;

namespace aabb {

namespace {

/// Two closed boxes overlap if on each axis some number lies in both intervals.
bool share_a_point(const box& a, const box& b) {
    for (int k = 0; k < 3; ++k)
        if (!((a.min[k] <= b.min[k] && b.min[k] <= a.max[k]) || (b.min[k] <= a.min[k] && a.min[k] <= b.max[k])))
            return false;
    return true;
}

/// Records the objects that arrive and depart between the previous frame and this one.
void add_changes(exact_box_frame& frame, const std::vector<std::uint8_t>& previously_present,
                 const std::vector<std::uint8_t>& present) {
    for (std::uint32_t object = 0; object < present.size(); ++object) {
        const bool was_present = object < previously_present.size() && previously_present[object];
        if (present[object] && !was_present) frame.arrivals.push_back(object);
        if (!present[object] && was_present) frame.departures.push_back(object);
    }
}

/// Calls `visit` for all intersecting pairs of triangles of two meshes at their poses, until it returns true.
template <class Visit>
void for_each_true_pair(const mesh& a, const mesh& b, const pose_pair& poses, Visit visit) {
    for (std::uint32_t t = 0; t < b.triangle_count(); ++t)
        for (std::uint32_t s = 0; s < a.triangle_count(); ++s)
            if (judge_intersection(poses, a.given_triangle(s), b.given_triangle(t)) && visit(index_pair{s, t})) return;
}

/// The ground truth for two objects by a double loop; for `first_pair`, it only records whether a pair exists.
exact_objects exact_objects_of(const mesh_scene& scene, const std::vector<pose>& poses, index_pair objects,
                               extreme_query query) {
    exact_objects result{.a = objects.a, .b = objects.b, .pairs = {}};
    const mesh& a = scene.meshes[scene.mesh_of[objects.a]];
    const mesh& b = scene.meshes[scene.mesh_of[objects.b]];
    for_each_true_pair(a, b, {poses[objects.a], poses[objects.b]}, [&](index_pair pair) {
        result.intersect = true;
        if (query != extreme_query::first_pair) result.pairs.push_back(pair);
        return query == extreme_query::first_pair;
    });
    std::ranges::sort(result.pairs);
    return result;
}

}  // namespace

/// The ground truth of a scene of boxes: the pairs of each frame by a double loop, and arrivals and departures.
exact_boxes exact_boxes_of(box_scene& scene) {
    exact_boxes frames;
    std::vector<std::uint8_t> previously_present;
    for (exact_box_frame frame; scene.next(frame.boxes); frame = {}) {
        std::vector<std::uint8_t> present(scene.present().begin(), scene.present().end());
        if (present.empty()) present.assign(frame.boxes.size(), 1);  // all objects are always present
        add_changes(frame, std::exchange(previously_present, present), present);
        for (std::uint32_t a = 0; a < frame.boxes.size(); ++a)
            for (std::uint32_t b = a + 1; b < frame.boxes.size(); ++b)
                if (present[a] && present[b] && share_a_point(frame.boxes[a], frame.boxes[b]))
                    frame.pairs.push_back({a, b});
        frames.push_back(frame);
    }
    return frames;
}

/// The ground truth of a scene of meshes: the pairs of triangles of each two objects in each frame, as far as the query
/// needs them, and, for all queries on a scene of one mesh, the pairs within that mesh.
exact_meshes exact_meshes_of(mesh_scene& scene, extreme_query query) {
    exact_meshes truth;
    for (exact_mesh_frame frame; scene.next(frame.poses); frame = {}) {
        for (std::uint32_t a = 0; a < frame.poses.size(); ++a)
            for (std::uint32_t b = a + 1; b < frame.poses.size(); ++b)
                frame.objects.push_back(exact_objects_of(scene, frame.poses, {a, b}, query));
        truth.frames.push_back(frame);
    }
    if (scene.meshes.size() != 1 || query != extreme_query::all_pairs) return truth;  // `all_pairs` runs all queries
    const mesh& m = scene.meshes[0];
    for (std::uint32_t a = 0; a < m.triangle_count(); ++a)
        for (std::uint32_t b = a + 1; b < m.triangle_count(); ++b)
            if (judge_intersection({}, m.given_triangle(a), m.given_triangle(b))) truth.self_pairs.push_back({a, b});
    return truth;
}

bool is_true_pair(const mesh_scene& scene, const exact_mesh_frame& frame, const exact_objects& objects,
                  const index_pair& pair) {
    const mesh& a = scene.meshes[scene.mesh_of[objects.a]];
    const mesh& b = scene.meshes[scene.mesh_of[objects.b]];
    if (pair.a >= a.triangle_count() || pair.b >= b.triangle_count()) return false;
    return judge_intersection({frame.poses[objects.a], frame.poses[objects.b]}, a.given_triangle(pair.a),
                              b.given_triangle(pair.b));
}

}  // namespace aabb
