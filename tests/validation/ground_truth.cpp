#include "support.hpp"

import aabb.validation;

using namespace aabb;

namespace {

const std::vector<pose> poses = {{}, turned({1, 2, 3}, 0.7, {0.9, 0.3, -0.2}), turned({0, 1, 0}, 1, {9, 0, 0})};

/// From the meshes of every two objects.
std::vector<contact> contacts_by_brute_force(const manual_scene& scene) {
    std::vector<contact> contacts;
    for (std::uint32_t a = 0; a < poses.size(); ++a)
        for (std::uint32_t b = a + 1; b < poses.size(); ++b)
            for (const auto [s, t] : pairs_of(*make_mesh_engine("brute_force"), scene.meshes[scene.mesh_of[a]],
                                              poses[a], scene.meshes[scene.mesh_of[b]], poses[b]))
                contacts.push_back({a, b, s, t});
    return contacts;
}

}  // namespace

TEST_CASE("the ground truth names its method") {
    REQUIRE(ground_truth(20000, nullptr).name() == "brute_force");
    REQUIRE(ground_truth(20001, nullptr).name() == "cgal");
    const manual_scene scene({sphere(3)}, {0, 0, 0});
    REQUIRE(ground_truth(3, &scene).name() == "brute_force for boxes, cgal on all pairs of objects for triangles");
}

TEST_CASE("the exact pairs are those of the present objects") {
    for (const std::size_t objects : {3U, 20001U}) {
        ground_truth exact(objects, nullptr);
        std::vector<box> boxes(objects, box{{0, 0, 0}, {1, 1, 1}});
        const std::vector<std::uint32_t> first = {2, 0};
        exact.compute({boxes, {}, first, {}});
        REQUIRE(exact.pairs() == std::vector<index_pair>{{0, 2}});
        const std::vector<std::uint32_t> arrivals = {1};
        exact.compute({boxes, {}, arrivals, {}});
        REQUIRE(exact.pairs() == std::vector<index_pair>{{0, 1}, {0, 2}, {1, 2}});
        const std::vector<std::uint32_t> departures = {0};
        exact.compute({boxes, {}, {}, departures});
        REQUIRE(exact.pairs() == std::vector<index_pair>{{1, 2}});
        REQUIRE(exact.contacts().empty());
    }
}

TEST_CASE("the exact contacts follow deforming meshes, and do not depend on the boxes of the broad phase") {
    manual_scene scene({sphere(6), sphere(5)}, {0, 1, 0});
    scene.soft = 0;
    ground_truth exact(poses.size(), &scene);
    std::vector<box> separated;
    for (std::size_t i = 0; i < poses.size(); ++i) {
        const auto x = static_cast<float>(2 * i);
        separated.push_back({{x, 0, 0}, {x + 1, 1, 1}});
    }
    exact.compute({separated, poses, {}, {}});
    REQUIRE(exact.pairs().empty());
    REQUIRE(exact.contacts().size() > 20);
    REQUIRE(exact.contacts() == contacts_by_brute_force(scene));
    const std::vector<contact> before = exact.contacts();
    // Large enough to reach the third object.
    for (vec3f& v : scene.meshes[0].vertices)
        for (int k = 0; k < 3; ++k) v[k] *= 5;
    exact.compute({separated, poses, {}, {}});
    REQUIRE(exact.contacts() != before);
    REQUIRE(exact.contacts().back().b == 2);
    REQUIRE(exact.contacts() == contacts_by_brute_force(scene));
}
