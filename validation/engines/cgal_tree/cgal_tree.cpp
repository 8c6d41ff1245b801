module;
#include <CGAL/AABB_traits.h>
#include <CGAL/AABB_tree.h>
#include <CGAL/AABB_triangle_primitive.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>

#include "../exact_decision.hpp"

module aabb.engines;

import :engine;
import :mesh_engine;

namespace aabb {

namespace {

using kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using kernel_triangles = std::vector<kernel::Triangle_3>;
using primitive = CGAL::AABB_triangle_primitive<kernel, kernel_triangles::const_iterator>;

[[nodiscard]] kernel::Triangle_3 in_kernel(const triangle3f& t) {
    const auto point = [](const vec3f& v) { return kernel::Point_3(v[0], v[1], v[2]); };
    return {point(t[0]), point(t[1]), point(t[2])};
}

[[nodiscard]] CGAL::Bbox_3 in_kernel(const box& b) {
    return {b.min[0], b.min[1], b.min[2], b.max[0], b.max[1], b.max[2]};
}

/// The poses of both meshes, and A, whose floats the tree has.
struct tree_query {
    pose_pair poses;
    const mesh& a;
    const kernel_triangles& triangles;  // of the tree

    [[nodiscard]] std::uint32_t number_of(kernel_triangles::const_iterator t) const {
        return static_cast<std::uint32_t>(t - triangles.begin());
    }
};

/// A triangle of B to be tested against a tree of A.
struct query_triangle {
    query_triangle(const tree_query& of_query, const mesh& b, std::uint32_t t, const relative_pose& to_a)
        : query(of_query), triangle(b.given_triangle(t)), bounds(in_kernel(box_around(b.triangle(t), to_a))) {}

    const tree_query& query;
    triangle3d triangle;
    CGAL::Bbox_3 bounds;
};

/// CGAL's traits with other tests: nodes against the triangle's box, which is faster than against the triangle, and
/// triangles only if their boxes overlap, with zero-area ones as segments or points.
struct tree_traits : CGAL::AABB_traits<kernel, primitive> {
    struct Do_intersect {  // NOLINT(readability-identifier-naming)
        [[nodiscard]] bool operator()(const query_triangle& query, const CGAL::Bbox_3& bounds) const {
            return CGAL::do_overlap(query.bounds, bounds);
        }
        [[nodiscard]] bool operator()(const query_triangle& query, const primitive& leaf) const {
            const kernel::Triangle_3& s = *leaf.id();
            const auto& [poses, a, triangles] = query.query;
            return CGAL::do_overlap(query.bounds, s.bbox()) &&
                   exactly_intersect(poses, a.given_triangle(query.query.number_of(leaf.id())), query.triangle);
        }
    };
    [[nodiscard]] Do_intersect do_intersect_object() const { return {}; }
};

struct tree_model : engine_model {
    kernel_triangles triangles{};
    CGAL::AABB_tree<tree_traits> tree{};  // destroyed first: it points to the triangles

    [[nodiscard]] std::size_t bytes() const {
        using node = CGAL::AABB_node<tree_traits>;
        return bytes_of(triangles) + tree.size() * sizeof(primitive) + (tree.size() - 1) * sizeof(node);
    }
};

/// Queries a tree of A's triangles with the triangles of B, transformed into A's frame.
class cgal_tree final : public model_engine<tree_model> {
    void update_model(tree_model& changed) override {
        changed.triangles.clear();
        changed.triangles.reserve(changed.count);
        for (std::uint32_t t = 0; t < changed.count; ++t)
            changed.triangles.push_back(in_kernel(changed.source->triangle(t)));
        changed.tree.rebuild(changed.triangles.cbegin(), changed.triangles.cend());
    }

    /// Queries the tree of mesh A with each triangle of B, transformed into A's frame, until a triangle of A is hit.
    [[nodiscard]] std::optional<index_pair> any_pair(const model_query& q) override {
        const mesh& b = *q.b.source;
        const mesh& a = *q.a.source;
        const relative_pose to_a(q.pose_a, q.pose_b, q.b.bounds, a.frame, b.frame);
        const tree_query query{{q.pose_a, q.pose_b}, a, q.a.triangles};
        for (std::uint32_t t = 0; t < b.triangle_count(); ++t)
            if (const auto hit = q.a.tree.any_intersected_primitive(query_triangle(query, b, t, to_a)))
                return index_pair{query.number_of(*hit), t};
        return std::nullopt;
    }

    void append_pairs(const model_query& q, std::vector<index_pair>& pairs) override {
        const mesh& b = *q.b.source;
        const mesh& a = *q.a.source;
        const relative_pose to_a(q.pose_a, q.pose_b, q.b.bounds, a.frame, b.frame);
        const tree_query query{{q.pose_a, q.pose_b}, a, q.a.triangles};
        std::vector<kernel_triangles::const_iterator> hits;
        for (std::uint32_t t = 0; t < b.triangle_count(); ++t) {
            hits.clear();
            q.a.tree.all_intersected_primitives(query_triangle(query, b, t, to_a), std::back_inserter(hits));
            for (const auto hit : hits) pairs.push_back({query.number_of(hit), t});
        }
    }
};

}  // namespace

engine cgal_tree_engine() {
    return {.name = "cgal_tree",
            .summary = "CGAL's AABB tree of the first mesh, queried with each triangle of the second; its exact kernel",
            .meshes = make_stage<local_stage, cgal_tree>};
}

}  // namespace aabb
