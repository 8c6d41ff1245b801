module;
#include <fmt/format.h>

module aabblab.measures;

import aabb.pipeline;
import aabb.registry;
import aabblab.numbers;

namespace aabblab {

namespace {

constexpr std::size_t frames_measured = 4;

/// Boxes by id, and who is there.
struct seen_frame {
    std::vector<aabb::box> boxes;
    std::vector<bool> present;

    [[nodiscard]] std::vector<aabb::box> of(const std::vector<bool>& whom) const {
        std::vector<aabb::box> some;
        for (std::size_t id = 0; id < boxes.size(); ++id)
            if (whom[id]) some.push_back(boxes[id]);
        return some;
    }
};

/// Those who are there in both frames.
std::vector<bool> in_both(const seen_frame& a, const seen_frame& b) {
    std::vector<bool> both(a.present.size());
    for (std::size_t id = 0; id < both.size(); ++id) both[id] = a.present[id] && b.present[id];
    return both;
}

void add_motion(scene_measures& m, const seen_frame& before, const seen_frame& now, std::size_t axis) {
    const std::vector<bool> both = in_both(before, now);
    const motion_measures one = measure_motion(before.of(both), now.of(both), axis);
    if (!m.motion) m.motion = motion_measures{0, 0, 0, 0};
    m.motion->displacement += one.displacement;
    m.motion->relative += one.relative;
    m.motion->at_rest += one.at_rest;
    m.motion->inversions += one.inversions;
}

void divide(motion_measures& sum, double by) {
    sum.displacement /= by;
    sum.relative /= by;
    sum.at_rest /= by;
    sum.inversions /= by;
}

}  // namespace

scene_measures measure_scene(const scene_choice& choice) {
    scene_play scene(choice);
    return measure_scene(scene);
}

scene_measures measure_scene(scene_play& scene) {
    scene_measures m;
    m.objects = scene.objects();
    m.frames = scene.frames();
    if (scene.meshes()) m.triangles = outlook_of(scene).triangles;
    player who(contender_of(aabb::composition(), scene.meshes() != nullptr), scene, aabb::instrumentation::none);
    seen_frame before;
    std::size_t axis = 0;
    double changes = 0;
    std::size_t followed = 0;
    play(
        scene, who,
        [&](const played_frame& frame) {
            seen_frame now{{who.boxes().begin(), who.boxes().end()}, before.present};
            now.present.resize(now.boxes.size(), scene.meshes() != nullptr);
            for (const std::uint32_t id : scene.arrivals()) now.present[id] = true;
            for (const std::uint32_t id : scene.departures()) now.present[id] = false;
            if (frame.number == 0) {
                const std::vector<aabb::box> there = now.of(now.present);
                m.boxes = measure_boxes(there);
                m.present = there.size();
                m.pairs_an_object = static_cast<double>(frame.pairs.size()) /
                                    static_cast<double>(std::max<std::size_t>(there.size(), 1));
                m.clustering =
                    m.boxes.expected_pairs > 0 ? static_cast<double>(frame.pairs.size()) / m.boxes.expected_pairs : 0;
                axis = static_cast<std::size_t>(std::ranges::min_element(m.boxes.overlaps) - m.boxes.overlaps.begin());
            } else {
                add_motion(m, before, now, axis);
                changes += static_cast<double>(scene.arrivals().size() + scene.departures().size());
                ++followed;
            }
            before = std::move(now);
        },
        frames_measured);
    if (followed > 0) {
        divide(*m.motion, static_cast<double>(followed));
        m.turnover = changes / static_cast<double>(followed) / static_cast<double>(std::max<std::size_t>(m.objects, 1));
    }
    return m;
}

std::vector<told_measure> told(const scene_measures& m) {
    std::vector<told_measure> all{
        {"objects", grouped(m.objects)},
        {"frames", m.frames > frames_measured
                       ? fmt::format("{}, of which the first {} are measured", grouped(m.frames), frames_measured)
                       : grouped(m.frames)}};
    if (m.present != m.objects) all.push_back({"present", grouped(m.present) + " of them in the first frame"});
    if (m.triangles) all.push_back({"triangles", grouped(*m.triangles) + " in the meshes"});
    const auto& o = m.boxes.overlaps;
    all.push_back({"spread", fmt::format("on x, y, z a box overlaps {:.3g}, {:.3g}, {:.3g} others", o[0], o[1], o[2])});
    for (std::size_t k = 0; k < 3; ++k)
        if (m.present > 2 && o[k] > 0.999 * static_cast<double>(m.present - 1))
            all.push_back({"flat axis", std::string(1, "xyz"[k])});
    all.push_back({"size ratio", (m.boxes.size_ratio ? fmt::format("{:.3g}", *m.boxes.size_ratio) : "-") +
                                     ", longest edge over the median one"});
    all.push_back({"density", fmt::format("{:.3g} overlapping pairs an object", m.pairs_an_object)});
    all.push_back({"clustering", fmt::format("{:.3g} times the pairs of evenly spread boxes", m.clustering)});
    if (!m.motion) return all;
    const double unit = m.boxes.typical_extent > 0 ? m.boxes.typical_extent : 1;
    const char* of = m.boxes.typical_extent > 0 ? "typical extents" : "units";
    all.push_back({"displacement", fmt::format("{:.3g} {} a frame, a mean", m.motion->displacement / unit, of)});
    all.push_back(
        {"relative", fmt::format("{:.3g} {}, the greatest beyond what all move alike", m.motion->relative / unit, of)});
    all.push_back({"inversions", fmt::format("{:.3g} an object and frame", m.motion->inversions)});
    all.push_back({"at rest", fmt::format("{:.3g} % of the objects", 100 * m.motion->at_rest)});
    if (m.turnover > 0)
        all.push_back({"turnover", fmt::format("{:.3g} % of the objects come or go in a frame", 100 * m.turnover)});
    return all;
}

}  // namespace aabblab
