#include <xmmintrin.h>
#include <cfenv>

#include "../compositions.hpp"
#include "../meshes.hpp"

using aabb::input_error;

namespace {

/// Of SSE's control register: results that are denormal become zero, operands that are denormal count as zero.
constexpr unsigned flush_to_zero = 1U << 15;
constexpr unsigned denormals_are_zero = 1U << 6;

/// Another arithmetic for this thread, while it lives.
class arithmetic {
public:
    arithmetic(unsigned control_bits, int rounding) {
        std::fesetround(rounding);
        _mm_setcsr(_mm_getcsr() | control_bits);
    }
    arithmetic(const arithmetic&) = delete;
    arithmetic& operator=(const arithmetic&) = delete;
    ~arithmetic() { std::fesetenv(&before_); }

private:
    std::fenv_t before_ = [] {
        std::fenv_t now;
        std::fegetenv(&now);
        return now;
    }();
};

/// What the query says in another arithmetic; nothing where it answers.
std::string sentence(unsigned control_bits, int rounding, const std::function<void()>& query) {
    const arithmetic other(control_bits, rounding);
    try {
        query();
    } catch (const input_error& error) {
        return error.what();
    }
    return {};
}

}  // namespace

TEST_CASE("every query refuses arithmetic in which answers cannot be exact") {
    const aabb::mesh mesh = tetrahedron(1);
    const std::vector<aabb::box> boxes{{{0, 0, 0}, {1, 1, 1}}};
    using enum aabb::strategy_kind;
    const auto listed = global_of(composed({{sort, "std"}}));
    const auto kept = global_of(composed({{sort, "insertion"}, {sweep, "incremental"}}));
    const auto in_columns = global_of(composed({{partition, "columns"}}));
    for (const auto& search : {listed.get(), kept.get(), in_columns.get()}) {
        search->insert(0);
        search->update(boxes);
    }
    const auto local = aabb::compose_local_detection(aabb::composition{}, aabb::instrumentation::none);
    REQUIRE(local->add_model(mesh) == 0);
    const auto triangles = aabb::make_triangle_test({"exact", {}});
    const auto in_pipeline = aabb::compose_local_detection(aabb::composition{}, aabb::instrumentation::none);
    const auto pieces = aabb::compose_global_search(aabb::composition{}, aabb::instrumentation::none);
    const told_scene scene({mesh}, {0});
    aabb::pipeline both(scene, *pieces, *in_pipeline);
    const std::vector<aabb::pose> poses(1);
    std::vector<aabb::index_pair> pairs;
    const std::vector<std::pair<std::string, std::function<void()>>> entries{
        {"update", [&] { listed->update(boxes); }},
        {"search", [&] { listed->search(pairs); }},
        {"update of a coherent sweep", [&] { kept->update(boxes); }},
        {"search of a coherent sweep", [&] { kept->search(pairs); }},
        {"update of columns", [&] { in_columns->update(boxes); }},
        {"search of columns", [&] { in_columns->search(pairs); }},
        {"add_model", [&] { local->add_model(mesh); }},
        {"refit", [&] { local->refit(0); }},
        {"all_pairs", [&] { local->all_pairs(0, {}, 0, {}, pairs); }},
        {"first_pair", [&] { static_cast<void>(local->first_pair(0, {}, 0, {})); }},
        {"count_pairs", [&] { static_cast<void>(local->count_pairs(0, {}, 0, {})); }},
        {"self_pairs", [&] { local->self_pairs(0, pairs); }},
        {"triangles of floats", [&] { static_cast<void>(triangles->intersects(aabb::triangle3f{}, {})); }},
        {"triangles of doubles", [&] { static_cast<void>(triangles->intersects(aabb::triangle3d{}, {})); }},
        {"pipeline", [&] { both.update(poses); }}};
    for (const auto& [name, query] : entries) {
        CAPTURE(name);
        CHECK(sentence(0, FE_TONEAREST, query).empty());
        for (const unsigned bits : {flush_to_zero, denormals_are_zero, flush_to_zero | denormals_are_zero})
            CHECK_THAT(sentence(bits, FE_TONEAREST, query),
                       Catch::Matchers::ContainsSubstring("flushes denormal numbers to zero"));
        for (const int rounding : {FE_UPWARD, FE_DOWNWARD, FE_TOWARDZERO})
            CHECK_THAT(sentence(0, rounding, query), Catch::Matchers::ContainsSubstring("does not round to nearest"));
        CHECK(sentence(0, FE_TONEAREST, query).empty());
    }
}
