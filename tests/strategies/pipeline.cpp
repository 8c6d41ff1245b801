#include "../meshes.hpp"

import aabb.registry;

using namespace aabb;

namespace {

const told_scene scene({tetrahedron(1)}, {0, 0});

}  // namespace

TEST_CASE("without global search every two objects are candidates, however far away") {
    const auto local = compose_local_detection(composition{}, instrumentation::none);
    pipeline alone(scene, *local);
    std::vector<pose> poses(2);
    for (pose& p : poses) p.translation[0] = 1e300;
    alone.update(poses);
    alone.search();
    alone.detect();
    CHECK(alone.boxes().empty());
    CHECK(alone.candidates().size() == 1);
    CHECK(alone.contacts().size() == 16);
    poses[1].rotation[0] = 2;
    CHECK_THROWS_AS(alone.update(poses), input_error);
    CHECK_THROWS_AS(alone.search(), input_error);
    CHECK_THROWS_AS(alone.update(std::vector<pose>(1)), input_error);
}

TEST_CASE("a frame that a pipeline refused is not searched, and the next one is") {
    const auto global = compose_global_search(composition{}, instrumentation::none);
    const auto local = compose_local_detection(composition{}, instrumentation::none);
    pipeline both(scene, *global, *local);
    std::vector<pose> poses(2);
    both.update(poses);
    poses[0].translation[0] = 9;
    poses[1].translation[0] = 1e300;
    const std::string no_candidates = "there are no candidates to test: search was not called, or did not succeed";
    CHECK_REFUSED(both.update(poses), "object 1 lies beyond the range of float");
    CHECK_REFUSED(both.search(), "there is no frame to search: update was not called, or did not succeed");
    CHECK_REFUSED(both.detect(), no_candidates);
    poses[1].translation[0] = 9;
    both.update(poses);
    CHECK_REFUSED(both.detect(), no_candidates);
    both.search();
    both.detect();
    CHECK(both.candidates().size() == 1);
    CHECK_FALSE(both.contacts().empty());
}
