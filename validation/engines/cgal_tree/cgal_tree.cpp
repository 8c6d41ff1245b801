module;
#include <CGAL/AABB_traits.h>
#include <CGAL/AABB_tree.h>
#include <CGAL/AABB_triangle_primitive.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>

#include <cstddef>
#include <cstdint>
#include <iterator>
#include <memory>
#include <optional>
#include <vector>

#include "../exact_decision.hpp"

module aabb.engines;

import aabb.base;
import aabb.geometry;
import aabb.local_detection;
import aabb.pipeline;
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

/// A tree of A's triangles is asked for each of B's. It knows no poses: B's vertices are moved.
class cgal_tree final : public mesh_engine {
public:
    std::uint32_t add_model(const mesh& m) override {
        models_.push_back(model_of(m));
        return static_cast<std::uint32_t>(models_.size() - 1);
    }

    void refit(std::uint32_t number) override {
        model& changed = models_[number];
        changed.fit.renew([&] {
            require_still_valid(*changed.source, changed.triangles.size());
            changed = model_of(*changed.source);
        });
    }

    [[nodiscard]] std::optional<index_pair> first_pair(std::uint32_t model_a, const pose& pose_a, std::uint32_t model_b,
                                                       const pose& pose_b) override {
        require_fit(model_a, model_b);
        const model& a = models_[model_a];
        const mesh& b = *models_[model_b].source;
        const relative_pose to_a(pose_a, pose_b, models_[model_b].bounds);
        for (std::uint32_t t = 0; t < b.triangle_count(); ++t)
            if (const auto hit = a.tree.any_intersected_primitive(asked_triangle(to_a(b.triangle(t)))))
                return index_pair{a.number_of(*hit), t};
        return std::nullopt;
    }

    [[nodiscard]] std::vector<part_bytes> bytes() const override {
        using node = CGAL::AABB_node<tree_traits>;
        std::size_t all = 0;
        for (const model& m : models_)
            all += bytes_of(m.triangles) + m.tree.size() * sizeof(primitive) + (m.tree.size() - 1) * sizeof(node);
        return {{"engine", all}};
    }

private:
    struct model {
        const mesh* source;
        box bounds;
        kernel_triangles triangles;
        CGAL::AABB_tree<tree_traits> tree;  // goes first: it points to the triangles
        mesh_fit fit;

        [[nodiscard]] std::uint32_t number_of(kernel_triangles::const_iterator t) const {
            return static_cast<std::uint32_t>(t - triangles.begin());
        }
    };

    [[nodiscard]] static model model_of(const mesh& m) {
        require_ieee_arithmetic();
        require_valid(m);
        model made{&m, bounds_of(m), {}, {}, {}};
        made.triangles.reserve(m.triangles.size());
        for (std::uint32_t t = 0; t < m.triangle_count(); ++t) made.triangles.push_back(in_kernel(m.triangle(t)));
        made.tree.rebuild(made.triangles.cbegin(), made.triangles.cend());
        return made;
    }

    void find(std::uint32_t model_a, const pose& pose_a, std::uint32_t model_b, const pose& pose_b,
              std::vector<index_pair>& pairs) override {
        require_fit(model_a, model_b);
        const model& a = models_[model_a];
        const mesh& b = *models_[model_b].source;
        // Each vertex once, since triangles share them.
        const std::vector<vec3f> moved = moved_vertices(pose_a, pose_b, b, models_[model_b].bounds);
        std::vector<kernel_triangles::const_iterator> hits;
        for (std::uint32_t t = 0; t < b.triangle_count(); ++t) {
            const auto& [i, j, k] = b.triangles[t];
            hits.clear();
            a.tree.all_intersected_primitives(asked_triangle({moved[i], moved[j], moved[k]}), std::back_inserter(hits));
            for (const auto hit : hits) pairs.push_back({a.number_of(hit), t});
        }
    }

    void require_fit(std::uint32_t model_a, std::uint32_t model_b) const {
        require_ieee_arithmetic();
        models_[model_a].fit.require();
        models_[model_b].fit.require();
    }

    std::vector<model> models_;
};

}  // namespace

engine cgal_tree_engine() {
    return {.name = "cgal_tree",
            .summary = "CGAL's AABB tree of the first mesh, asked for each triangle of the second; its exact kernel",
            .exact = true,
            .meshes = []() -> std::unique_ptr<local_stage> { return std::make_unique<cgal_tree>(); }};
}

}  // namespace aabb
