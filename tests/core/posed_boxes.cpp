#include <catch2/catch_test_macros.hpp>
#include <catch2/matchers/catch_matchers_exception.hpp>
#include <cstddef>
#include <cstdint>
#include <vector>

import aabb;

using namespace aabb;
using Catch::Matchers::Message;

namespace {

/// Three objects of two meshes, of which the second deforms.
class three_objects final : public mesh_scene {
public:
    three_objects() {
        const mesh one{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}}, {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}}};
        meshes = {one, one};
        mesh_of = {1, 0, 1};
    }
    [[nodiscard]] std::size_t frames() const override { return 0; }
    bool next(std::vector<pose>&) override { return false; }
    [[nodiscard]] bool deforms(std::uint32_t m) const override { return m == 1; }
};

}  // namespace

TEST_CASE("world boxes follow poses, and meshes that deform") {
    three_objects scene;
    posed_boxes world(scene);
    std::vector<pose> poses(3);
    poses[2].translation[0] = 5;
    world.update(poses);
    REQUIRE(world.boxes().size() == 3);
    for (std::size_t object = 0; object < 3; ++object)
        CHECK(world.boxes()[object] == world_bounds({{0, 0, 0}, {1, 1, 1}}, poses[object]));
    for (mesh& m : scene.meshes) m.vertices[1][0] = 3;
    world.update(poses);
    CHECK(world.boxes()[0] == world_bounds({{0, 0, 0}, {3, 1, 1}}, poses[0]));
    CHECK(world.boxes()[1] == world_bounds({{0, 0, 0}, {1, 1, 1}}, poses[1]));
    CHECK(world.boxes()[2] == world_bounds({{0, 0, 0}, {3, 1, 1}}, poses[2]));
    CHECK(world.bytes() == 5 * sizeof(box));
}

TEST_CASE("poses that are none, too few or too far are refused by the object's number") {
    const three_objects scene;
    posed_boxes world(scene);
    CHECK_THROWS_MATCHES(world.update(std::vector<pose>(2)), input_error,
                         Message("the scene has 3 objects, but the frame has 2 poses"));
    std::vector<pose> poses(3);
    poses[1].translation[0] = 1e300;
    CHECK_THROWS_MATCHES(world.update(poses), input_error, Message("object 1 lies beyond the range of float"));
    CHECK_NOTHROW(require_poses(scene, poses));
    poses[2].rotation[0] = -1;
    CHECK_THROWS_MATCHES(require_poses(scene, poses), input_error,
                         Message("object 2: the pose is not rigid: its rotation is a reflection (determinant -1)"));
}
