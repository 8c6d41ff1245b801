#include "../meshes.hpp"

import aabb.registry;

using namespace aabb;

namespace {

const manual_scene scene({tetrahedron(1)}, {0, 0});

}  // namespace

TEST_CASE("without global search all pairs of objects are candidates, at any distance") {
    const auto local = compose_local_detection(composition{}, instrumentation::none);
    pipeline local_only(scene, *local);
    std::vector<pose> poses(2);
    for (pose& p : poses) p.translation[0] = 1e300;
    local_only.update(poses);
    local_only.search();
    local_only.detect();
    CHECK(local_only.boxes().empty());
    CHECK(local_only.candidates().size() == 1);
    CHECK(local_only.contacts().size() == 16);
    poses[1].rotation[0] = 0;
    CHECK_THROWS_AS(local_only.update(poses), input_error);
    CHECK_THROWS_AS(local_only.search(), input_error);
    CHECK_THROWS_AS(local_only.update(std::vector<pose>(1)), input_error);
}

TEST_CASE("a pipeline does not search a rejected frame, but the next one") {
    const auto global = compose_global_search(composition{}, instrumentation::none);
    const auto local = compose_local_detection(composition{}, instrumentation::none);
    pipeline stages(scene, *global, *local);
    std::vector<pose> poses(2);
    stages.update(poses);
    poses[0].translation[0] = 9;
    poses[1].translation[0] = 1e300;
    const std::string no_candidates = "there are no candidates to test: search was not called, or did not succeed";
    CHECK_REFUSED(stages.update(poses), "object 1 lies beyond the range of float");
    CHECK_REFUSED(stages.search(), "there is no frame to search: update was not called, or did not succeed");
    CHECK_REFUSED(stages.detect(), no_candidates);
    poses[1].translation[0] = 9;
    stages.update(poses);
    CHECK_REFUSED(stages.detect(), no_candidates);
    stages.search();
    stages.detect();
    CHECK(stages.candidates().size() == 1);
    CHECK_FALSE(stages.contacts().empty());
}
