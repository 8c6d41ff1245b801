module aabb.extreme;

import :making;

namespace aabb {

namespace {

/// A frame of these boxes, and a further one for each step, in which all have moved by `shift` along each axis.
box_frames moving(std::vector<box> boxes, float shift, int steps = 1) {
    box_frames frames{std::move(boxes)};
    for (int step = 0; step < steps; ++step) {
        frames.push_back(frames.back());
        for (box& b : frames.back())
            for (int k = 0; k < 3; ++k) {
                b.min[k] += shift;
                b.max[k] += shift;
            }
    }
    return frames;
}

template <class Make>
std::vector<box> boxes_of(std::uint32_t count, Make make) {
    std::vector<box> boxes;
    for (std::uint32_t i = 0; i < count; ++i) boxes.push_back(make(i));
    return boxes;
}

/// Five by five by five unit cubes that touch, then all moved by a quarter.
box_frames lattice() {
    const auto cell = [](std::uint32_t i) {
        const std::uint32_t layer = i / 25;
        const vec3f low{static_cast<float>(i % 5), static_cast<float>(i / 5 % 5), static_cast<float>(layer)};
        return box_at(low, {1, 1, 1});
    };
    return moving(boxes_of(125, cell), /*shift=*/0.25F);
}

box_frames points() {
    draws random(11);
    const auto coordinate = [&] { return static_cast<float>(random.below(4)); };
    const auto point = [&](std::uint32_t) { return bounds_of(vec3f{coordinate(), coordinate(), coordinate()}); };
    return moving(boxes_of(80, point), /*shift=*/1);
}

/// 80 boxes with zero extent on one or two axes (`flat_axes`); the first is axis i % 3 for box i.
box_frames without_extent(int flat_axes, std::uint32_t seed) {
    draws random(seed);
    const auto make_box = [&](std::uint32_t i) {
        vec3f extents = random.point(0, 6);
        for (int k = 0; k < flat_axes; ++k) extents[static_cast<int>(i + static_cast<unsigned>(k)) % 3] = 0;
        vec3f low = random.point(0, 10);
        // Integer coordinates, so that some of the boxes overlap.
        for (int k = 0; k < 3; ++k) low[k] = std::floor(low[k]);
        return box_at(low, extents);
    };
    return moving(boxes_of(80, make_box), /*shift=*/0.5F);
}

/// 39 boxes whose edges are of 13 magnitudes, from a millionth to a million.
box_frames mixed_sizes() {
    draws random(13);
    const auto make_box = [&](std::uint32_t i) {
        const float size = std::pow(10.0F, static_cast<float>(i % 13) - 6);
        return box_at(random.point(-1000, 1000), random.point(0.5F * size, size));
    };
    return moving(boxes_of(39, make_box), /*shift=*/100);
}

/// One box of edge 2e9, and within it 59 of at most a thousandth.
box_frames one_huge() {
    draws random(14);
    const auto make_box = [&](std::uint32_t i) {
        return i == 40 ? box{{-1e9F, -1e9F, -1e9F}, {1e9F, 1e9F, 1e9F}}
                       : box_at(random.point(0, 1), random.point(0, 1e-3F));
    };
    return moving(boxes_of(60, make_box), /*shift=*/1e-3F);
}

/// 70 boxes with their centres in the origin or on the x axis; exactly, since coordinates are integers.
box_frames concentric(bool on_a_line) {
    const auto make_box = [&](std::uint32_t i) {
        const float x = on_a_line ? static_cast<float>(3 * i) : 0;
        const auto half = static_cast<float>(1 + i % 7);
        return box{{x - half, -half, -half}, {x + half, half, half}};
    };
    return moving(boxes_of(70, make_box), /*shift=*/1);
}

box_frames pile() {
    draws random(15);
    // 110 boxes with a mean edge of 2 in a cube of edge 3.8: each overlaps some 50 others.
    const auto make_box = [&](std::uint32_t) { return box_at(random.point(0, 3.8F), random.point(1.5F, 2.5F)); };
    return moving(boxes_of(110, make_box), /*shift=*/0.01F);
}

box_frames row_of(std::uint32_t objects) {
    const auto make_box = [](std::uint32_t i) { return box_at({static_cast<float>(i), 0, 0}, {1, 1, 1}); };
    return moving(boxes_of(objects, make_box), /*shift=*/1, /*steps=*/2);
}

constexpr float least = std::numeric_limits<float>::denorm_min();
constexpr float least_normal = std::numeric_limits<float>::min();
constexpr float most = std::numeric_limits<float>::max();

/// Two independent frames.
template <class Make>
box_frames independent_frames(std::uint32_t count, Make make) {
    std::vector<box> first = boxes_of(count, make);
    return {std::move(first), boxes_of(count, make)};
}

/// Two independent frames of boxes whose coordinates are drawn from `ends`, so that many of them are equal.
box_frames with_ends(const std::vector<float>& ends, std::uint32_t objects, std::uint32_t seed) {
    draws random(seed);
    const auto end = [&] { return ends[random.below(static_cast<std::uint32_t>(ends.size()))]; };
    return independent_frames(objects, [&](std::uint32_t) {
        box b{};
        for (int k = 0; k < 3; ++k) {
            b.min[k] = end();
            b.max[k] = end();
            if (b.min[k] > b.max[k]) std::swap(b.min[k], b.max[k]);
        }
        return b;
    });
}

box_frames denormals() {
    std::vector<float> ends;
    for (int i = -12; i <= 12; ++i) ends.push_back(static_cast<float>(i) * least);
    return with_ends(ends, 80, 21);
}

/// Boxes of about ten in size; the spacing of floats is a sixteenth at a million, 64 at 10^9.
box_frames far_out(float offset) {
    draws random(24);
    return independent_frames(80, [&](std::uint32_t) {
        const vec3f low = random.point(0, 40);
        return box_at({offset + low[0], offset + low[1], -offset - low[2]}, random.point(0, 20));
    });
}

constexpr std::uint32_t population_size = 72;

/// Six frames; in each, all boxes have random new positions and sizes.
box_frames jumping_boxes() {
    draws random(31);
    box_frames frames(6);
    for (std::vector<box>& boxes : frames)
        boxes =
            boxes_of(population_size, [&](std::uint32_t) { return box_at(random.point(0, 10), random.point(0, 4)); });
    return frames;
}

/// The jumping boxes, enlarged 10^9 times in even frames and reduced as much in odd ones: all distances change greatly.
box_frames huge_and_tiny() {
    box_frames frames = jumping_boxes();
    for (std::size_t frame = 0; frame < frames.size(); ++frame)
        for (box& b : frames[frame])
            for (int k = 0; k < 3; ++k) {
                const float scale = frame % 2 == 0 ? 1e9F : 1e-9F;
                b.min[k] *= scale;
                b.max[k] *= scale;
            }
    return frames;
}

/// A scene whose objects appear and disappear: `is_present(frame, i)` states whether object i is present in a frame.
template <class IsPresent>
extreme_scene population(std::string name, std::string summary, IsPresent is_present) {
    extreme_scene scene{.name = std::move(name), .summary = std::move(summary)};
    scene.make_boxes = [is_present]() -> std::unique_ptr<box_scene> {
        box_frames frames = jumping_boxes();
        std::vector<std::vector<std::uint8_t>> present(frames.size(), std::vector<std::uint8_t>(population_size));
        for (std::size_t frame = 0; frame < frames.size(); ++frame)
            for (std::uint32_t i = 0; i < population_size; ++i) {
                present[frame][i] = static_cast<std::uint8_t>(is_present(frame, i));
                // An absent box must overlap no other (`box_scene::present`), so that engines without presence agree.
                if (!present[frame][i]) frames[frame][i] = bounds_of(vec3f{1000 + static_cast<float>(i), 0, 0});
            }
        return std::make_unique<known_boxes>(std::move(frames), std::move(present));
    };
    return scene;
}

}  // namespace

/// All extreme scenes of valid boxes: shapes and arrangements, coordinates, motion, objects that leave and return.
std::vector<extreme_scene> box_scenes() {
    return {
        scene_of_boxes("identical", "60 copies of one box",
                       [] { return moving(std::vector<box>(60, {{1, 2, 3}, {2, 3, 4}}), 0.5F, /*steps=*/2); }),
        scene_of_boxes("lattice", "cubes that touch on a lattice: all comparisons are ties", lattice),
        scene_of_boxes("points", "boxes without extent, many in the same place", points),
        scene_of_boxes("plates", "boxes without extent along one axis", [] { return without_extent(1, /*seed=*/16); }),
        scene_of_boxes("needles", "boxes without extent along two axes", [] { return without_extent(2, /*seed=*/17); }),
        scene_of_boxes("mixed_sizes", "edges from a millionth to a million", mixed_sizes),
        scene_of_boxes("one_huge", "one box of edge 2e9, 59 of edges up to 0.001", one_huge),
        scene_of_boxes("concentric", "all centres in one point", [] { return concentric(/*on_a_line=*/false); }),
        scene_of_boxes("on_a_line", "all centres on a line", [] { return concentric(/*on_a_line=*/true); }),
        scene_of_boxes("pile", "every box overlaps about 50 others", pile),
        scene_of_boxes("no_objects", "no boxes", [] { return row_of(0); }),
        scene_of_boxes("one_object", "one box", [] { return row_of(1); }),
        scene_of_boxes("two_objects", "two boxes that touch", [] { return row_of(2); }),
        scene_of_boxes("denormals", "coordinates are small multiples of the smallest positive float", denormals),
        scene_of_boxes(
            "signed_zeros", "-0 against +0, and the numbers next to them",
            [] { return with_ends({-1, -least_normal, -least, -0.0F, 0.0F, least, least_normal, 1}, 70, 22); }),
        scene_of_boxes("greatest_floats", "boxes that extend to the greatest floats",
                       [] { return with_ends({-most, -1, 0, 1, most}, 70, /*seed=*/23); }),
        scene_of_boxes("far_1e6", "a million from the origin", [] { return far_out(1e6F); }),
        scene_of_boxes("far_1e9", "10^9 from the origin, where floats are 64 apart", [] { return far_out(1e9F); }),
        scene_of_boxes("teleport", "every box jumps in each frame", jumping_boxes),
        scene_of_boxes("huge_and_tiny", "the frames are scaled alternately by 10^9 and 10^-9", huge_and_tiny),
        population("comings_and_goings", "a third of the objects leaves in each frame, another third returns",
                   [](std::size_t frame, std::uint32_t i) { return (frame + i) % 3 != 0; }),
        population("all_leave", "all objects leave, then all return",
                   [](std::size_t frame, std::uint32_t) { return frame % 3 != 1; }),
        population("all_change", "one half leaves as the other arrives",
                   [](std::size_t frame, std::uint32_t i) { return (i < population_size / 2) == (frame % 2 == 0); }),
    };
}

}  // namespace aabb
