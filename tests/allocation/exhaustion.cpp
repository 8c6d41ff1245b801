// Memory runs out at any allocation, in every stage: afterwards the stage is exact or rejects calls.

#include "../boxes.hpp"
#include "../compositions.hpp"
#include "../meshes.hpp"
#include "counted_new.hpp"

import aabb.validation;

using namespace aabb;

// FCL itself leaks the nodes of a tree that it could not finish, ODE a space that it has locked.
extern "C" const char* __lsan_default_suppressions() {  // NOLINT(readability-identifier-naming)
    return "leak:libfcl\nleak:libode";
}

namespace {

/// The library itself leaks some memory after a failed allocation.
bool leaks_memory(const std::string& engine) {
    return engine == "fcl" || engine == "ode_hash";
}

/// The library itself goes on with unfinished data in later calls, or ends the process.
bool breaks_permanently(const std::string& engine) {
    return engine.starts_with("embree");
}

/// One run of a stage in which one allocation fails, and its outcome.
class exhausted_run {
public:
    /// @param fails_in which allocation fails, from 1
    explicit exhausted_run(std::size_t fails_in) : left_(fails_in) {}

    /// Makes a call in which the allocation may fail; returns whether the call succeeded.
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
            rejected_ = true;
        }
        left_ = std::exchange(allocations.fails_in, 0);
        return succeeded;
    }

    /// Makes a call, and once more if memory ran out.
    template <class Call>
    bool attempt_twice(Call call) {
        return attempt(call) || (!rejected_ && attempt(call));
    }

    [[nodiscard]] bool failed() const { return failed_; }
    [[nodiscard]] bool rejected() const { return rejected_; }
    void forget_rejection() { rejected_ = false; }

private:
    std::size_t left_;
    bool failed_ = false;
    bool rejected_ = false;
};

constexpr index_pair mark{7, 7};  // in a list before a call, and still its only pair after one that failed

std::vector<index_pair> sorted_after_mark(std::vector<index_pair> pairs) {
    std::sort(pairs.begin() + 1, pairs.end());
    return pairs;
}

constexpr std::uint32_t objects = 24;

/// Moving boxes, some of them long, and which are present: all in the first frame, later some come and go.
struct frame {
    std::vector<box> boxes;
    std::vector<bool> present;
    std::vector<index_pair> pairs;  // after the mark
};

std::vector<frame> frames() {
    std::vector<frame> result;
    for (std::uint32_t f = 0; f < 5; ++f) {
        // More boxes in a later frame, as the pieces of a split must give way to them.
        const std::uint32_t n = f < 3 ? objects : objects + 4;
        frame current{{}, {}, {mark}};
        for (std::uint32_t i = 0; i < n; ++i) {
            const vec3f at{static_cast<float>((i * 7 + f * 5) % 24), static_cast<float>((i * 11 + f * (i % 3)) % 19),
                           static_cast<float>(i * 5 % 17)};
            const float edge = i % 8 == f ? 14.0F : 3.0F;
            current.boxes.push_back({at, at + vec3f{edge, 3, 3}});
            current.present.push_back(f == 0 || (i + f) % 4 != 0);
        }
        const std::vector<index_pair> pairs = overlapping(current.boxes, current.present);
        current.pairs.insert(current.pairs.end(), pairs.begin(), pairs.end());
        result.push_back(current);
    }
    return result;
}

/// Runs all frames while one allocation fails; returns the fault, empty if there is none.
std::string fault_of(global_stage& stage, const std::vector<frame>& frames, exhausted_run& run) {
    std::vector<bool> present(objects + 4);
    for (const frame& current : frames) {
        for (std::uint32_t id = 0; id < current.boxes.size(); ++id) {
            if (present[id] == current.present[id]) continue;
            if (!run.attempt_twice([&] { current.present[id] ? stage.insert(id) : stage.remove(id); }))
                return run.attempt([&] { stage.update(current.boxes); }) ? "goes on without an object" : "";
            present[id] = current.present[id];
        }
        const bool updated = run.attempt([&] { stage.update(current.boxes); });
        std::vector<index_pair> pairs{mark};
        if (updated) {
            if (run.attempt([&] { stage.search(pairs); })) {
                if (sorted_after_mark(pairs) != current.pairs) return "wrong pairs";
                continue;
            }
            if (run.rejected()) return "rejects a frame that it has accepted";
            if (pairs != std::vector{mark}) return "pairs of a search that failed";
            if (!run.attempt([&] { stage.search(pairs); })) return "no search after one that failed";
            if (sorted_after_mark(pairs) != current.pairs) return "wrong pairs after a search that failed";
        } else {
            if (run.attempt([&] { stage.search(pairs); })) return "a search after an update that failed";
            run.forget_rejection();
            if (!run.attempt_twice([&] { stage.update(current.boxes); })) return {};
            if (!run.attempt_twice([&] { stage.search(pairs); })) return "no search after an update";
            if (sorted_after_mark(pairs) != current.pairs) return "wrong pairs after an update that failed";
        }
    }
    return {};
}

/// With sanitizers, which are slow, not every allocation fails, but ever fewer of the later ones.
/// @param each false for the same without sanitizers
std::size_t next_to_fail(std::size_t k, bool each = true) {
#if __has_feature(address_sanitizer)
    each = false;
#endif
    return each ? k + 1 : k + 1 + k / 4;
}

/// Lets each allocation of a stage's life fail in turn.
/// @param life constructs, runs and destroys a stage, and returns the fault, empty if there is none
/// @param each every allocation fails in turn, else ever fewer of the later ones
template <class Life>
void require_exact_or_rejecting(Life life, bool frees_all, bool each = true) {
    for (std::size_t k = 1;; k = next_to_fail(k, each)) {
        exhausted_run run(k);
        const std::size_t before = allocations.alive;
        std::string fault = life(run);
        if (fault.empty() && frees_all && allocations.alive != before) fault = "memory that is not freed";
        INFO("allocation " << k);
        REQUIRE(fault == "");
        if (run.failed()) continue;
        REQUIRE(k > 3);
        REQUIRE_FALSE(run.rejected());
        return;
    }
}

template <class Make>
void require_exact_search(Make make, const std::vector<frame>& all_frames, bool frees_all) {
    const auto life = [&](exhausted_run& run) { return fault_of(*make(), all_frames, run); };
    // Afterwards libraries have allocated what they keep for the whole process, as TBB keeps its threads.
    exhausted_run first_run(0);
    REQUIRE(life(first_run) == "");
    require_exact_or_rejecting(life, frees_all);
}

/// Squares along a side of a sheet.
constexpr std::uint32_t few_squares = 3;
constexpr std::uint32_t squares_for_fronts = 12;  // which need this many to have enough leaves

/// A wavy sheet, which intersects its moved copy.
mesh sheet(float height, std::uint32_t squares = few_squares) {
    return sheet_of(squares, [&](std::uint32_t i, std::uint32_t j) -> vec3f {
        return {static_cast<float>(i), static_cast<float>(j), (i + j) % 2 == 0 ? height : -height};
    });
}

const pose moved = shifted({0.3, 0.2, 0.1});

/// The results of all queries of a model and its moved copy, after marks.
struct query_results {
    std::vector<index_pair> all_pairs{mark};
    std::vector<index_pair> self{mark};
    std::uint64_t count = 0;
    bool any = false;

    friend bool operator==(const query_results&, const query_results&) = default;
};

query_results run_queries(local_stage& stage) {
    query_results results;
    stage.all_pairs(0, {}, 0, moved, results.all_pairs);
    stage.self_pairs(0, results.self);
    results.count = stage.count_pairs(0, {}, 0, moved);
    results.any = stage.first_pair(0, {}, 0, moved).has_value();
    results.all_pairs = sorted_after_mark(results.all_pairs);
    results.self = sorted_after_mark(results.self);
    return results;
}

/// The same while memory may run out; nothing if a query was rejected.
std::optional<query_results> run_queries(local_stage& stage, exhausted_run& run, std::string& fault) {
    query_results results;
    for (const bool self : {false, true}) {
        std::vector<index_pair>& pairs = self ? results.self : results.all_pairs;
        const auto query = [&] { self ? stage.self_pairs(0, pairs) : stage.all_pairs(0, {}, 0, moved, pairs); };
        if (!run.attempt(query)) {
            if (pairs != std::vector{mark}) fault = "pairs of a query that failed";
            if (run.rejected() || !run.attempt(query)) return std::nullopt;
        }
        pairs = sorted_after_mark(pairs);
    }
    if (!run.attempt_twice([&] { results.count = stage.count_pairs(0, {}, 0, moved); })) return std::nullopt;
    if (!run.attempt_twice([&] { results.any = stage.first_pair(0, {}, 0, moved).has_value(); })) return std::nullopt;
    return results;
}

std::string fault_of(local_stage& stage, mesh& m, std::uint32_t squares, const std::vector<query_results>& expected,
                     exhausted_run& run) {
    std::string fault;
    m = sheet(0.1F, squares);
    if (!run.attempt_twice([&] { stage.add_model(m); })) return "no model after one that failed";
    if (run_queries(stage, run, fault) != expected[0]) return "wrong pairs";
    if (run_queries(stage, run, fault) != expected[0]) return "wrong pairs in a repeated query";
    m = numbered_backwards(sheet(3, squares));
    if (!run.attempt([&] { stage.refit(0); })) {
        if (run_queries(stage, run, fault)) return "a query after a refit that failed";
        run.forget_rejection();
        if (!run.attempt([&] { stage.refit(0); })) return "no refit after one that failed";
    }
    if (run_queries(stage, run, fault) != expected[1]) return "wrong pairs of a mesh that has deformed";
    return fault;
}

template <class Make>
void require_exact_detection(Make make, bool frees_all, std::uint32_t squares = few_squares, bool each = true) {
    std::vector<query_results> expected;
    for (const float height : {0.1F, 3.0F}) {
        const mesh m = sheet(height, squares);
        const std::unique_ptr<local_stage> stage = make();
        stage->add_model(m);
        expected.push_back(run_queries(*stage));
        REQUIRE(expected.back().all_pairs.size() > 10);
    }
    REQUIRE(expected[0] != expected[1]);
    const auto life = [&](exhausted_run& run) {
        mesh m = sheet(3, squares);
        return fault_of(*make(), m, squares, expected, run);
    };
    require_exact_or_rejecting(life, frees_all, each);
}

}  // namespace

TEST_CASE("a composed global search that runs out of memory is exact afterwards, or rejects calls", "[long]") {
    for (const aabb::composition& composition : global_compositions()) {
        INFO(text_of_global(composition));
        require_exact_search([&] { return global_of(composition, instrumentation::counters); }, frames(), true);
    }
}

TEST_CASE("a filtered search that runs out of memory is exact afterwards, or rejects calls") {
    // An index of those that rest, and a join of sets, are worth it at once.
    cost_model costs;
    costs.refit_box = costs.open_node = 1e-9;
    set_machine_costs(costs);
    for (const bool has_sets : {false, true}) {
        collision_filter filter;
        std::vector<frame> filtered_frames = frames();
        for (std::uint32_t id = 0; id < objects + 4; ++id) {
            if (has_sets)
                filter.set(id, {.set = id % 3 == 0 ? object_set::a : object_set::b});
            else if (id % 4 != 0)
                filter.set(id, {.rests = true});
            for (frame& later : filtered_frames)
                if (filter[id].rests && id < objects) later.boxes[id] = filtered_frames[0].boxes[id];
        }
        for (frame& current : filtered_frames) {
            current.pairs = {mark};
            for (const index_pair p : overlapping(current.boxes, current.present))
                if (filter.keeps(p.a, p.b)) current.pairs.push_back(p);
        }
        require_exact_search([&] { return filtered(global_of({}), filter, instrumentation::counters); },
                             filtered_frames, true);
    }
    set_machine_costs({});
}

TEST_CASE("an engine for boxes that runs out of memory is exact afterwards, or rejects calls") {
    for (const engine_info& engine : engines()) {
        if (!engine.searches_boxes || breaks_permanently(engine.name)) continue;
        INFO(engine.name);
        require_exact_search([&] { return make_box_engine(engine.name); }, frames(), !leaks_memory(engine.name));
    }
}

TEST_CASE("a composed local detection that runs out of memory is exact afterwards, or rejects calls", "[long]") {
    for (const aabb::composition& composition : local_compositions()) {
        INFO(text_of_local(composition));
        // A triangle test takes no memory, so only one is run with every allocation.
        require_exact_detection([&] { return local_of(composition, instrumentation::none); }, true,
                                keeps_fronts(composition) ? squares_for_fronts : few_squares,
                                composition[strategy_kind::triangle].name == "exact");
    }
}

TEST_CASE("an engine for meshes that runs out of memory is exact afterwards, or rejects calls") {
    for (const engine_info& engine : engines()) {
        if (!engine.collides_meshes || breaks_permanently(engine.name)) continue;
        INFO(engine.name);
        // CGAL's exact numbers allocate, each of them, so that not every allocation is tried.
        require_exact_detection([&] { return make_mesh_engine(engine.name); }, engine.name != "fcl", few_squares,
                                /*each=*/!engine.exact);
    }
}

TEST_CASE("a model rejects queries from a failed refit until the next refit") {
    const auto rejects = [](local_stage& stage) {
        mesh m = sheet(0.1F);
        stage.add_model(m);
        m.vertices = sheet(3).vertices;
        const float good = std::exchange(m.vertices[0][0], std::numeric_limits<float>::quiet_NaN());
        CHECK_THROWS_AS(stage.refit(0), input_error);
        CHECK_THROWS_AS(run_queries(stage), input_error);
        m.vertices[0][0] = good;
        stage.refit(0);
        CHECK(run_queries(stage).any);
    };
    for (const aabb::composition& composition : local_compositions())
        rejects(*local_of(composition, instrumentation::none));
    for (const engine_info& engine : engines())
        if (engine.collides_meshes) rejects(*make_mesh_engine(engine.name));
}
