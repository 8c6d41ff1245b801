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

/// A triangle to be held against those in a tree.
struct asked_triangle {
    explicit asked_triangle(const triangle3f& t) : triangle(in_kernel(t)), bounds(triangle.bbox()) {}

    kernel::Triangle_3 triangle;
    CGAL::Bbox_3 bounds;
};

/// CGAL's but for what is tested: boxes against the triangle's box, which is faster than against the triangle; and
/// triangles only where their boxes overlap, those without area as the segments or points they are.
struct tree_traits : CGAL::AABB_traits<kernel, primitive> {
    struct Do_intersect {  // NOLINT(readability-identifier-naming)
        [[nodiscard]] bool operator()(const asked_triangle& asked, const CGAL::Bbox_3& bounds) const {
            return CGAL::do_overlap(asked.bounds, bounds);
        }
        [[nodiscard]] bool operator()(const asked_triangle& asked, const primitive& one) const {
            const kernel::Triangle_3& s = *one.id();
            const kernel::Triangle_3& t = asked.triangle;
            return CGAL::do_overlap(asked.bounds, s.bbox()) &&
                   hulls_intersect<kernel>({s[0], s[1], s[2]}, {t[0], t[1], t[2]});
        }
    };
    [[nodiscard]] Do_intersect do_intersect_object() const { return {}; }
};

struct tree_model : engine_model {
    kernel_triangles triangles{};
    CGAL::AABB_tree<tree_traits> tree{};  // goes first: it points to the triangles

    [[nodiscard]] std::uint32_t number_of(kernel_triangles::const_iterator t) const {
        return static_cast<std::uint32_t>(t - triangles.begin());
    }
    [[nodiscard]] std::size_t bytes() const {
        using node = CGAL::AABB_node<tree_traits>;
        return bytes_of(triangles) + tree.size() * sizeof(primitive) + (tree.size() - 1) * sizeof(node);
    }
};

/// A tree of A's triangles is asked for each of B's. It knows no poses: B's vertices are moved.
class cgal_tree final : public model_engine<tree_model> {
    void follow(tree_model& changed) override {
        changed.triangles.clear();
        changed.triangles.reserve(changed.count);
        for (std::uint32_t t = 0; t < changed.count; ++t)
            changed.triangles.push_back(in_kernel(changed.source->triangle(t)));
        changed.tree.rebuild(changed.triangles.cbegin(), changed.triangles.cend());
    }

    [[nodiscard]] std::optional<index_pair> any_pair(const asked& q) override {
        const mesh& b = *q.b.source;
        const relative_pose to_a(q.pose_a, q.pose_b, q.b.bounds);
        for (std::uint32_t t = 0; t < b.triangle_count(); ++t)
            if (const auto hit = q.a.tree.any_intersected_primitive(asked_triangle(to_a(b.triangle(t)))))
                return index_pair{q.a.number_of(*hit), t};
        return std::nullopt;
    }

    void append_pairs(const asked& q, std::vector<index_pair>& pairs) override {
        const mesh& b = *q.b.source;
        // Each vertex once, since triangles share them.
        const std::vector<vec3f> moved = moved_vertices(q.pose_a, q.pose_b, b, q.b.bounds);
        std::vector<kernel_triangles::const_iterator> hits;
        for (std::uint32_t t = 0; t < b.triangle_count(); ++t) {
            const auto& [i, j, k] = b.triangles[t];
            hits.clear();
            q.a.tree.all_intersected_primitives(asked_triangle({moved[i], moved[j], moved[k]}),
                                                std::back_inserter(hits));
            for (const auto hit : hits) pairs.push_back({q.a.number_of(hit), t});
        }
    }
};

}  // namespace

engine cgal_tree_engine() {
    return {.name = "cgal_tree",
            .summary = "CGAL's AABB tree of the first mesh, asked for each triangle of the second; its exact kernel",
            .meshes = made<local_stage, cgal_tree>};
}

}  // namespace aabb
