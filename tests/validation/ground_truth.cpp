#include "support.hpp"

import aabb.validation;

using namespace aabb;

namespace {

const std::vector<pose> poses = {{}, turned({1, 2, 3}, 0.7, {0.9, 0.3, -0.2}), turned({0, 1, 0}, 1, {9, 0, 0})};

/// From every two objects' meshes.
std::vector<contact> contacts_by_brute_force(const told_scene& scene) {
    std::vector<contact> all;
    for (std::uint32_t a = 0; a < poses.size(); ++a)
        for (std::uint32_t b = a + 1; b < poses.size(); ++b)
            for (const auto [s, t] : pairs_of(*make_mesh_engine("brute_force"), scene.meshes[scene.mesh_of[a]],
                                              poses[a], scene.meshes[scene.mesh_of[b]], poses[b]))
                all.push_back({a, b, s, t});
    return all;
}

}  // namespace

TEST_CASE("the exact answer says what gives it") {
    REQUIRE(ground_truth(20000, nullptr).name() == "brute_force");
    REQUIRE(ground_truth(20001, nullptr).name() == "cgal");
    const told_scene scene({sphere(3)}, {0, 0, 0});
    REQUIRE(ground_truth(3, &scene).name() == "brute_force for boxes, cgal on all pairs of objects for triangles");
}

TEST_CASE("the exact pairs are those of the objects that are there") {
    for (const std::size_t objects : {3U, 20001U}) {
        ground_truth exact(objects, nullptr);
        std::vector<box> boxes(objects, box{{0, 0, 0}, {1, 1, 1}});
        const std::vector<std::uint32_t> first = {2, 0};
        exact.compute({boxes, {}, first, {}});
        REQUIRE(exact.pairs() == std::vector<index_pair>{{0, 2}});
        const std::vector<std::uint32_t> one = {1};
        exact.compute({boxes, {}, one, {}});
        REQUIRE(exact.pairs() == std::vector<index_pair>{{0, 1}, {0, 2}, {1, 2}});
        const std::vector<std::uint32_t> none = {0};
        exact.compute({boxes, {}, {}, none});
        REQUIRE(exact.pairs() == std::vector<index_pair>{{1, 2}});
        REQUIRE(exact.contacts().empty());
    }
}

TEST_CASE("the exact contacts follow meshes that deform, and do not depend on the boxes of global search") {
    told_scene scene({sphere(6), sphere(5)}, {0, 1, 0});
    scene.soft = 0;
    ground_truth exact(poses.size(), &scene);
    std::vector<box> apart;
    for (std::size_t i = 0; i < poses.size(); ++i) {
        const auto x = static_cast<float>(2 * i);
        apart.push_back({{x, 0, 0}, {x + 1, 1, 1}});
    }
    exact.compute({apart, poses, {}, {}});
    REQUIRE(exact.pairs().empty());
    REQUIRE(exact.contacts().size() > 20);
    REQUIRE(exact.contacts() == contacts_by_brute_force(scene));
    const std::vector<contact> before = exact.contacts();
    // Large enough to reach the third object.
    for (vec3f& v : scene.meshes[0].vertices)
        for (int k = 0; k < 3; ++k) v[k] *= 5;
    exact.compute({apart, poses, {}, {}});
    REQUIRE(exact.contacts() != before);
    REQUIRE(exact.contacts().back().b == 2);
    REQUIRE(exact.contacts() == contacts_by_brute_force(scene));
}
