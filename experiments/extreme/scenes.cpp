module aabblab.extreme;

import aabb.pipeline;
import aabblab.scenes;

namespace aabblab {

namespace {

/// Meshes of `aabblab data` that have triangles of zero area.
constexpr std::array<const char*, 2> degenerate_meshes = {"degtri_sliding.off", "mpi.off"};

/// A scene of 40 generated triangle pairs of a class: first triangles in one mesh, second ones in the other.
aabb::extreme_scene scene_of(const pair_class_info& info) {
    constexpr std::size_t count = 40;
    aabb::extreme_scene scene{.name = "pairs_" + std::string(info.name), .summary = std::string(info.summary)};
    scene.make_meshes = [name = info.name]() -> std::unique_ptr<aabb::mesh_scene> {
        std::vector<aabb::triangle_pair<float>> pairs(count);
        pair_source<float>(name, /*seed=*/1).next(pairs);
        std::vector<aabb::mesh> meshes(2);
        const auto add = [](aabb::mesh& m, const aabb::triangle3f& t) {
            const auto first = static_cast<std::uint32_t>(m.vertices.size());
            m.vertices.insert(m.vertices.end(), {t[0], t[1], t[2]});
            m.triangles.push_back({first, first + 1, first + 2});
        };
        for (const aabb::triangle_pair<float>& p : pairs) {
            add(meshes[0], p.a);
            add(meshes[1], p.b);
        }
        return std::make_unique<aabb::known_poses>(std::move(meshes), std::vector<std::vector<aabb::pose>>{{{}, {}}});
    };
    return scene;
}

/// A mesh from a file and a copy, first in the same place, then displaced by a hundredth of its longest extent.
aabb::extreme_scene scene_of(const std::string& file) {
    aabb::extreme_scene scene{.name = file,
                              .summary = "a real mesh with zero-area triangles, against a copy of itself"};
    scene.make_meshes = [file]() -> std::unique_ptr<aabb::mesh_scene> {
        aabb::mesh m = make_mesh(file).mesh;
        const aabb::box bounds = bounds_of(m);
        const int axis = longest_axis(bounds);
        aabb::pose beside;
        beside.translation[axis] = (double{bounds.max[axis]} - double{bounds.min[axis]}) / 100;
        return std::make_unique<aabb::known_poses>(std::move(m),
                                                   std::vector<std::vector<aabb::pose>>{{{}, {}}, {{}, beside}});
    };
    return scene;
}

}  // namespace

/// All scenes of the suite: fixed ones, generated pairs, and real meshes whose files exist; a note names the others.
extreme_list all_extreme_scenes(aabb::extreme_size size) {
    extreme_list list{aabb::extreme_scenes(size), {}};
    for (const pair_class_info& info : pair_classes()) list.scenes.push_back(scene_of(info));
    std::string absent;
    for (const std::string file : degenerate_meshes)
        if (is_mesh(file, /*folder=*/{}))
            list.scenes.push_back(scene_of(file));
        else
            absent += (absent.empty() ? "" : ", ") + file;
    if (!absent.empty()) list.notes.push_back("skipped, as missing: " + absent + " (./aabblab data gets them)");
    if (!aabb::can_flush_denormals())
        list.notes.emplace_back(
            "skipped: threads that flush denormals, because the program cannot make this processor do so");
    return list;
}

}  // namespace aabblab
