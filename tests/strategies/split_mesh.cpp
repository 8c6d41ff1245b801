#include <rapidcheck.h>

#include "../compositions.hpp"
#include "../meshes.hpp"
#include "../random_poses.hpp"

using namespace aabb;

namespace {

/// A picture frame of 8 n triangles in the xy plane: most of its box is empty.
mesh picture_frame(std::uint32_t n, float side) {
    mesh m;
    const auto quad = [&](float x, float y, float width, float height) {
        const auto v = static_cast<std::uint32_t>(m.vertices.size());
        for (const float dy : {0.0F, height})
            for (const float dx : {0.0F, width}) m.vertices.push_back({x + dx, y + dy, 0});
        m.triangles.push_back({v, v + 1, v + 3});
        m.triangles.push_back({v, v + 3, v + 2});
    };
    const float width = side / static_cast<float>(n);
    for (std::uint32_t i = 0; i < n; ++i) {
        const float at = width * static_cast<float>(i);
        quad(at, 0, width, width);
        quad(at, side - width, width, width);
        quad(0, at, width, width);
        quad(side - width, at, width, width);
    }
    return m;
}

/// A pipeline of the stages of a composition.
struct composed_pipeline {
    composed_pipeline(const mesh_scene& scene, const composition& c)
        : global(compose_global_search(c, instrumentation::counters)),
          local(compose_local_detection(c, instrumentation::counters)),
          stages(scene, *global, *local) {}

    std::vector<contact> contacts(const std::vector<pose>& poses) {
        stages.update(poses);
        stages.search();
        stages.detect();
        std::vector<contact> sorted_contacts = sorted(stages.contacts());
        CHECK(stages.count_contacts() == sorted_contacts.size());
        const std::optional<contact> first = stages.first_contact();
        CHECK(first.has_value() == !sorted_contacts.empty());
        if (first) CHECK(std::ranges::binary_search(sorted_contacts, *first));
        return sorted_contacts;
    }

    std::unique_ptr<global_stage> global;
    std::unique_ptr<local_stage> local;
    pipeline stages;
};

composition splitting(const std::string& size, const strategy_choice& tree = {"canonical", {}}) {
    composition c;
    c[strategy_kind::prepare] = {"split_mesh", {{"size", size}}};
    c[strategy_kind::tree] = tree;
    return c;
}

std::vector<pose> scattered(std::size_t objects, double extent) {
    std::vector<pose> poses;
    for (std::size_t i = 0; i < objects; ++i)
        poses.push_back(any_turned({uniform(0, extent), uniform(0, extent), uniform(0, extent)}));
    return poses;
}

}  // namespace

TEST_CASE("parts of meshes have the contacts of whole meshes, with every tree and size, also deformed") {
    const std::vector<strategy_choice> trees = all_choices(strategy_kind::tree);
    std::size_t contacts = 0;
    REQUIRE(rc::check([&] {
        manual_scene scene({picture_frame(12, 8), tetrahedron(1), picture_frame(3, 2)}, {0, 1, 2, 1, 0, 1, 2});
        scene.soft = *rc::gen::element(0U, 1U, 2U, 9U);
        composition whole;
        whole[strategy_kind::tree] = *rc::gen::elementOf(trees);
        if (!is_exact_locally(whole)) return;
        composed_pipeline plain(scene, whole);
        composed_pipeline divided(
            scene, splitting(*rc::gen::element("0.01", "0.4", "1", "2", "50"), whole[strategy_kind::tree]));
        for (int frame = 0; frame < 3; ++frame) {
            const std::vector<pose> poses = scattered(scene.mesh_of.size(), 6);
            if (scene.soft < 3)
                for (vec3f& v : scene.meshes[scene.soft].vertices) v[2] += static_cast<float>(uniform(-0.2, 0.2));
            const std::vector<contact> expected = plain.contacts(poses);
            RC_ASSERT(divided.contacts(poses) == expected);
            contacts += expected.size();
        }
    }));
    CHECK(contacts > 100);
}

TEST_CASE("meshes in the hole of a divided mesh are no candidates") {
    const manual_scene scene({picture_frame(40, 40), tetrahedron(1)},
                             std::vector<std::uint32_t>{0, 1, 1, 1, 1, 1, 1, 1});
    std::vector<pose> poses(8);
    for (std::size_t i = 1; i < 8; ++i) poses[i].translation = {10 + 2 * static_cast<double>(i), 15, -0.5};
    poses[7].translation = {10, 0.25, -0.5};  // crosses a bar
    composed_pipeline plain(scene, composition());
    composed_pipeline divided(scene, splitting("1"));
    const std::vector<contact> expected = plain.contacts(poses);
    CHECK_FALSE(expected.empty());
    CHECK(divided.contacts(poses) == expected);
    CHECK(plain.stages.candidates().size() == 7);
    for (const index_pair p : divided.stages.candidates()) CHECK(p == index_pair{0, 7});
    // The mean extent is (80 + 7 * 3) / 24: bars of 40 are cut into ten pieces, of which 36 lie around the hole.
    CHECK(divided.global->counters()[work::pieces] == 36);
    CHECK(divided.stages.models() == 37);
    CHECK(divided.stages.boxes().size() == 36 + 7);
    CHECK(divided.stages.division_bytes() > 0);
    CHECK(plain.stages.division_bytes() == 0);
}

TEST_CASE("meshes that are not long stay whole") {
    const manual_scene scene({tetrahedron(1), picture_frame(4, 3)}, {0, 1, 0});
    composed_pipeline divided(scene, splitting("4"));
    const std::vector<pose> poses(3);
    CHECK(divided.contacts(poses) == composed_pipeline(scene, composition()).contacts(poses));
    CHECK(divided.stages.models() == 2);
    CHECK(divided.global->counters()[work::pieces] == 0);
    const manual_scene nothing({tetrahedron(1)}, {});
    CHECK(composed_pipeline(nothing, splitting("4")).contacts({}).empty());
}

TEST_CASE("rejections name the objects of divided meshes by their own ids") {
    manual_scene scene({picture_frame(40, 40), tetrahedron(1)}, {1, 0, 1, 1, 1});
    scene.soft = 0;
    composed_pipeline divided(scene, splitting("1"));
    REQUIRE(divided.stages.models() == 25);
    std::vector<pose> poses(5);
    CHECK_FALSE(divided.contacts(poses).empty());
    poses[2].translation[0] = 1e300;
    CHECK_REFUSED(divided.stages.update(poses), "object 2 lies beyond the range of float");
    CHECK_THROWS_AS(divided.stages.search(), input_error);
    poses[2] = {};
    poses[3].rotation[0] = NAN;
    CHECK_REFUSED(divided.stages.update(poses), "object 3: the pose has a matrix with an entry that is not finite");
    CHECK_REFUSED(divided.stages.update(std::vector<pose>(4)), "the scene has 5 objects, but the frame has 4 poses");
    poses[3] = {};
    const float before = std::exchange(scene.meshes[0].vertices[77][1], NAN);
    CHECK_REFUSED(divided.stages.update(poses), "vertex 77 has a coordinate that is not finite");
    scene.meshes[0].vertices[77][1] = before;
    const auto last = scene.meshes[0].triangles.back();
    scene.meshes[0].triangles.pop_back();
    CHECK_REFUSED(divided.stages.update(poses),
                  "a deforming mesh must keep its triangles: there were 320, now there are 319");
    scene.meshes[0].triangles.push_back(last);
    CHECK_FALSE(divided.contacts(poses).empty());
    scene.meshes[0].triangles[5][0] = 9999;
    CHECK_THROWS_AS(composed_pipeline(scene, splitting("1")), input_error);
}

TEST_CASE("split_mesh rejects scenes of boxes, and sizes that make far more pieces than objects") {
    const auto stage = compose_global_search(splitting("4"), instrumentation::none);
    stage->insert(0);
    const std::string sentence = "split_mesh divides meshes, but the scene has only boxes; split_large divides boxes";
    CHECK_REFUSED(stage->update(std::vector<box>(1)), sentence);
    CHECK(needs_meshes(splitting("4")) == sentence);
    CHECK(needs_meshes(composition()).empty());
    mesh dust;
    for (std::uint32_t i = 0; i < 4096; ++i) {
        dust.vertices.push_back(
            {static_cast<float>(i % 16), static_cast<float>(i / 16 % 16), static_cast<float>(i >> 8U)});
        dust.triangles.push_back({i, i, i});
    }
    const manual_scene scene({dust}, std::vector<std::uint32_t>(17, 0));
    CHECK_REFUSED(composed_pipeline(scene, splitting("0.001")),
                  "split_mesh: this size makes more than 65808 pieces of 17 objects; a greater size makes fewer");
}
