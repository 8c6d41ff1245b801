#include "../validation/support.hpp"

import aabb.validation;
import aabblab.scenes;
import aabblab.stepping;

using aabb::vec3d;
using aabblab::contact_geometry;

namespace {

std::vector<aabb::contact> contacts_of(const aabblab::placed_mesh& a, const aabblab::placed_mesh& b) {
    std::vector<aabb::contact> contacts;
    for (const auto [s, t] : aabb::pairs_of(*aabb::make_mesh_engine("cgal"), *a.mesh, a.pose, *b.mesh, b.pose))
        contacts.push_back({0, 1, s, t});
    return contacts;
}

/// @param approach velocity of the second body
aabblab::contact_force force_between(const aabblab::contact_law& law, const aabblab::placed_mesh& a,
                                     aabblab::placed_mesh b, const vec3d& approach = {0, 0, 0}) {
    b.motion.velocity = approach;
    return aabblab::force_of(law, contacts_of(a, b), a, b);
}

}  // namespace

TEST_CASE("the force of a shared volume is its gradient for bodies and for a floor") {
    const aabb::mesh ball = aabblab::make_mesh("icosphere:triangles=80").mesh;
    const aabb::mesh floor = aabblab::make_mesh("square").mesh;
    const aabblab::contact_law law{contact_geometry::shared_volume, 3, 0, 0};
    std::mt19937 random(7);
    for (int i = 0; i < 20; ++i) {
        const bool on_floor = i % 2 == 0;
        const aabblab::placed_mesh first{on_floor ? &floor : &ball,
                                         aabb::turned({1, 2, 3}, on_floor ? 0 : 0.7, {0, 0, 0})};
        const auto at = [](float low, float high, std::mt19937& r) { return double{aabb::uniform(r, low, high)}; };
        const vec3d offset{at(-0.5F, 0.5F, random), at(-0.5F, 0.5F, random), at(0.6F, 0.9F, random)};
        const double angle = at(0, 3, random);
        const auto second = [&](const vec3d& by) {
            return aabblab::placed_mesh{&ball, aabb::turned({2, -1, 1}, angle, offset + by)};
        };
        const vec3d force = force_between(law, first, second({0, 0, 0})).force;
        REQUIRE(aabblab::overlap_volume(first, on_floor, second({0, 0, 0})) > 1e-4);
        for (int k = 0; k < 3; ++k) {
            constexpr double h = 1e-5;
            vec3d by{0, 0, 0};
            by[k] = h;
            const double more = aabblab::overlap_volume(first, on_floor, second(by));
            by[k] = -h;
            const double less = aabblab::overlap_volume(first, on_floor, second(by));
            INFO("pair " << i << ", axis " << k);
            REQUIRE(std::abs(force[k] + law.stiffness * (more - less) / (2 * h)) < 1e-6);
        }
        // A dashpot resists approach.
        const aabblab::contact_law damped{contact_geometry::shared_volume, 3, 1, 0};
        REQUIRE(force_between(damped, first, second({0, 0, 0}), {0, 0, -1}).force[2] > force[2]);
    }
}

TEST_CASE("a missed pair changes the force of a shared volume") {
    const aabb::mesh ball = aabblab::make_mesh("icosphere:triangles=80").mesh;
    const aabblab::contact_law law{contact_geometry::shared_volume, 1, 0, 0};
    const aabblab::placed_mesh a{&ball, {}};
    const aabblab::placed_mesh b{&ball, aabb::turned({1, 1, 3}, 0.4, {0.3, 0.2, 1.6})};
    std::vector<aabb::contact> contacts = contacts_of(a, b);
    REQUIRE(contacts.size() > 10);
    const vec3d whole = aabblab::force_of(law, contacts, a, b).force;
    contacts.erase(contacts.begin() + 3);
    const vec3d difference = aabblab::force_of(law, contacts, a, b).force - whole;
    REQUIRE(std::sqrt(dot(difference, difference)) > 1e-3 * std::sqrt(dot(whole, whole)));
}

TEST_CASE("springs push along the plane's normal, once per vertex, by its depth") {
    const aabb::mesh plane = aabb::one_triangle({{{-4, -4, 0}, {4, -4, 0}, {0, 4, 0}}});
    const aabb::mesh tooth = aabb::one_triangle({{{0, 0, 0}, {1, 0, 2}, {-1, 0, 2}}});
    const aabblab::placed_mesh first{&plane, {}};
    const aabblab::placed_mesh second{
        &tooth, {{1, 0, 0, 0, 1, 0, 0, 0, 1}, {0.1, 0.2, -0.25}}, {.velocity = {5, 0, -1}}};
    // Reported twice, as a vertex on an edge is.
    const std::vector<aabb::contact> twice = {{0, 1, 0, 0}, {0, 1, 0, 0}};
    for (const auto geometry : {contact_geometry::deepest_vertex, contact_geometry::each_vertex}) {
        const aabblab::contact_force result = aabblab::force_of({geometry, 8, 2, 0}, twice, first, second);
        REQUIRE(result.force == vec3d{0, 0, 8 * 0.25 + 2});
        REQUIRE(result.energy == 0.25);
    }
    // Springs of length 0.5 reach above the plane.
    const aabblab::placed_mesh above{&tooth, {{1, 0, 0, 0, 1, 0, 0, 0, 1}, {0, 0, 0.25}}};
    const aabblab::contact_law long_springs{contact_geometry::each_vertex, 8, 0, 0.5};
    REQUIRE(aabblab::force_of(long_springs, twice, first, above).force == vec3d{0, 0, 2});
    REQUIRE(aabblab::force_of({contact_geometry::each_vertex, 8, 0, 0.2}, twice, first, above).force == vec3d{0, 0, 0});
}
