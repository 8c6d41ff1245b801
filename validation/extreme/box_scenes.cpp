module aabb.extreme;

import :making;

namespace aabb {

namespace {

// What they are like.

/// The boxes, and all of them moved by a step along each axis, again and again.
box_frames moved(std::vector<box> boxes, float step, int times) {
    box_frames all{std::move(boxes)};
    for (int frame = 0; frame < times; ++frame) {
        all.push_back(all.back());
        for (box& b : all.back())
            for (int k = 0; k < 3; ++k) {
                b.min[k] += step;
                b.max[k] += step;
            }
    }
    return all;
}

template <class Make>
std::vector<box> boxes_of(std::uint32_t count, Make make) {
    std::vector<box> all;
    for (std::uint32_t i = 0; i < count; ++i) all.push_back(make(i));
    return all;
}

box_frames identical() {
    return moved(std::vector<box>(60, {{1, 2, 3}, {2, 3, 4}}), 0.5F, 2);
}

box_frames lattice() {
    const auto cell = [](std::uint32_t i) {
        const std::uint32_t layer = i / 25;
        const vec3f low{static_cast<float>(i % 5), static_cast<float>(i / 5 % 5), static_cast<float>(layer)};
        return box_at(low, {1, 1, 1});
    };
    return moved(boxes_of(125, cell), 0.25F, 1);
}

box_frames points() {
    draws random(11);
    const auto coordinate = [&] { return static_cast<float>(random.below(4)); };
    const auto point = [&](std::uint32_t) { return bounds_of(vec3f{coordinate(), coordinate(), coordinate()}); };
    return moved(boxes_of(80, point), 1, 1);
}

/// Without any extent on `flat` of the axes.
box_frames without_extent(int flat, std::uint32_t seed) {
    draws random(seed);
    const auto one = [&](std::uint32_t i) {
        vec3f extents = random.point(0, 6);
        for (int k = 0; k < flat; ++k) extents[static_cast<int>(i + static_cast<unsigned>(k)) % 3] = 0;
        vec3f low = random.point(0, 10);
        // On whole numbers, so that some of them meet at all.
        for (int k = 0; k < 3; ++k) low[k] = std::floor(low[k]);
        return box_at(low, extents);
    };
    return moved(boxes_of(80, one), 0.5F, 1);
}

box_frames mixed_sizes() {
    draws random(13);
    const auto one = [&](std::uint32_t i) {
        const float size = std::pow(10.0F, static_cast<float>(i % 13) - 6);
        return box_at(random.point(-1000, 1000), random.point(0.5F * size, size));
    };
    return moved(boxes_of(39, one), 100, 1);
}

box_frames one_huge() {
    draws random(14);
    const auto one = [&](std::uint32_t i) {
        return i == 40 ? box{{-1e9F, -1e9F, -1e9F}, {1e9F, 1e9F, 1e9F}}
                       : box_at(random.point(0, 1), random.point(0, 1e-3F));
    };
    return moved(boxes_of(60, one), 1e-3F, 1);
}

/// Whole numbers are exact, and so are the centres.
box_frames concentric(bool on_a_line) {
    const auto one = [&](std::uint32_t i) {
        const float x = on_a_line ? static_cast<float>(3 * i) : 0;
        const auto half = static_cast<float>(1 + i % 7);
        return box{{x - half, -half, -half}, {x + half, half, half}};
    };
    return moved(boxes_of(70, one), 1, 1);
}

box_frames pile() {
    draws random(15);
    // 110 boxes of edge 2 on average, begun in a cube of edge 3.8: each meets some 50 others.
    const auto one = [&](std::uint32_t) { return box_at(random.point(0, 3.8F), random.point(1.5F, 2.5F)); };
    return moved(boxes_of(110, one), 0.01F, 1);
}

box_frames so_many(std::uint32_t objects) {
    const auto one = [](std::uint32_t i) { return box_at({static_cast<float>(i), 0, 0}, {1, 1, 1}); };
    return moved(boxes_of(objects, one), 1, 2);
}

// Where they are: all ends among few numbers, or far out.

constexpr float least = std::numeric_limits<float>::denorm_min();
constexpr float least_normal = std::numeric_limits<float>::min();
constexpr float most = std::numeric_limits<float>::max();

/// Whose boxes have nothing to do with each other.
template <class Make>
box_frames two_frames(std::uint32_t count, Make make) {
    std::vector<box> first = boxes_of(count, make);
    return {std::move(first), boxes_of(count, make)};
}

/// Two frames of boxes, each end of which is one of these numbers.
box_frames with_ends(std::span<const float> ends, std::uint32_t objects, std::uint32_t seed) {
    draws random(seed);
    const auto end = [&] { return ends[random.below(static_cast<std::uint32_t>(ends.size()))]; };
    return two_frames(objects, [&](std::uint32_t) {
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

box_frames signed_zeros() {
    constexpr std::array<float, 8> ends{-1, -least_normal, -least, -0.0F, 0.0F, least, least_normal, 1};
    return with_ends(ends, 70, 22);
}

box_frames greatest_floats() {
    constexpr std::array<float, 5> ends{-most, -1, 0, 1, most};
    return with_ends(ends, 70, 23);
}

/// Of about ten in size, where floats are a sixteenth apart at a million, 64 apart at 10^9.
box_frames far_out(float offset) {
    draws random(24);
    return two_frames(80, [&](std::uint32_t) {
        const vec3f low = random.point(0, 40);
        return box_at({offset + low[0], offset + low[1], -offset - low[2]}, random.point(0, 20));
    });
}

// What changes from frame to frame.

constexpr std::uint32_t changing = 72;

box_frames elsewhere_in_each() {
    draws random(31);
    box_frames all(6);
    for (std::vector<box>& boxes : all)
        boxes = boxes_of(changing, [&](std::uint32_t) { return box_at(random.point(0, 10), random.point(0, 4)); });
    return all;
}

box_frames huge_and_tiny() {
    box_frames all = elsewhere_in_each();
    for (std::size_t frame = 0; frame < all.size(); ++frame)
        for (box& b : all[frame])
            for (int k = 0; k < 3; ++k) {
                const float scale = frame % 2 == 0 ? 1e9F : 1e-9F;
                b.min[k] *= scale;
                b.max[k] *= scale;
            }
    return all;
}

/// Boxes that come and go.
/// @param is_there of an object in a frame
template <class IsThere>
extreme_scene population(std::string name, std::string summary, IsThere is_there) {
    extreme_scene made{.name = std::move(name), .summary = std::move(summary)};
    made.make_boxes = [is_there]() -> std::unique_ptr<box_scene> {
        box_frames all = elsewhere_in_each();
        std::vector<std::vector<std::uint8_t>> present(all.size(), std::vector<std::uint8_t>(changing));
        for (std::size_t frame = 0; frame < all.size(); ++frame)
            for (std::uint32_t i = 0; i < changing; ++i) {
                present[frame][i] = static_cast<std::uint8_t>(is_there(frame, i));
                // An absent object stands where nothing else is.
                if (!present[frame][i]) all[frame][i] = bounds_of(vec3f{1000 + static_cast<float>(i), 0, 0});
            }
        return std::make_unique<known_boxes>(std::move(all), std::move(present));
    };
    return made;
}

}  // namespace

std::vector<extreme_scene> box_scenes() {
    return {
        scene_of_boxes("identical", "60 times the same box", identical),
        scene_of_boxes("lattice", "cubes that touch on a lattice: nothing but ties", lattice),
        scene_of_boxes("points", "boxes without extent, many in the same place", points),
        scene_of_boxes("plates", "boxes without extent on one axis", [] { return without_extent(1, 16); }),
        scene_of_boxes("needles", "boxes without extent on two axes", [] { return without_extent(2, 17); }),
        scene_of_boxes("mixed_sizes", "edges from a millionth to a million", mixed_sizes),
        scene_of_boxes("one_huge", "one box of 2e9, 59 of at most a thousandth", one_huge),
        scene_of_boxes("concentric", "all centres in one point", [] { return concentric(false); }),
        scene_of_boxes("on_a_line", "all centres on a line", [] { return concentric(true); }),
        scene_of_boxes("pile", "every box has about 50 neighbours", pile),
        scene_of_boxes("no_objects", "nothing at all", [] { return so_many(0); }),
        scene_of_boxes("one_object", "one box", [] { return so_many(1); }),
        scene_of_boxes("two_objects", "two boxes that touch", [] { return so_many(2); }),
        scene_of_boxes("denormals", "ends are small multiples of the least float", denormals),
        scene_of_boxes("signed_zeros", "-0 against +0, and the numbers next to them", signed_zeros),
        scene_of_boxes("greatest_floats", "boxes that reach to the greatest floats", greatest_floats),
        scene_of_boxes("far_1e6", "a million from the origin", [] { return far_out(1e6F); }),
        scene_of_boxes("far_1e9", "10^9 from it, where floats are 64 apart", [] { return far_out(1e9F); }),
        scene_of_boxes("teleport", "everything is elsewhere in each frame", elsewhere_in_each),
        scene_of_boxes("huge_and_tiny", "in turn 10^9 times as large and as small", huge_and_tiny),
        population("comings_and_goings", "a third of the objects leaves in each frame, another comes back",
                   [](std::size_t frame, std::uint32_t i) { return (frame + i) % 3 != 0; }),
        population("all_leave", "all leave, all come back",
                   [](std::size_t frame, std::uint32_t) { return frame % 3 != 1; }),
        population("all_change", "one half leaves as the other comes",
                   [](std::size_t frame, std::uint32_t i) { return (i < changing / 2) == (frame % 2 == 0); }),
    };
}

}  // namespace aabb
