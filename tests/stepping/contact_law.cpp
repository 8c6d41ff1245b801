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

TEST_CASE("the torque of a shared volume is the negative gradient of its energy") {
    const aabb::mesh ball = aabblab::make_mesh("icosphere:triangles=80").mesh;
    const aabb::mesh floor = aabblab::make_mesh("square").mesh;
    const aabblab::contact_law law{contact_geometry::shared_volume, 3};
    std::mt19937 random(11);
    const auto between = [&](float low, float high) { return double{aabb::uniform(random, low, high)}; };
    for (int i = 0; i < 20; ++i) {
        const bool on_floor = i % 2 == 0;
        const aabblab::placed_mesh first{on_floor ? &floor : &ball,
                                         aabb::turned({1, 2, 3}, on_floor ? 0 : 0.7, {0, 0, 0})};
        const vec3d place{between(-0.5F, 0.5F), between(-0.5F, 0.5F), between(0.6F, 0.9F)};
        const std::array<double, 4> start =
            aabblab::quaternion_of(aabb::turned({2, -1, 1}, between(0, 3), {0, 0, 0}).rotation);
        // The second mesh at its place, turned about it by a vector.
        const auto second = [&](const vec3d& by) {
            const aabblab::rotor ball_like{{1, 1, 1}};
            std::array<double, 4> orientation = start;
            aabblab::turn_freely(ball_like, orientation, by.at, 1);
            return aabblab::placed_mesh{&ball, {aabblab::matrix_of(orientation), place}};
        };
        const aabblab::contact_force contact = force_between(law, first, second({0, 0, 0}));
        const vec3d torque = cross(contact.point - place, contact.force) + contact.moment;
        for (int k = 0; k < 3; ++k) {
            constexpr double h = 1e-5;
            vec3d by{0, 0, 0};
            by[k] = h;
            const double more = aabblab::overlap_volume(first, on_floor, second(by));
            by[k] = -h;
            const double less = aabblab::overlap_volume(first, on_floor, second(by));
            INFO("pair " << i << ", axis " << k);
            REQUIRE(std::abs(torque[k] + law.stiffness * (more - less) / (2 * h)) < 1e-6);
        }
    }
}

TEST_CASE("friction is linear below the slip speed, then Coulomb's, against the velocity of the point of contact") {
    const aabb::mesh floor = aabblab::make_mesh("square").mesh;
    const aabb::mesh mesh = aabblab::make_mesh("icosphere:triangles=80").mesh;  // stands for a ball
    const aabblab::contact_law law{.stiffness = 100, .friction = 0.5, .slip_speed = 0.1};
    const aabblab::placed_mesh plane{&floor, {}};
    aabblab::placed_mesh ball{&mesh, {.translation = {0.1, 0.2, 0.95}}, {}, 1};
    const double load = 100 * 0.05;
    const auto force_at = [&](const vec3d& velocity, const vec3d& angular_velocity) {
        ball.motion = {velocity, angular_velocity};
        return aabblab::force_of(law, std::array{aabb::contact{0, 1, 0, 0}}, plane, ball);
    };
    const auto is_near = [](const vec3d& p, const vec3d& q) {
        const vec3d difference = p - q;
        return dot(difference, difference) < 1e-24;
    };
    REQUIRE(is_near(force_at({0, 0, 0}, {0, 0, 0}).force, {0, 0, load}));
    REQUIRE(is_near(force_at({0.03, 0.04, 0}, {0, 0, 0}).force, {-load * 0.15, -load * 0.2, load}));
    REQUIRE(is_near(force_at({3, -4, 0}, {0, 0, 0}).force, {-load * 0.3, load * 0.4, load}));
    // A ball that rolls does not slip; one that only spins does.
    REQUIRE(is_near(force_at({2, 0, 0}, {0, 2, 0}).force, {0, 0, load}));
    REQUIRE(is_near(force_at({0, 0, 0}, {0, 2, 0}).force, {load * 0.5, 0, load}));
    REQUIRE(is_near(force_at({0, 0, 0}, {0, 0, 0}).point, {0.1, 0.2, -0.05}));
}

TEST_CASE("a dashpot pulls only if the law allows it") {
    const aabb::mesh plane = aabb::one_triangle({{{-4, -4, 0}, {4, -4, 0}, {0, 4, 0}}});
    const aabb::mesh tooth = aabb::one_triangle({{{0, 0, 0}, {1, 0, 2}, {-1, 0, 2}}});
    const aabblab::placed_mesh first{&plane, {}};
    const aabblab::placed_mesh second{&tooth, {.translation = {0, 0, -0.25}}, {.velocity = {0, 0, 3}}};
    const std::array contacts{aabb::contact{0, 1, 0, 0}};
    REQUIRE(aabblab::force_of({.stiffness = 8, .damping = 1}, contacts, first, second).force == vec3d{0, 0, -1});
    REQUIRE(aabblab::force_of({.stiffness = 8, .damping = 1, .may_pull = false}, contacts, first, second).force ==
            vec3d{0, 0, 0});
}

TEST_CASE("contacts keep linear and angular momentum of two bodies") {
    const aabb::mesh ball = aabblab::make_mesh("icosphere:triangles=80").mesh;
    for (const auto geometry :
         {contact_geometry::shared_volume, contact_geometry::each_vertex, contact_geometry::deepest_vertex}) {
        for (const double radius : {0.0, 1.0}) {
            const aabblab::matrix3 inertia = aabblab::inertia_of_box(2, {1, 2, 2.5});
            const aabblab::stepped_world world{
                .meshes = {ball},
                .bodies = {{.position = {0.1, 0.2, 0},
                            .velocity = {0, 0.3, 1},
                            .mass = 2,
                            .inertia = inertia,
                            .angular_velocity = {1, 2, 3},
                            .radius = radius},
                           {.position = {0.4, 0.3, 1.6},
                            .velocity = {1, 0, -1},
                            .mass = 3,
                            .rotation = aabb::turned({1, 1, 3}, 0.4, {0, 0, 0}).rotation,
                            .inertia = inertia,
                            .angular_velocity = {0, -2, 1},
                            .radius = radius}},
                .law = {geometry, /*stiffness=*/5, /*damping=*/2, 0, true, /*friction=*/0.4, /*slip_speed=*/0.01}};
            aabblab::dynamics forces(world);
            const aabblab::motion_state state = world.start();
            std::vector<aabb::pose> poses;
            world.place(state, poses);
            aabblab::motion_rates rates;
            rates.fit(state);
            forces.accelerate(state, contacts_of({&ball, poses[0]}, {&ball, poses[1]}), rates);
            vec3d force{0, 0, 0}, turning{0, 0, 0};
            double size = 0;
            for (std::size_t i = 0; i < 2; ++i) {
                const double mass = world.bodies[i].mass;
                const vec3d push{mass * rates.acceleration[3 * i], mass * rates.acceleration[3 * i + 1],
                                 mass * rates.acceleration[3 * i + 2]};
                const vec3d torque{rates.torque[3 * i], rates.torque[3 * i + 1], rates.torque[3 * i + 2]};
                force = force + push;
                turning = turning + torque + cross(world.bodies[i].position, push);
                size += std::sqrt(dot(torque, torque));
            }
            REQUIRE(size > 0.01);
            REQUIRE(dot(force, force) < 1e-24);
            REQUIRE(dot(turning, turning) < 1e-24);
        }
    }
}

TEST_CASE("worlds that cannot be are rejected in one sentence") {
    aabblab::stepped_world world{.meshes = {aabblab::make_mesh("square").mesh}, .bodies = {{.mass = 1}}, .law = {}};
    const auto check = [&](const char* message) { REQUIRE_THROWS_WITH(aabblab::dynamics(world), message); };
    world.law.friction = 0.5;
    check("friction needs a slip speed above 0");
    world.law.friction = 0;
    world.bodies[0].inertia = {1, 0, 0, 0, 1, 0, 0, 0, 3};
    check("moments of inertia must be positive, and none may exceed the sum of the others");
    world.bodies[0].inertia = {1, 1, 0, 0, 1, 0, 0, 0, 1};
    check("a tensor of inertia must be finite and symmetric");
    world.bodies[0].inertia = aabblab::inertia_of_ball(1, 1);
    world.bodies[0].rotation = {2, 0, 0, 0, 1, 0, 0, 0, 1};
    REQUIRE_THROWS_WITH(world.start(), "a body that turns needs a rotation, not another matrix");
    const aabblab::placed_mesh floor{world.meshes.data(), {}};
    aabblab::placed_mesh ball = floor;
    ball.radius = 1;
    REQUIRE_THROWS_WITH(aabblab::force_of({}, {}, ball, floor),
                        "a ball must have a greater index than every other body that it touches");
}
