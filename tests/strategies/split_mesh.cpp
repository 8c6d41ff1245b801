#include <rapidcheck.h>

#include "../compositions.hpp"
#include "../meshes.hpp"
#include "../random_poses.hpp"

using namespace aabb;

namespace {

/// The frame of a picture, of 8 n² triangles, in the plane of x and y: most of its box is empty.
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

/// A composition with what it plays.
struct played {
    played(const mesh_scene& scene, const composition& c)
        : global(compose_global_search(c, instrumentation::counters)),
          local(compose_local_detection(c, instrumentation::counters)),
          both(scene, *global, *local) {}

    std::vector<contact> contacts(const std::vector<pose>& poses) {
        both.update(poses);
        both.search();
        both.detect();
        std::vector<contact> found = sorted(both.contacts());
        CHECK(both.count_contacts() == found.size());
        const std::optional<contact> first = both.first_contact();
        CHECK(first.has_value() == !found.empty());
        if (first) CHECK(std::ranges::binary_search(found, *first));
        return found;
    }

    std::unique_ptr<global_stage> global;
    std::unique_ptr<local_stage> local;
    pipeline both;
};

composition splitting(const std::string& size, const strategy_choice& tree = {"canonical", {}}) {
    composition c;
    c[strategy_kind::prepare] = {"split_mesh", {{"size", size}}};
    c[strategy_kind::tree] = tree;
    return c;
}

std::vector<pose> scattered(std::size_t objects, double reach) {
    std::vector<pose> poses;
    for (std::size_t i = 0; i < objects; ++i)
        poses.push_back(any_turned({uniform(0, reach), uniform(0, reach), uniform(0, reach)}));
    return poses;
}

}  // namespace

TEST_CASE("parts of meshes make the contacts of whole ones, with every tree, at every size, where meshes deform too") {
    const std::vector<strategy_choice> trees = all_choices(strategy_kind::tree);
    std::size_t contacts = 0;
    REQUIRE(rc::check([&] {
        told_scene scene({picture_frame(12, 8), tetrahedron(1), picture_frame(3, 2)}, {0, 1, 2, 1, 0, 1, 2});
        scene.soft = *rc::gen::element(0U, 1U, 2U, 9U);
        composition whole;
        whole[strategy_kind::tree] = *rc::gen::elementOf(trees);
        if (!is_exact_locally(whole)) return;
        played plain(scene, whole);
        played parted(scene, splitting(*rc::gen::element("0.01", "0.4", "1", "2", "50"), whole[strategy_kind::tree]));
        for (int frame = 0; frame < 3; ++frame) {
            const std::vector<pose> poses = scattered(scene.mesh_of.size(), 6);
            if (scene.soft < 3)
                for (vec3f& v : scene.meshes[scene.soft].vertices) v[2] += static_cast<float>(uniform(-0.2, 0.2));
            const std::vector<contact> found = plain.contacts(poses);
            RC_ASSERT(parted.contacts(poses) == found);
            contacts += found.size();
        }
    }));
    CHECK(contacts > 100);
}

TEST_CASE("what passes through the hole of a large mesh is no candidate of its parts") {
    const told_scene scene({picture_frame(40, 40), tetrahedron(1)}, std::vector<std::uint32_t>{0, 1, 1, 1, 1, 1, 1, 1});
    std::vector<pose> poses(8);
    for (std::size_t i = 1; i < 8; ++i) poses[i].translation = {10 + 2 * static_cast<double>(i), 15, -0.5};
    poses[7].translation = {10, 0.25, -0.5};  // crosses a bar
    played plain(scene, composition());
    played parted(scene, splitting("1"));
    const std::vector<contact> found = plain.contacts(poses);
    CHECK_FALSE(found.empty());
    CHECK(parted.contacts(poses) == found);
    CHECK(plain.both.candidates().size() == 7);
    for (const index_pair p : parted.both.candidates()) CHECK(p == index_pair{0, 7});
    // The mean extent is (80 + 7 * 3) / 24: bars of 40 are cut into ten pieces, of which 36 lie around the hole.
    CHECK(parted.global->counters()[work::pieces] == 36);
    CHECK(parted.both.models() == 37);
    CHECK(parted.both.boxes().size() == 36 + 7);
    CHECK(parted.both.division_bytes() > 0);
    CHECK(plain.both.division_bytes() == 0);
}

TEST_CASE("meshes that are not long stay whole") {
    const told_scene scene({tetrahedron(1), picture_frame(4, 3)}, {0, 1, 0});
    played parted(scene, splitting("4"));
    const std::vector<pose> poses(3);
    CHECK(parted.contacts(poses) == played(scene, composition()).contacts(poses));
    CHECK(parted.both.models() == 2);
    CHECK(parted.global->counters()[work::pieces] == 0);
    const told_scene nothing({tetrahedron(1)}, {});
    CHECK(played(nothing, splitting("4")).contacts({}).empty());
}

TEST_CASE("objects of divided meshes are refused by their own numbers") {
    told_scene scene({picture_frame(40, 40), tetrahedron(1)}, {1, 0, 1, 1, 1});
    scene.soft = 0;
    played parted(scene, splitting("1"));
    REQUIRE(parted.both.models() == 25);
    std::vector<pose> poses(5);
    CHECK_FALSE(parted.contacts(poses).empty());
    poses[2].translation[0] = 1e300;
    CHECK_REFUSED(parted.both.update(poses), "object 2 lies beyond the range of float");
    CHECK_THROWS_AS(parted.both.search(), input_error);
    poses[2] = {};
    poses[3].rotation[0] = NAN;
    CHECK_REFUSED(parted.both.update(poses),
                  "object 3: the pose is not rigid: its rotation has an entry that is not finite");
    CHECK_REFUSED(parted.both.update(std::vector<pose>(4)), "the scene has 5 objects, but the frame has 4 poses");
    poses[3] = {};
    const float before = std::exchange(scene.meshes[0].vertices[77][1], NAN);
    CHECK_REFUSED(parted.both.update(poses), "vertex 77 has a coordinate that is not finite");
    scene.meshes[0].vertices[77][1] = before;
    const auto last = scene.meshes[0].triangles.back();
    scene.meshes[0].triangles.pop_back();
    CHECK_REFUSED(parted.both.update(poses),
                  "a deforming mesh must keep its triangles: there were 320, now there are 319");
    scene.meshes[0].triangles.push_back(last);
    CHECK_FALSE(parted.contacts(poses).empty());
    scene.meshes[0].triangles[5][0] = 9999;
    CHECK_THROWS_AS(played(scene, splitting("1")), input_error);
}

TEST_CASE("split_mesh refuses boxes alone, and a size that makes far more pieces than there are objects") {
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
    const told_scene scene({dust}, std::vector<std::uint32_t>(17, 0));
    CHECK_REFUSED(played(scene, splitting("0.001")),
                  "split_mesh: this size makes more than 65808 pieces of 17 objects; a greater size makes fewer");
}
