// The race behind recommend, and the command.

#include <algorithm>
#include <catch2/catch_test_macros.hpp>
#include <chrono>
#include <cmath>
#include <csignal>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <memory>
#include <span>
#include <stdexcept>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "program.hpp"
#include "temporary_folder.hpp"

import aabb;
import aabb.registry;
import aabb.validation;
import aabblab.play;
import aabblab.race;
import aabblab.scenes;

using aabblab::racer;

namespace {

/// Finds what the usual composition finds, and does something before each frame.
template <class Before>
class delayed_stage final : public aabb::global_stage {
public:
    explicit delayed_stage(Before before) : before_(before) {}

    void insert(std::uint32_t id) override { search_->insert(id); }
    void remove(std::uint32_t id) override { search_->remove(id); }
    void update(std::span<const aabb::box> boxes) override {
        before_();
        search_->update(boxes);
    }
    void search(std::vector<aabb::index_pair>& pairs) override { search_->search(pairs); }
    [[nodiscard]] aabb::work_counters counters() const override { return search_->counters(); }
    [[nodiscard]] std::vector<aabb::part_bytes> bytes() const override { return search_->bytes(); }
    [[nodiscard]] std::vector<std::string> left_out() const override { return {}; }

private:
    Before before_;
    std::unique_ptr<aabb::global_stage> search_ =
        aabb::compose_global_search(aabb::composition(), aabb::instrumentation::none);
};

template <class Before>
racer delayed(const std::string& name, Before before) {
    racer r;
    r.who.name.engine = r.name = name;
    r.who.make_global = [before](aabb::instrumentation) { return std::make_unique<delayed_stage<Before>>(before); };
    return r;
}

const aabblab::scene_choice scene{"brownian", {{"objects", "200"}, {"frames", "24"}}, {}, 1, {}};

bool holds(const std::vector<racer>& some, const std::string& name) {
    return std::ranges::find(some, name, &racer::name) != some.end();
}

}  // namespace

TEST_CASE("A race ends with the fastest, and those who are far behind or fail play no more") {
    using namespace std::chrono_literals;
    // Long enough that a busy machine does not change who is far behind.
    static constexpr auto frame = 5ms;
    std::vector<racer> all{delayed("slow", [] { std::this_thread::sleep_for(20 * frame); }),
                           delayed("fast", [] { std::this_thread::sleep_for(frame); }),
                           delayed("stuck", [] { std::this_thread::sleep_for(10min); }),
                           delayed("broken", [] { throw std::runtime_error("no"); }),
                           delayed("gone", [] { std::raise(SIGKILL); }),
                           delayed("late", [i = 0]() mutable {
                               // Slow for a frame, then as fast as any.
                               std::this_thread::sleep_for(i++ == 0 ? 60 * frame : frame);
                           })};
    const aabblab::race_result race = aabblab::run_race(scene, std::move(all), 2);
    REQUIRE(race.frames == 25);
    REQUIRE(race.objects == 200);
    REQUIRE_FALSE(race.finalists.empty());
    CHECK(race.finalists.front().name == "fast");
    CHECK(holds(race.finalists, "late"));
    for (const char* name : {"slow", "stuck", "broken", "gone"}) CHECK(holds(race.dropped, name));
    CHECK(race.played < race.of);
    CHECK(std::exp(race.finalists.front().log_ratio->value) == 1);
    for (const racer& r : race.finalists) {
        CHECK(r.times.size() >= 5);
        CHECK(r.last->digest == race.finalists.front().last->digest);
        CHECK(r.log_ratio->value >= 0);
    }
    // Those who came farthest stand first.
    CHECK(race.dropped.front().name == "slow");
}

TEST_CASE("All that is exact starts in a race, and every engine") {
    std::vector<racer> all = aabblab::starters(scene);
    CHECK(all.front().name == "auto");
    for (const char* name : {"bucket + columns + simd", "insertion + none + incremental", "std + uniform_grid + simd"})
        CHECK(holds(all, name));
    CHECK_FALSE(holds(all, "split_mesh + bucket + columns + simd"));
    for (const aabb::engine_info& engine : aabb::engines()) CHECK(holds(all, engine.name) == engine.searches_boxes);
    const aabblab::scene_choice meshes{"mesh_pair", {}, {"icosphere:triangles=80"}, 1, {}};
    all = aabblab::starters(meshes);
    for (const char* name :
         {"bucket + columns + simd + sah + implicit + exact", "bucket + columns + simd + canonical + exact"})
        CHECK(holds(all, name));
    CHECK_FALSE(holds(all, "bucket + columns + simd + canonical + moller"));
    for (const aabb::engine_info& engine : aabb::engines())
        if (engine.collides_meshes)
            CHECK(std::ranges::any_of(all, [&](const racer& r) { return r.name.starts_with(engine.name); }));
}

TEST_CASE("recommend ranks, says what to use, and writes a page") {
    const temporary_folder folder;
    const std::string file = (folder / "p.aabbs").string();
    const std::string page = (folder / "p.html").string();
    REQUIRE(run_program({"scene", "pile", "--n", "300", "--frames", "8", "--out", file}).status == 0);
    const program_result told = run_program({"recommend", file, "--seconds", "1", "--report", page});
    REQUIRE(told.status == 0);
    CHECK(told.out.find("\nUse ") != std::string::npos);
    CHECK(told.out.find("300 objects, 9 frames\n") != std::string::npos);
    CHECK(told.out.find("finds other pairs") == std::string::npos);
    std::ifstream in(page);
    const std::string html{std::istreambuf_iterator<char>(in), {}};
    for (const char* part : {"<p>Use ", "overlapping pairs an object", "dropped", "all_axes"})
        CHECK(html.find(part) != std::string::npos);
    CHECK(run_program({"recommend", file, "--seconds", "0"}).err.find("--seconds is how long to race") !=
          std::string::npos);
    CHECK(run_program({"recommend", file, "--report", file}).status == 2);
    CHECK(run_program({"recommend", (folder / "none.aabbs").string()}).status == 2);
}
