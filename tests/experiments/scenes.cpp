#include "temporary_folder.hpp"

import aabb;
import aabblab.files;
import aabblab.scenes;

namespace {

using aabblab::scene_choice;

bool has_parameter(const aabblab::scene_info& info, const std::string& name) {
    return std::ranges::any_of(info.parameters, [&](const aabb::parameter_info& p) { return p.name == name; });
}

/// The kinds of scenes that are generated from a seed.
std::vector<aabblab::scene_info> generated_kinds() {
    std::vector<aabblab::scene_info> kinds;
    for (const aabblab::scene_info& info : aabblab::scene_kinds())
        if (!info.reads_file) kinds.push_back(info);
    return kinds;
}

std::vector<std::vector<aabb::box>> boxes_of(const scene_choice& choice) {
    const auto scene = aabblab::make_box_scene(choice);
    std::vector<std::vector<aabb::box>> frames;
    for (std::vector<aabb::box> boxes; scene->next(boxes);) frames.push_back(boxes);
    REQUIRE(frames.size() == scene->frames());
    for (const auto& boxes : frames) {
        REQUIRE(boxes.size() == scene->objects());
        REQUIRE_NOTHROW(aabb::require_valid(boxes));
    }
    return frames;
}

std::vector<std::vector<aabb::pose>> poses_of(const scene_choice& choice) {
    const auto scene = aabblab::make_mesh_scene(choice);
    std::vector<std::vector<aabb::pose>> frames;
    for (std::vector<aabb::pose> poses; scene->next(poses);) frames.push_back(poses);
    REQUIRE(frames.size() == scene->frames());
    for (const auto& poses : frames) {
        REQUIRE(poses.size() == scene->mesh_of.size());
        for (const aabb::pose& p : poses) REQUIRE(aabb::orthonormality_error(p) < 1e-14);
    }
    for (const std::uint32_t m : scene->mesh_of) REQUIRE(m < scene->meshes.size());
    return frames;
}

std::string error_of(const scene_choice& choice, bool of_meshes) {
    return refusal_in<aabb::input_error>([&] {
        of_meshes ? static_cast<void>(aabblab::make_mesh_scene(choice))
                  : static_cast<void>(aabblab::make_box_scene(choice));
    });
}

std::string digest_of(const scene_choice& choice) {
    aabb::digest digest;
    for (const auto& boxes : boxes_of(choice))
        for (const aabb::box& b : boxes) digest.add(std::bit_cast<std::array<std::uint32_t, 6>>(b));
    return digest.text();
}

/// The number of overlapping pairs of boxes.
std::size_t overlaps_in(std::span<const aabb::box> boxes) {
    std::size_t pairs = 0;
    for (std::size_t a = 0; a < boxes.size(); ++a)
        for (std::size_t b = a + 1; b < boxes.size(); ++b) pairs += aabb::overlaps(boxes[a], boxes[b]);
    return pairs;
}
std::size_t overlaps_in(const aabb::mesh_scene& scene, const std::vector<aabb::pose>& poses) {
    std::vector<aabb::box> boxes;
    for (std::size_t i = 0; i < poses.size(); ++i)
        boxes.push_back(aabb::world_bounds(aabb::bounds_of(scene.meshes[scene.mesh_of[i]]), poses[i]));
    return overlaps_in(boxes);
}

double longest_edge(const aabb::mesh& m) {
    const aabb::box b = aabb::bounds_of(m);
    const int k = aabb::longest_axis(b);
    return double{b.max[k] - b.min[k]};
}

}  // namespace

TEST_CASE("every scene runs with 0, 1, 2 and 50 objects, reproducibly for a seed") {
    for (const aabblab::scene_info& info : generated_kinds())
        for (const std::string objects : {"0", "1", "2", "50"})
            for (const std::string frames : {"0", "3"}) {
                CAPTURE(info.name, objects, frames);
                scene_choice choice{info.name, {{"frames", frames}}, {}, 1};
                if (has_parameter(info, "objects")) choice.settings.push_back({"objects", objects});
                const auto description_for = [&](std::uint64_t seed) {
                    choice.seed = seed;
                    if (!info.has_meshes) {
                        const auto result = boxes_of(choice);
                        REQUIRE(result.size() == std::stoul(frames) + 1);
                        REQUIRE(result[0].size() == std::stoul(objects));
                        REQUIRE(result == boxes_of(choice));
                        return digest_of(choice);
                    }
                    choice.meshes = {"icosphere:triangles=20", "torus_knot:triangles=100"};
                    const auto result = poses_of(choice);
                    REQUIRE(result.size() == std::stoul(frames) + 1);
                    REQUIRE(result == poses_of(choice));
                    if (has_parameter(info, "objects")) REQUIRE(result[0].size() == std::stoul(objects));
                    std::string places;
                    for (const aabb::pose& p : result[0]) places += std::to_string(p.translation[0]) + " ";
                    return places;
                };
                const bool is_random = info.name != "lattice" && (objects != "0" || !has_parameter(info, "objects"));
                REQUIRE((description_for(1) != description_for(2)) == is_random);
            }
}

TEST_CASE("deforming sends a wave of the given amplitude through its second mesh only") {
    const auto scene = aabblab::make_mesh_scene({"deforming",
                                                 {{"frames", "9"}, {"amplitude", "0.1"}},
                                                 {"icosphere:triangles=320", "icosphere:triangles=320"},
                                                 3});
    REQUIRE(scene->deforms(1));
    REQUIRE_FALSE(scene->deforms(0));
    const std::vector<aabb::vec3f> rigid = scene->meshes[0].vertices;
    const std::vector<aabb::vec3f> rest = scene->meshes[1].vertices;
    std::vector<aabb::vec3f> before;
    std::vector<aabb::pose> poses;
    double highest = 0;
    while (scene->next(poses)) {
        const std::vector<aabb::vec3f>& now = scene->meshes[1].vertices;
        REQUIRE(now != before);
        for (std::size_t v = 0; v < now.size(); ++v) {
            const aabb::vec3f by = now[v] - rest[v];
            highest = std::max(highest, std::sqrt(double{aabb::dot(by, by)}));
        }
        before = now;
    }
    CHECK_BETWEEN(0.09, highest, 0.1001);
    REQUIRE(scene->meshes[0].vertices == rigid);
}

TEST_CASE("scenes of boxes are the same on every platform") {
    const std::map<std::string, std::string> digests = {
        {"adversarial", "e7b272c96fb69250"}, {"brownian", "0667e87404c1b636"}, {"cloud", "e809fdc8d20f68d1"},
        {"clustered", "aaaea97623a21fdf"},   {"far", "3d2998bf5a2db46a"},      {"hollow_sphere", "bde4980e9fc1f3ae"},
        {"needles", "2c1b44defa4ed77a"},     {"flat", "5ae6badf7f352244"},     {"free_fall", "b1352c0b89ed873c"},
        {"lattice", "2a705db652c5999e"},     {"line", "7f38f59a5ffc2b8f"},     {"explosion", "33485376b2a2ec82"},
        {"mixed_sizes", "db4d8d60f9665ca0"}, {"one_huge", "51bda2b7c0dc1ceb"}, {"pile", "fc1a247f0e5d0cf7"},
        {"population", "ca41715a3d7423d3"},  {"still", "eb8d35bd590c782f"},    {"teleport", "e2eaec4657c1a0b1"}};
    for (const aabblab::scene_info& info : generated_kinds()) {
        if (info.has_meshes) continue;
        CAPTURE(info.name);
        CHECK(digest_of({info.name, {{"objects", "300"}, {"frames", "7"}}, {}, 5}) == digests.at(info.name));
    }
}

TEST_CASE("brownian cubes stay in their world and move at most by the given displacement") {
    const double side = 21.5443469;  // cbrt(1000 / 0.1)
    const auto largest_step = [&](const std::vector<aabb::setting>& settings) {
        const auto frames = boxes_of({"brownian", settings, {}, 1});
        double largest = 0;
        for (std::size_t f = 0; f < frames.size(); ++f)
            for (std::size_t i = 0; i < frames[f].size(); ++i) {
                double square = 0;
                for (int k = 0; k < 3; ++k) {
                    REQUIRE(frames[f][i].min[k] >= 0);
                    REQUIRE(frames[f][i].max[k] <= side);
                    REQUIRE(std::abs(frames[f][i].max[k] - frames[f][i].min[k] - 1) < 1e-5);
                    if (f == 0) continue;
                    const double moved = double{frames[f][i].min[k]} - double{frames[f - 1][i].min[k]};
                    square += moved * moved;
                }
                largest = std::max(largest, std::sqrt(square));
            }
        return largest;
    };
    const double by_speed = largest_step({});
    REQUIRE(by_speed <= 0.75 * side / 30 + 1e-5);
    REQUIRE(by_speed > 0.7 * side / 30);
    const double by_displacement = largest_step({{"displacement", "0.01"}});
    REQUIRE(by_displacement <= 0.01 + 1e-5);
    REQUIRE(by_displacement > 0.009);
    // Steps of any size are reflected back into the world.
    largest_step({{"displacement", "1e9"}});
}

TEST_CASE("a hundredth of the brownian cubes change direction in each frame") {
    const auto frames = boxes_of({"brownian", {{"frames", "2"}, {"displacement", "0.01"}}, {}, 3});
    std::size_t straight = 0;
    for (std::size_t i = 0; i < 1000; ++i) {
        double bend = 0;
        for (int k = 0; k < 3; ++k)
            bend += std::abs((double{frames[2][i].min[k]} - double{frames[1][i].min[k]}) -
                             (double{frames[1][i].min[k]} - double{frames[0][i].min[k]}));
        straight += bend < 1e-5;
    }
    // About ten change direction and some are reflected; of slow ones this does not show.
    CHECK_BETWEEN(970, straight, 1000);
}

TEST_CASE("neighbours in a lattice touch in every frame, for any step") {
    for (const std::string step : {"0.25", "0.1", "1e-9"}) {
        CAPTURE(step);
        for (const auto& boxes : boxes_of({"lattice", {{"objects", "27"}, {"displacement", step}}, {}, 1}))
            REQUIRE(overlaps_in(boxes) == 158);  // pairs of the 27 cells that are neighbours
    }
}

TEST_CASE("the objects of a swarm overlap, use its meshes in turn and move by the default displacement") {
    const auto scene = aabblab::make_mesh_scene(
        {"mesh_swarm", {{"objects", "100"}}, {"icosphere:triangles=80", "torus_knot:triangles=200"}, 1});
    REQUIRE(scene->meshes.size() == 2);
    for (const aabb::mesh& m : scene->meshes) REQUIRE(std::abs(longest_edge(m) - 1) < 1e-6);
    for (const std::size_t i : {0U, 1U, 2U}) REQUIRE(scene->mesh_of[i] == i % 2);
    std::vector<aabb::pose> before;
    std::vector<aabb::pose> poses;
    while (scene->next(poses)) {
        for (std::size_t i = 0; i < before.size(); ++i) {
            const aabb::vec3d moved = poses[i].translation - before[i].translation;
            REQUIRE(aabb::dot(moved, moved) <= 0.0501 * 0.0501);
            REQUIRE(poses[i].rotation != before[i].rotation);
        }
        REQUIRE(overlaps_in(*scene, poses) > 50);
        before = poses;
    }
}

TEST_CASE("huge objects of a swarm come first, with the first mesh and the given length") {
    const std::vector<std::string> single{"icosphere:triangles=80"};
    for (const std::vector<std::string>& meshes : {single, {single[0], "torus_knot:triangles=200", single[0]}}) {
        const auto scene = aabblab::make_mesh_scene(
            {"mesh_swarm", {{"objects", "64"}, {"huge", "3"}, {"span", "0.5"}, {"density", "1"}}, meshes, 1});
        REQUIRE(scene->meshes.size() == std::max<std::size_t>(meshes.size(), 2));
        for (std::size_t i = 0; i < 64; ++i)
            REQUIRE(scene->mesh_of[i] == (i < 3 ? 0 : 1 + (i - 3) % (scene->meshes.size() - 1)));
        // The others fill a cube of 61 unit cubes.
        const double side = std::cbrt(61.0);
        for (std::size_t m = 0; m < scene->meshes.size(); ++m)
            REQUIRE(std::abs(longest_edge(scene->meshes[m]) - (m == 0 ? side / 2 : 1)) < 1e-5);
        for (std::vector<aabb::pose> poses; scene->next(poses);) REQUIRE(overlaps_in(*scene, poses) > 61);
    }
    // All objects may be huge, more than all, or none.
    for (const char* huge : {"5", "9", "0"})
        REQUIRE(poses_of({"mesh_swarm", {{"objects", "5"}, {"huge", huge}}, single, 1})[0].size() == 5);
}

TEST_CASE_METHOD(in_folder, "meshes that are not normalised keep their coordinates and still overlap") {
    const auto file = folder.write("a.off", "OFF\n4 2 0\n1000 0 0\n1010 0 0\n1000 10 0\n1000 0 10\n3 0 1 2\n3 0 2 3\n");
    for (const std::string kind : {"mesh_swarm", "mesh_pair"}) {
        const auto scene = aabblab::make_mesh_scene({kind, {{"normalise", "no"}}, {file.string()}, 1});
        REQUIRE(scene->meshes[0].vertices[1] == aabb::vec3f{1010, 0, 0});
        for (std::vector<aabb::pose> poses; scene->next(poses);) REQUIRE(overlaps_in(*scene, poses) > 0);
    }
}

TEST_CASE("one mesh of a pair moves through the other") {
    const auto frames = poses_of({"mesh_pair", {{"frames", "4"}, {"distance", "0.5"}}, {"icosphere"}, 1});
    for (std::size_t f = 0; f < 5; ++f) {
        const aabb::vec3d offset = frames[f][1].translation - frames[f][0].translation;
        const double expected[] = {0.5, 0.25, 0, 0.25, 0.5};
        REQUIRE(std::abs(std::sqrt(aabb::dot(offset, offset)) - expected[f]) < 1e-6);
        REQUIRE(frames[f][0] == frames[0][0]);
    }
}

TEST_CASE("a pair with distance 0 and turn 0 does not move") {
    const auto frames = poses_of({"mesh_pair", {{"frames", "4"}, {"distance", "0"}, {"turn", "0"}}, {"icosphere"}, 1});
    for (const auto& poses : frames) REQUIRE(poses == frames[0]);
}

TEST_CASE("invalid scenes are rejected") {
    REQUIRE(error_of({"browninan", {}, {}, 1}, false) == "unknown scene 'browninan'; did you mean 'brownian'?");
    REQUIRE(error_of({"mesh_swarm", {}, {}, 1}, false) == "mesh_swarm is a scene of meshes, not of boxes");
    REQUIRE(error_of({"lattice", {}, {}, 1}, true) == "lattice is a scene of boxes, not of meshes");
    REQUIRE(error_of({"lattice", {}, {"icosphere"}, 1}, false) == "lattice is a scene of boxes and takes no meshes");
    REQUIRE(error_of({"lattice", {{"object", "5"}}, {}, 1}, false) ==
            "unknown parameter of lattice 'object'; did you mean 'objects'?");
    for (const std::string count : {"-1", "1.5", "2147483648", "", "ten", "99999999999999999999"})
        REQUIRE(error_of({"brownian", {{"objects", count}}, {}, 1}, false) ==
                "brownian: objects must be a whole number from 0 to 2147483647, not '" + count + "'");
    for (const std::string number : {"0", "-1", "nan", "inf", "1e10"})
        REQUIRE(error_of({"brownian", {{"displacement", number}}, {}, 1}, false) ==
                "brownian: displacement must be a number above 0 and at most 1e+09 or auto, not '" + number + "'");
    REQUIRE(error_of({"mesh_pair", {}, {"icosphere", "icosphere", "icosphere"}, 1}, true) ==
            "mesh_pair takes at most 2 meshes, not 3");
}
