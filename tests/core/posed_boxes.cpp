#include "../meshes.hpp"

using namespace aabb;

TEST_CASE("world boxes follow poses and deforming meshes") {
    manual_scene scene({tetrahedron(1), tetrahedron(1)}, {1, 0, 1});
    scene.soft = 1;
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

TEST_CASE("too few poses are rejected, and invalid or distant ones by the object's id") {
    const manual_scene scene({tetrahedron(1)}, {0, 0, 0});
    posed_boxes world(scene);
    CHECK_REFUSED(world.update(std::vector<pose>(2)), "the scene has 3 objects, but the frame has 2 poses");
    std::vector<pose> poses(3);
    poses[1].translation[0] = 1e300;
    CHECK_REFUSED(world.update(poses), "object 1 lies beyond the range of float");
    CHECK_NOTHROW(require_poses(scene, poses));
    poses[2].rotation[0] = 0;
    CHECK_REFUSED(require_poses(scene, poses), "object 2: the pose is singular: the determinant of its matrix is 0");
}
