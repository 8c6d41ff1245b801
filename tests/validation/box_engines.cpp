#include "engines.hpp"

using namespace aabb;

namespace {

void require_exact_engines(const std::vector<box>& boxes) {
    for_each_box_engine([&](global_stage& engine) {
        for (std::uint32_t id = 0; id < boxes.size(); ++id) engine.insert(id);
        REQUIRE(found_by(engine, boxes) == overlapping(boxes));
    });
}

}  // namespace

TEST_CASE("engines find every pair of overlapping boxes once") {
    constexpr float largest = std::numeric_limits<float>::max();
    constexpr float smallest = std::numeric_limits<float>::denorm_min();
    std::mt19937 random(1);
    std::vector<box> points = lattice_boxes(random, 300);
    for (box& b : points) b.max = b.min;
    const std::pair<const char*, std::vector<box>> scenes[] = {
        {"random boxes", random_boxes(random, 700, 2)},
        {"random boxes, sparse", random_boxes(random, 700, 0.2F)},
        {"two that share one cell of a grid only, where cells are counted from zero",
         {{{0.2F, 0.2F, -0.3F}, {0.8F, 0.8F, 0.3F}}, {{0.3F, 0.3F, 0.1F}, {0.7F, 0.7F, 0.65F}}}},
        {"a lattice with many ties", lattice_boxes(random, 600)},
        {"equal boxes", std::vector<box>(50, {{1, 2, 3}, {2, 3, 4}})},
        {"points", points},
        {"none", {}},
        {"one", {{{0, 0, 0}, {1, 1, 1}}}},
        {"two that touch", {{{0, 0, 0}, {1, 1, 1}}, {{1, 1, 1}, {2, 2, 2}}}},
        {"two that do not", {{{0, 0, 0}, {1, 1, 1}}, {{1.0000001F, 1, 1}, {2, 2, 2}}}},
        {"the ends of float",
         {{{-largest, -largest, -largest}, {largest, largest, largest}},
          {{largest, largest, largest}, {largest, largest, largest}},
          {{-largest, -largest, -largest}, {-largest, -largest, -largest}},
          {{0, 0, 0}, {smallest, smallest, smallest}},
          {{-0.0F, -0.0F, -0.0F}, {0, 0, 0}},
          {{smallest, smallest, smallest}, {1, 1, 1}}}}};
    for (const auto& [name, boxes] : scenes) {
        INFO(name);
        require_exact_engines(boxes);
    }
    // A few equal points.
    for (std::size_t n = 2; n <= 9; ++n) require_exact_engines(std::vector<box>(n, {{1, 2, 3}, {1, 2, 3}}));
}

TEST_CASE("engines follow boxes that move and objects that come and go") {
    constexpr std::uint32_t count = 300;
    for_each_box_engine([&](global_stage& engine) {
        std::mt19937 random(2);
        std::vector<box> boxes = random_boxes(random, count, 2);
        std::vector<bool> present(count, false);
        for (int frame = 0; frame < 8; ++frame) {
            for (box& b : boxes) {
                const float step = uniform(random, -0.3F, 0.3F);
                for (int k = 0; k < 3; ++k) b.min[k] += step, b.max[k] += step;
            }
            for (std::uint32_t id = 0; id < count; ++id) {
                if (random() % 3 != 0) continue;
                if (present[id])
                    engine.remove(id);
                else
                    engine.insert(id);
                present[id] = !present[id];
            }
            INFO("frame " << frame);
            REQUIRE(found_by(engine, boxes) == overlapping(boxes, present));
        }
        for (std::uint32_t id = 0; id < count; ++id)
            if (present[id]) engine.remove(id);
        REQUIRE(found_by(engine, boxes).empty());
    });
}

TEST_CASE("an object that is removed and inserted between frames is present once") {
    const std::vector<box> boxes(3, {{0, 0, 0}, {1, 1, 1}});
    for_each_box_engine([&](global_stage& engine) {
        for (std::uint32_t id = 0; id < 3; ++id) engine.insert(id);
        REQUIRE(found_by(engine, boxes) == overlapping(boxes));
        engine.remove(1);
        engine.insert(1);
        REQUIRE(found_by(engine, boxes) == overlapping(boxes));
    });
}

TEST_CASE("engines refuse invalid boxes and invalid ids") {
    constexpr float nan = std::numeric_limits<float>::quiet_NaN();
    for_each_box_engine([&](global_stage& engine) {
        const std::vector<box> single(1, {{0, 0, 0}, {1, 1, 1}});
        CHECK_REFUSED(engine.update(single), "no object was inserted; call insert(id) for each box first");
        engine.insert(0);
        engine.insert(1);
        CHECK_REFUSED(engine.insert(1), "object 1 is inserted twice");
        CHECK_REFUSED(engine.remove(7), "object 7 is removed but was never inserted");
        CHECK_REFUSED(engine.update(single), "object 1 is present, but the frame has only 1 boxes");
        std::vector<box> bad(2, {{0, 0, 0}, {1, 1, 1}});
        bad[1].min[2] = nan;
        CHECK_REFUSED(engine.update(bad), "box 1 has a coordinate that is not finite");
        bad[1] = {{0, 0, 2}, {1, 1, 1}};
        CHECK_REFUSED(engine.update(bad), "box 1 is inverted: its minimum is above its maximum");
    });
}

TEST_CASE("ODE's hashed grid rejects more objects than it can count pairs of") {
    if (is_left_out("ode_hash")) SKIP(rejection_of_engine("ode_hash"));
    constexpr std::uint32_t most = 131'071;
    const auto engine = make_box_engine("ode_hash");
    for (std::uint32_t id = 0; id <= most; ++id) engine->insert(id);
    const std::vector<box> boxes(most + 1, {{0, 0, 0}, {1, 1, 1}});
    CHECK_REFUSED(
        engine->update(boxes),
        "ode_hash takes at most 131071 objects, but there are 131072: ODE counts the bytes for their pairs in an int");
}

TEST_CASE("engines report their memory") {
    std::mt19937 random(3);
    const std::vector<box> boxes = random_boxes(random, 100, 1);
    for_each_box_engine([&](global_stage& engine) {
        for (std::uint32_t id = 0; id < boxes.size(); ++id) engine.insert(id);
        engine.update(boxes);
        const std::vector<part_bytes> bytes = engine.bytes();
        REQUIRE(bytes.size() == 1);
        REQUIRE(bytes[0].part == "engine");
        REQUIRE(bytes[0].bytes >= boxes.size() * sizeof(box));
    });
}
