#include "../random_poses.hpp"

import aabblab.rotated_boxes;

using namespace aabb;

namespace {

vec3d column(const pose& p, std::size_t j) {
    return {p.rotation[j], p.rotation[3 + j], p.rotation[6 + j]};
}

/// A box around the point, which may lie on a face, an edge or a corner.
box around(const vec3f& at) {
    box b{at, at};
    for (int k = 0; k < 3; ++k) {
        b.min[k] -= static_cast<float>(*rc::gen::element(0.0, 1.0) * uniform(0, 2));
        b.max[k] += static_cast<float>(*rc::gen::element(0.0, 1.0) * uniform(0, 2));
    }
    return b;
}

struct test_result {
    bool faces;
    bool edges;
};

test_result tested(const pose& pose_a, const box& a, const pose& pose_b, const box& b) {
    const aabblab::rotated_boxes rotated(pose_a, pose_b, b);
    const aabblab::box_pair pair = rotated.pair_of(a, b);
    return {rotated.meet_by_faces(pair), rotated.meet_by_edges(pair)};
}

}  // namespace

TEST_CASE("boxes with a common vertex have no separating axis, even if they only touch there") {
    REQUIRE(rc::check([] {
        const pose pose_a = any_turned(any_vector(3));
        const pose pose_b = any_turned(any_vector(3));
        vec3f vertex{};
        for (float& c : vertex.at) c = static_cast<float>(uniform(-5, 5));
        const box b = around(vertex);
        const test_result result = tested(pose_a, around(relative_pose(pose_a, pose_b, b)(vertex)), pose_b, b);
        RC_ASSERT(result.faces);
        RC_ASSERT(result.edges);
    }));
}

TEST_CASE("boxes with a gap along an axis are separated by it") {
    REQUIRE(rc::check([] {
        const pose pose_a = any_turned(any_vector(3));
        pose pose_b = any_turned(any_vector(3));
        const auto axis = *rc::gen::inRange<std::size_t>(0, 15);
        vec3d along = column(axis < 3 ? pose_a : pose_b, axis % 3);
        if (axis >= 6) along = cross(column(pose_a, axis % 3), column(pose_b, axis / 3 - 2));
        const double length = std::sqrt(dot(along, along));
        RC_PRE(length > 0.1);
        for (double& c : along.at) c /= length;
        // Boxes are centred at their frames' origins, which are as far apart as both boxes extend.
        box a{};
        box b{};
        double distance = 0.01;
        for (int k = 0; k < 3; ++k) {
            a.max[k] = static_cast<float>(uniform(0, 2));
            b.max[k] = static_cast<float>(uniform(0, 2));
            a.min[k] = -a.max[k];
            b.min[k] = -b.max[k];
            const auto j = static_cast<std::size_t>(k);
            distance += std::abs(dot(along, column(pose_a, j))) * double{a.max[k]} +
                        std::abs(dot(along, column(pose_b, j))) * double{b.max[k]};
        }
        for (int k = 0; k < 3; ++k) pose_b.translation[k] = pose_a.translation[k] + along[k] * distance;
        const test_result result = tested(pose_a, a, pose_b, b);
        RC_ASSERT(!(axis < 6 ? result.faces : result.edges));
    }));
}

TEST_CASE("cubes that face each other with crossing edges are separated by the edges only") {
    // Half a side is 1, so each edge lies √2 from its cube's centre.
    const box cube{{-1, -1, -1}, {1, 1, 1}};
    const pose edge_along_z = turned_by({std::cos(std::numbers::pi / 8), 0, 0, std::sin(std::numbers::pi / 8)}, {});
    for (const double gap : {-0.01, 0.01}) {
        const pose edge_along_y = turned_by({std::cos(std::numbers::pi / 8), 0, std::sin(std::numbers::pi / 8), 0},
                                            {2 * std::sqrt(2) + gap, 0, 0});
        const test_result result = tested(edge_along_z, cube, edge_along_y, cube);
        CHECK(result.faces);
        CHECK(result.edges == (gap < 0));
    }
}
