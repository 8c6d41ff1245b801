module;
#include <fmt/format.h>

module aabblab.queries;

import aabblab.digits;
import aabblab.progress;
import aabblab.stopwatch;

namespace aabblab {

namespace {

bool are_of_same_objects(const aabb::contact& c, const aabb::contact& other) {
    return c.a == other.a && c.b == other.b;
}

std::size_t count_object_pairs(std::span<const aabb::contact> sorted) {
    std::size_t pairs = 0;
    for (std::size_t i = 0; i < sorted.size(); ++i) pairs += i == 0 || !are_of_same_objects(sorted[i], sorted[i - 1]);
    return pairs;
}

void add_contacts(number_table& rows, const played_frame& frame, const scene_play& scene,
                  std::optional<hit_geometry>& geometry) {
    const auto mesh_of = [&](std::uint32_t object) -> const aabb::mesh& {
        return scene.meshes()->meshes[scene.meshes()->mesh_of[object]];
    };
    const aabb::contact* before = nullptr;
    for (const aabb::contact& c : frame.contacts) {
        std::string cells;
        if (geometry) {
            if (before == nullptr || !are_of_same_objects(c, *before))
                geometry->take(mesh_of(c.a), scene.poses()[c.a], mesh_of(c.b), scene.poses()[c.b]);
            cells = to_cells((*geometry)({c.triangle_a, c.triangle_b}));
            before = &c;
        }
        rows.add({frame.number, c.a, c.b, c.triangle_a, c.triangle_b}, cells);
    }
}

}  // namespace

frames_result search_frames(scene_play& scene, search_method& method, number_table* rows) {
    const bool meshes = scene.meshes() != nullptr;
    frames_result result;
    result.objects = scene.objects();
    std::optional<player> who;
    result.build_ms = milliseconds_of([&] { who.emplace(std::move(method.made), scene); });
    progress shown("frames searched", scene.frames());
    tally found(meshes);
    play(scene, *who, [&](const played_frame& frame) {
        result.ms.push_back(whole_nanoseconds(frame.ms()));
        const std::string where = fmt::format("{}, frame {}", method.name, frame.number);
        if (meshes) {
            require_each_once(frame.contacts, where);
            if (rows) add_contacts(*rows, frame, scene, method.geometry);
        } else {
            require_each_once(frame.pairs, where);
            if (rows)
                for (const auto [a, b] : frame.pairs) rows->add({frame.number, a, b});
        }
        found.add(frame.pairs, frame.contacts);
        result.object_pairs += count_object_pairs(frame.contacts);
        shown.at(frame.number + 1);
    });
    result.pairs = found.candidates();
    result.contacts = found.contacts().value_or(0);
    result.digest = found.digest();
    return result;
}

}  // namespace aabblab
