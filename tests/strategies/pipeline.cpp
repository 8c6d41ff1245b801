#include <catch2/catch_test_macros.hpp>
#include <catch2/matchers/catch_matchers_exception.hpp>
#include <cstddef>
#include <vector>

import aabb;
import aabb.registry;

using namespace aabb;
using Catch::Matchers::Message;

namespace {

/// Two tetrahedra; the test says where they are.
class two_objects final : public mesh_scene {
public:
    two_objects() {
        meshes = {{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}}, {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}}}};
        mesh_of = {0, 0};
    }
    [[nodiscard]] std::size_t frames() const override { return 0; }
    bool next(std::vector<pose>&) override { return false; }
};

}  // namespace

TEST_CASE("without global search every two objects are candidates, however far away") {
    const two_objects scene;
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
    const two_objects scene;
    const auto global = compose_global_search(composition{}, instrumentation::none);
    const auto local = compose_local_detection(composition{}, instrumentation::none);
    pipeline both(scene, *global, *local);
    std::vector<pose> poses(2);
    both.update(poses);
    poses[0].translation[0] = 9;
    poses[1].translation[0] = 1e300;
    CHECK_THROWS_MATCHES(both.update(poses), input_error, Message("object 1 lies beyond the range of float"));
    CHECK_THROWS_MATCHES(both.search(), input_error,
                         Message("there is no frame to search: update was not called, or did not succeed"));
    const auto none = Message("there are no candidates to decide on: search was not called, or did not succeed");
    CHECK_THROWS_MATCHES(both.detect(), input_error, none);
    poses[1].translation[0] = 9;
    both.update(poses);
    CHECK_THROWS_MATCHES(both.detect(), input_error, none);
    both.search();
    both.detect();
    CHECK(both.candidates().size() == 1);
    CHECK_FALSE(both.contacts().empty());
}
