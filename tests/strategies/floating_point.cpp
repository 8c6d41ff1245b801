#include <xmmintrin.h>
#include <cfenv>

#include "../compositions.hpp"
#include "../meshes.hpp"

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

/// What the query says in another arithmetic.
std::string sentence(unsigned control_bits, int rounding, const std::function<void()>& query) {
    const arithmetic other(control_bits, rounding);
    return refusal_in<aabb::input_error>(query);
}

}  // namespace

// tests/validation/extreme_scenes.cpp has every query of every stage, in two of these.
TEST_CASE("arithmetic in which answers cannot be exact is refused, whatever is wrong with it") {
    const std::vector<aabb::box> boxes{{{0, 0, 0}, {1, 1, 1}}};
    const auto search = global_of({});
    search->insert(0);
    search->update(boxes);
    const auto triangles = aabb::make_triangle_test({"exact", {}});
    const auto local = local_of({});
    const told_scene scene({tetrahedron(1)}, {0});
    const auto pieces = global_of({});
    aabb::pipeline both(scene, *pieces, *local);
    const std::vector<aabb::pose> poses(1);
    std::vector<aabb::index_pair> pairs;
    const std::vector<std::pair<std::string, std::function<void()>>> entries{
        {"update", [&] { search->update(boxes); }},
        {"search", [&] { search->search(pairs); }},
        {"triangles of floats", [&] { static_cast<void>(triangles->intersects(aabb::triangle3f{}, {})); }},
        {"triangles of doubles", [&] { static_cast<void>(triangles->intersects(aabb::triangle3d{}, {})); }},
        {"pipeline", [&] { both.update(poses); }}};
    for (const auto& [name, query] : entries) {
        CAPTURE(name);
        CHECK(sentence(0, FE_TONEAREST, query) == "accepted");
        for (const unsigned bits : {flush_to_zero, denormals_are_zero, flush_to_zero | denormals_are_zero})
            CHECK_THAT(sentence(bits, FE_TONEAREST, query),
                       Catch::Matchers::ContainsSubstring("flushes denormal numbers to zero"));
        for (const int rounding : {FE_UPWARD, FE_DOWNWARD, FE_TOWARDZERO})
            CHECK_THAT(sentence(0, rounding, query), Catch::Matchers::ContainsSubstring("does not round to nearest"));
        CHECK(sentence(0, FE_TONEAREST, query) == "accepted");
    }
}
