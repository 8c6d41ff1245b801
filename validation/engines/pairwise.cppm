module aabb.engines:pairwise;

import aabb.pipeline;
import aabb.std;
import :mesh_engine;

namespace aabb {

/// A box for CGAL's algorithm, which never reports pairs of boxes with the same number. Coordinates are doubles,
/// because the algorithm uses the greatest value of their type as infinity, and boxes may end at the greatest float.
struct numbered_box {
    using NT = double;         // NOLINT(readability-identifier-naming)
    using ID = std::uint64_t;  // NOLINT(readability-identifier-naming)

    box bounds;
    ID number;

    static inline int dimension() { return 3; }
    [[nodiscard]] inline ID id() const { return number; }
    [[nodiscard]] inline NT min_coord(int axis) const { return bounds.min[axis]; }
    [[nodiscard]] inline NT max_coord(int axis) const { return bounds.max[axis]; }
};

/// Finds pairs of overlapping boxes: {i, t} for box i of `a` and t of `b`, in any order.
using candidate_search = std::vector<index_pair>(std::span<const box> a, std::span<const box> b);
/// CGAL's intersection of box sequences (Zomorodian and Edelsbrunner 2002).
candidate_search candidates_by_cgal;

/// Two triangles of meshes at poses: as they are given, and as floats in the frame of the first mesh.
struct posed_triangles {
    const pose_pair& poses;
    triangle3d s, t;
    triangle3f s_in_float, image_of_t;
};
using triangle_decision = bool(const posed_triangles& pair);

/// Decides exactly, at the poses.
triangle_decision intersect_exactly;

struct boxed_model : engine_model {
    std::vector<box> boxes{};  ///< by triangle

    [[nodiscard]] std::size_t bytes() const { return bytes_of(boxes); }
};

class pairwise_engine final : public model_engine<boxed_model> {
public:
    pairwise_engine(candidate_search& search, triangle_decision& decide) : search_(search), decide_(decide) {}

private:
    void update_model(boxed_model& changed) override {
        changed.boxes.clear();
        for (std::uint32_t t = 0; t < changed.count; ++t)
            changed.boxes.push_back(bounds_of(changed.source->triangle(t)));
    }

    void append_pairs(const model_query& q, std::vector<index_pair>& pairs) override {
        decide(q, [&](index_pair pair) {
            pairs.push_back(pair);
            return false;
        });
    }

    [[nodiscard]] std::optional<index_pair> any_pair(const model_query& q) override {
        std::optional<index_pair> first;
        decide(q, [&](index_pair pair) {
            first = pair;
            return true;
        });
        return first;
    }

    /// Calls `emit({s, t})` for each pair that `decide_` accepts, of those that `search_` finds by boxes in A's frame.
    template <class Emit>
    void decide(const model_query& q, Emit emit) const {
        const mesh& b = *q.b.source;
        const mesh& a = *q.a.source;
        const relative_pose to_a(q.pose_a, q.pose_b, q.b.bounds, a.frame, b.frame);
        std::vector<box> boxes_b;
        for (std::uint32_t t = 0; t < b.triangle_count(); ++t) boxes_b.push_back(box_around(b.triangle(t), to_a));
        const pose_pair poses{q.pose_a, q.pose_b};
        for (const index_pair near : search_(q.a.boxes, boxes_b))
            if (decide_({.poses = poses,
                         .s = a.given_triangle(near.a),
                         .t = b.given_triangle(near.b),
                         .s_in_float = a.triangle(near.a),
                         .image_of_t = to_a(b.triangle(near.b))}) &&
                emit(near))
                return;
    }

    candidate_search& search_;
    triangle_decision& decide_;
};

/// An engine that transforms B's triangles into A's frame (`relative_pose`), finds candidates by boxes and tests them.
std::unique_ptr<local_stage> make_pairwise_engine(candidate_search& search, triangle_decision& decide) {
    return std::make_unique<pairwise_engine>(search, decide);
}

}  // namespace aabb
