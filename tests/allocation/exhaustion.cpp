// Memory that runs out at any allocation, in every stage there is: afterwards a stage is exact or refuses.

#include "../boxes.hpp"
#include "../compositions.hpp"
#include "../meshes.hpp"
#include "counted_new.hpp"

import aabb.validation;

using namespace aabb;

// FCL itself loses the nodes of a tree that it could not finish, ODE a space that it has locked.
extern "C" const char* __lsan_default_suppressions() {  // NOLINT(readability-identifier-naming)
    return "leak:libfcl\nleak:libode";
}

namespace {

/// The library itself keeps some memory for good, once it had too little.
bool loses_memory(const std::string& engine) {
    return engine == "fcl" || engine == "ode_hash";
}

/// The library itself goes on with what it left half-made, in whatever is asked of it afterwards, or ends the process.
bool breaks_for_good(const std::string& engine) {
    return engine.starts_with("embree");
}

/// One run of a stage in which one allocation fails, and what came of it.
class exhausted_run {
public:
    /// @param fails_in which allocation fails, from 1
    explicit exhausted_run(std::size_t fails_in) : left_(fails_in) {}

    /// Makes a call with memory as short as it is; says whether it succeeded.
    template <class Call>
    bool attempt(Call call) {
        allocations.fails_in = left_;
        bool succeeded = false;
        try {
            call();
            succeeded = true;
        } catch (const std::bad_alloc&) {
            failed_ = true;
        } catch (const input_error&) {
            refused_ = true;
        }
        left_ = std::exchange(allocations.fails_in, 0);
        return succeeded;
    }

    /// The same, and once more when memory ran out.
    template <class Call>
    bool insist(Call call) {
        return attempt(call) || (!refused_ && attempt(call));
    }

    [[nodiscard]] bool failed() const { return failed_; }
    [[nodiscard]] bool rejected() const { return refused_; }
    void forget_refusal() { refused_ = false; }

private:
    std::size_t left_;
    bool failed_ = false;
    bool refused_ = false;
};

constexpr index_pair mark{7, 7};  // stands in a list before a call, and must still stand there alone when it has failed

std::vector<index_pair> sorted_behind_mark(std::vector<index_pair> pairs) {
    std::sort(pairs.begin() + 1, pairs.end());
    return pairs;
}

constexpr std::uint32_t objects = 24;

/// Boxes that move, some of them long, and who is present; the first of all, later some come and go.
struct frame {
    std::vector<box> boxes;
    std::vector<bool> present;
    std::vector<index_pair> pairs;  // behind the mark
};

std::vector<frame> frames() {
    std::vector<frame> all;
    for (std::uint32_t f = 0; f < 5; ++f) {
        // More boxes in a later frame, as the pieces of a split must give way to them.
        const std::uint32_t n = f < 3 ? objects : objects + 4;
        frame made{{}, {}, {mark}};
        for (std::uint32_t i = 0; i < n; ++i) {
            const vec3f at{static_cast<float>((i * 7 + f * 5) % 24), static_cast<float>((i * 11 + f * (i % 3)) % 19),
                           static_cast<float>(i * 5 % 17)};
            const float edge = i % 8 == f ? 14.0F : 3.0F;
            made.boxes.push_back({at, at + vec3f{edge, 3, 3}});
            made.present.push_back(f == 0 || (i + f) % 4 != 0);
        }
        const std::vector<index_pair> pairs = overlapping(made.boxes, made.present);
        made.pairs.insert(made.pairs.end(), pairs.begin(), pairs.end());
        all.push_back(made);
    }
    return all;
}

/// Plays all frames while one allocation fails; says what is wrong then, nothing when all is well.
std::string fault_of(global_stage& stage, const std::vector<frame>& frames, exhausted_run& run) {
    std::vector<bool> present(objects + 4);
    for (const frame& now : frames) {
        for (std::uint32_t id = 0; id < now.boxes.size(); ++id) {
            if (present[id] == now.present[id]) continue;
            if (!run.insist([&] { now.present[id] ? stage.insert(id) : stage.remove(id); }))
                return run.attempt([&] { stage.update(now.boxes); }) ? "goes on without an object" : "";
            present[id] = now.present[id];
        }
        const bool updated = run.attempt([&] { stage.update(now.boxes); });
        std::vector<index_pair> pairs{mark};
        if (updated) {
            if (run.attempt([&] { stage.search(pairs); })) {
                if (sorted_behind_mark(pairs) != now.pairs) return "wrong pairs";
                continue;
            }
            if (run.rejected()) return "refuses a frame that it has taken";
            if (pairs != std::vector{mark}) return "pairs of a search that failed";
            if (!run.attempt([&] { stage.search(pairs); })) return "no search after one that failed";
            if (sorted_behind_mark(pairs) != now.pairs) return "wrong pairs after a search that failed";
        } else {
            if (run.attempt([&] { stage.search(pairs); })) return "a search after an update that failed";
            run.forget_refusal();
            if (!run.insist([&] { stage.update(now.boxes); })) return {};
            if (!run.insist([&] { stage.search(pairs); })) return "no search after an update";
            if (sorted_behind_mark(pairs) != now.pairs) return "wrong pairs after an update that failed";
        }
    }
    return {};
}

/// With sanitizers, which take their time, not every allocation fails, but ever fewer of the later ones.
/// @param each false for the same without them
std::size_t next_to_fail(std::size_t k, bool each = true) {
#if __has_feature(address_sanitizer)
    each = false;
#endif
    return each ? k + 1 : k + 1 + k / 4;
}

/// Lets each allocation of a stage's life fail in turn.
/// @param life is made, played and ended, and says what is wrong then, nothing when all is well
/// @param each every allocation fails in turn, else ever fewer of the later ones
template <class Life>
void require_exact_or_refusing(Life life, bool frees_all, bool each = true) {
    for (std::size_t k = 1;; k = next_to_fail(k, each)) {
        exhausted_run run(k);
        const std::size_t before = allocations.alive;
        std::string fault = life(run);
        if (fault.empty() && frees_all && allocations.alive != before) fault = "memory that is not given back";
        INFO("allocation " << k);
        REQUIRE(fault == "");
        if (run.failed()) continue;
        REQUIRE(k > 3);
        REQUIRE_FALSE(run.rejected());
        return;
    }
}

template <class Make>
void require_of_search(Make make, bool frees_all) {
    const std::vector<frame> all = frames();
    const auto life = [&](exhausted_run& run) { return fault_of(*make(), all, run); };
    // What a library keeps for the whole process, as TBB does its threads, is there afterwards.
    exhausted_run whole(0);
    REQUIRE(life(whole) == "");
    require_exact_or_refusing(life, frees_all);
}

/// Squares on a side of a sheet.
constexpr std::uint32_t few_squares = 3;
constexpr std::uint32_t squares_for_fronts = 12;  // which are kept of no fewer leaves

/// A sheet with waves, of which some cross the others.
mesh sheet(float height, std::uint32_t squares = few_squares) {
    return sheet_of(squares, [&](std::uint32_t i, std::uint32_t j) -> vec3f {
        return {static_cast<float>(i), static_cast<float>(j), (i + j) % 2 == 0 ? height : -height};
    });
}

const pose moved = shifted({0.3, 0.2, 0.1});

/// What all queries say of a model and itself, moved, behind marks.
struct answers {
    std::vector<index_pair> all{mark};
    std::vector<index_pair> self{mark};
    std::uint64_t count = 0;
    bool any = false;

    friend bool operator==(const answers&, const answers&) = default;
};

answers ask(local_stage& stage) {
    answers given;
    stage.all_pairs(0, {}, 0, moved, given.all);
    stage.self_pairs(0, given.self);
    given.count = stage.count_pairs(0, {}, 0, moved);
    given.any = stage.first_pair(0, {}, 0, moved).has_value();
    given.all = sorted_behind_mark(given.all);
    given.self = sorted_behind_mark(given.self);
    return given;
}

/// The same while memory may run out; nothing where a query refused.
std::optional<answers> ask(local_stage& stage, exhausted_run& run, std::string& fault) {
    answers given;
    for (const bool self : {false, true}) {
        std::vector<index_pair>& pairs = self ? given.self : given.all;
        const auto query = [&] { self ? stage.self_pairs(0, pairs) : stage.all_pairs(0, {}, 0, moved, pairs); };
        if (!run.attempt(query)) {
            if (pairs != std::vector{mark}) fault = "pairs of a query that failed";
            if (run.rejected() || !run.attempt(query)) return std::nullopt;
        }
        pairs = sorted_behind_mark(pairs);
    }
    if (!run.insist([&] { given.count = stage.count_pairs(0, {}, 0, moved); })) return std::nullopt;
    if (!run.insist([&] { given.any = stage.first_pair(0, {}, 0, moved).has_value(); })) return std::nullopt;
    return given;
}

std::string fault_of(local_stage& stage, mesh& m, std::uint32_t squares, const std::vector<answers>& expected,
                     exhausted_run& run) {
    std::string fault;
    m = sheet(0.1F, squares);
    if (!run.insist([&] { stage.add_model(m); })) return "no model after one that failed";
    if (ask(stage, run, fault) != expected[0]) return "wrong pairs";
    if (ask(stage, run, fault) != expected[0]) return "wrong pairs once they were asked for";
    m = numbered_backwards(sheet(3, squares));
    if (!run.attempt([&] { stage.refit(0); })) {
        if (ask(stage, run, fault)) return "a query after a refit that failed";
        run.forget_refusal();
        if (!run.attempt([&] { stage.refit(0); })) return "no refit after one that failed";
    }
    if (ask(stage, run, fault) != expected[1]) return "wrong pairs of a mesh that has deformed";
    return fault;
}

template <class Make>
void require_of_detection(Make make, bool frees_all, std::uint32_t squares = few_squares, bool each = true) {
    std::vector<answers> expected;
    for (const float height : {0.1F, 3.0F}) {
        const mesh m = sheet(height, squares);
        const std::unique_ptr<local_stage> stage = make();
        stage->add_model(m);
        expected.push_back(ask(*stage));
        REQUIRE(expected.back().all.size() > 10);
    }
    REQUIRE(expected[0] != expected[1]);
    const auto life = [&](exhausted_run& run) {
        mesh m = sheet(3, squares);
        return fault_of(*make(), m, squares, expected, run);
    };
    require_exact_or_refusing(life, frees_all, each);
}

}  // namespace

TEST_CASE("a composed global search that runs out of memory is exact afterwards, or refuses", "[long]") {
    for (const aabb::composition& composition : global_compositions()) {
        INFO(text_of_global(composition));
        require_of_search([&] { return global_of(composition, instrumentation::counters); }, true);
    }
}

TEST_CASE("an engine for boxes that runs out of memory is exact afterwards, or refuses") {
    for (const engine_info& engine : engines()) {
        if (!engine.searches_boxes || breaks_for_good(engine.name)) continue;
        INFO(engine.name);
        require_of_search([&] { return make_box_engine(engine.name); }, !loses_memory(engine.name));
    }
}

TEST_CASE("a composed local detection that runs out of memory is exact afterwards, or refuses", "[long]") {
    for (const aabb::composition& composition : local_compositions()) {
        INFO(text_of_local(composition));
        // A triangle test takes no memory, so one is tried with every allocation.
        require_of_detection([&] { return local_of(composition, instrumentation::none); }, true,
                             keeps_fronts(composition) ? squares_for_fronts : few_squares,
                             composition[strategy_kind::triangle].name == "exact");
    }
}

TEST_CASE("an engine for meshes that runs out of memory is exact afterwards, or refuses") {
    for (const engine_info& engine : engines()) {
        if (!engine.collides_meshes || breaks_for_good(engine.name)) continue;
        INFO(engine.name);
        require_of_detection([&] { return make_mesh_engine(engine.name); }, engine.name != "fcl");
    }
}

TEST_CASE("a model is not asked before it fits its mesh again") {
    const auto rejects = [](local_stage& stage) {
        mesh m = sheet(0.1F);
        stage.add_model(m);
        m.vertices = sheet(3).vertices;
        const float good = std::exchange(m.vertices[0][0], std::numeric_limits<float>::quiet_NaN());
        CHECK_THROWS_AS(stage.refit(0), input_error);
        CHECK_THROWS_AS(ask(stage), input_error);
        m.vertices[0][0] = good;
        stage.refit(0);
        CHECK(ask(stage).any);
    };
    for (const aabb::composition& composition : local_compositions())
        rejects(*local_of(composition, instrumentation::none));
    for (const engine_info& engine : engines())
        if (engine.collides_meshes) rejects(*make_mesh_engine(engine.name));
}
