#include "../compositions.hpp"
#include "engines.hpp"

using namespace aabb;

namespace {

struct frame {
    std::vector<box> boxes;
    std::vector<index_pair> pairs;
};

constexpr float largest = std::numeric_limits<float>::max();

/// Boxes whose coordinates are among these, and their pairs by the definition.
frame any_frame(std::mt19937& random, std::uint32_t objects, const std::vector<float>& ends) {
    frame result;
    for (std::uint32_t i = 0; i < objects; ++i) {
        box& b = result.boxes.emplace_back();
        for (int k = 0; k < 3; ++k) {
            b.min[k] = ends[random() % ends.size()];
            b.max[k] = ends[random() % ends.size()];
            if (b.min[k] > b.max[k]) std::swap(b.min[k], b.max[k]);
        }
    }
    result.pairs = overlapping(result.boxes);
    return result;
}

/// Frames in which boxes reach the largest floats of both signs, or of one.
std::vector<frame> frames_of(std::uint32_t objects, std::uint32_t seed) {
    std::mt19937 random(seed);
    return {any_frame(random, objects, {-largest, -1, 0, 1, largest}), any_frame(random, objects, {0, 1, largest})};
}

void require_exact(global_stage& stage, const std::vector<frame>& frames) {
    for (std::uint32_t id = 0; id < frames[0].boxes.size(); ++id) stage.insert(id);
    for (const frame& f : frames) {
        REQUIRE_FALSE(f.pairs.empty());
        REQUIRE(found_by(stage, f.boxes) == f.pairs);
    }
}

}  // namespace

TEST_CASE("engines find every pair of boxes that reach the largest floats") {
    // CGAL on floats misses pairs in few such scenes, so there are many of them.
    for (std::uint32_t seed = 0; seed < 100; ++seed)
        for (const std::uint32_t objects : {20U, 300U}) {
            const std::vector<frame> frames = frames_of(objects, seed);
            INFO(objects << " objects, seed " << seed);
            for_each_box_engine([&](global_stage& engine) { require_exact(engine, frames); });
        }
}

TEST_CASE("compositions find every pair of boxes that reach the largest floats") {
    // Most boxes overlap, so each further object adds many pairs.
    const std::vector<frame> frames = frames_of(120, 1);
    for (aabb::composition composition : global_compositions()) {
        // Cells of edge 3 do not fit in memory in this world.
        for (setting& s : composition[strategy_kind::partition].settings)
            if (s.name == "cell_size") s.value = "1e38";
        INFO(text_of_global(composition));
        require_exact(*global_of(composition, instrumentation::none), frames);
        if (composition[strategy_kind::prepare].name != "split_large" ||
            composition[strategy_kind::sort].name != "insertion")
            continue;
        composition[strategy_kind::prepare].settings = {{"size", "0.5"}};
        INFO("into more pieces");
        require_exact(*global_of(composition, instrumentation::none), frames);
    }
}

TEST_CASE("CGAL finds every pair of triangles whose boxes reach the largest float") {
    for (std::uint32_t seed = 0; seed < 200; ++seed) {
        std::mt19937 random(seed);
        const auto end = [&] { return random() % 2 ? largest : 0; };
        const auto any_mesh = [&] {
            mesh m;
            for (std::uint32_t t = 0; t < 20; ++t) {
                for (int corner = 0; corner < 3; ++corner) m.vertices.push_back({end(), end(), end()});
                m.triangles.push_back({3 * t, 3 * t + 1, 3 * t + 2});
            }
            return m;
        };
        const mesh a = any_mesh();
        const mesh b = any_mesh();
        INFO("seed " << seed);
        const std::vector<index_pair> pairs = pairs_of(*make_mesh_engine("brute_force"), a, {}, b, {});
        REQUIRE(pairs.size() > 100);
        REQUIRE(pairs_of(*make_mesh_engine("cgal"), a, {}, b, {}) == pairs);
    }
}
