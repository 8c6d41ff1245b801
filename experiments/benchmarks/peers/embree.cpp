// Embree's point query. It has points only, so that the distance of two meshes is the least of those of the vertices of
// either from the other: too great where two edges are nearest.
#include "../../../validation/engines/embree/device.hpp"

#include "peers.hpp"

import aabb.distance;

namespace aabblab {

namespace {

/// The distance of a point and a triangle (Ericson, "Real-time collision detection", 2005, section 5.1.5).
double distance_of(const aabb::vec3d& p, const aabb::triangle3d& t) {
    const aabb::vec3d ab = t[1] - t[0], ac = t[2] - t[0];
    const auto length_at = [&](double v, double w) {
        aabb::vec3d between{};
        for (int k = 0; k < 3; ++k) between[k] = t[0][k] + ab[k] * v + ac[k] * w - p[k];
        return std::sqrt(dot(between, between));
    };
    const aabb::vec3d ap = p - t[0], bp = p - t[1], cp = p - t[2];
    const double d1 = dot(ab, ap), d2 = dot(ac, ap), d3 = dot(ab, bp), d4 = dot(ac, bp), d5 = dot(ab, cp),
                 d6 = dot(ac, cp);
    if (d1 <= 0 && d2 <= 0) return length_at(0, 0);
    if (d3 >= 0 && d4 <= d3) return length_at(1, 0);
    if (d6 >= 0 && d5 <= d6) return length_at(0, 1);
    const double va = d3 * d6 - d5 * d4, vb = d5 * d2 - d1 * d6, vc = d1 * d4 - d3 * d2;
    if (vc <= 0 && d1 >= 0 && d3 <= 0) return length_at(d1 / (d1 - d3), 0);
    if (vb <= 0 && d2 >= 0 && d6 <= 0) return length_at(0, d2 / (d2 - d6));
    if (va <= 0 && d4 >= d3 && d5 >= d6) {
        const double w = (d4 - d3) / ((d4 - d3) + (d5 - d6));
        return length_at(1 - w, w);
    }
    return length_at(vb / (va + vb + vc), vc / (va + vb + vc));
}

float rounded_up(double x) {
    return std::nextafter(static_cast<float>(x), std::numeric_limits<float>::infinity());
}

/// A mesh with a scene of its triangles' boxes.
class mesh_scene {
public:
    explicit mesh_scene(const aabb::mesh& m) : mesh_(m) {
        scene_.begin(RTC_BUILD_QUALITY_MEDIUM, /*is_dynamic=*/false, [](const RTCBoundsFunctionArguments* request) {
            const auto& of = *static_cast<const aabb::mesh*>(request->geometryUserPtr);
            const aabb::triangle3d t = of.given_triangle(request->primID);
            std::array<float, 3> low{}, high{};
            for (std::size_t k = 0; k < 3; ++k) {
                const auto axis = static_cast<int>(k);
                const auto [least, most] = std::minmax({t[0][axis], t[1][axis], t[2][axis]});
                low[k] = -rounded_up(-least);
                high[k] = rounded_up(most);
            }
            *request->bounds_o = {low[0], low[1], low[2], 0, high[0], high[1], high[2], 0};
        });
        scene_.commit(const_cast<aabb::mesh*>(&m), m.triangles.size());
    }

    [[nodiscard]] const aabb::mesh& mesh() const { return mesh_; }

    /// Passes the triangles whose boxes are within a radius of a point to `visit`, which may reduce the radius.
    template <class Visit>
    void each_near(const aabb::vec3d& point, double radius, Visit& visit) const {
        RTCPointQuery query{};
        query.x = static_cast<float>(point[0]);
        query.y = static_cast<float>(point[1]);
        query.z = static_cast<float>(point[2]);
        // The point is rounded, too.
        query.radius =
            rounded_up(radius * (1 + 1e-6) + 1e-6 * (std::abs(point[0]) + std::abs(point[1]) + std::abs(point[2])));
        RTCPointQueryContext context;
        rtcInitPointQueryContext(&context);
        const auto call = [](RTCPointQueryFunctionArguments* found) {
            return (*static_cast<Visit*>(found->userPtr))(found->primID, found->query->radius);
        };
        rtcPointQuery(scene_.scene.get(), &query, &context, call, &visit);
    }

    /// The distance of the vertices of another mesh at a pose, if it is less than `most`, else `most`.
    [[nodiscard]] double distance_below(double most, const aabb::mesh& other, const aabb::pose& at) const {
        double least = most;
        for (std::size_t v = 0; v < other.vertices.size(); ++v) {
            const aabb::vec3d point = moved(at, other.given_vertex(v));
            auto visit = [&](std::uint32_t t, float& radius) {
                const double here = distance_of(point, mesh_.given_triangle(t));
                if (here >= least) return false;
                least = here;
                radius = std::min(radius, rounded_up(here * (1 + 1e-6)));
                return true;  // the radius has changed
            };
            each_near(point, least, visit);
        }
        return least;
    }

private:
    const aabb::mesh& mesh_;
    aabb::embree::user_scene scene_;
};

}  // namespace

distance_peer embree_distances() {
    const auto distance = [](const aabb::mesh& a, const aabb::mesh& b) -> distance_peer::measurement {
        return [of_a = std::make_shared<mesh_scene>(a), of_b = std::make_shared<mesh_scene>(b)](const aabb::pose& at) {
            const double least = of_a->distance_below(1e30, of_b->mesh(), at);
            return of_b->distance_below(least, of_a->mesh(), inverse_of(at));
        };
    };
    // Balls around the triangles of B leave pairs that our test decides.
    const auto within = [](const aabb::mesh& a, const aabb::mesh& b) -> distance_peer::search {
        return [of_a = std::make_shared<mesh_scene>(a), &b](const aabb::pose& at, double d,
                                                            std::vector<aabb::index_pair>& pairs) {
            const aabb::pose_pair poses{{}, at};
            for (std::uint32_t t = 0; t < b.triangle_count(); ++t) {
                const aabb::triangle3d given = b.given_triangle(t);
                const triangle_ball ball(
                    aabb::triangle3d{{moved(at, given[0]), moved(at, given[1]), moved(at, given[2])}});
                auto visit = [&](std::uint32_t s, float& /*radius*/) {
                    if (aabb::are_within(poses, of_a->mesh().given_triangle(s), given, d)) pairs.push_back({s, t});
                    return false;
                };
                of_a->each_near(ball.centre, ball.radius + d, visit);
            }
        };
    };
    return {.name = "embree", .distance = distance, .within = within};
}

}  // namespace aabblab
