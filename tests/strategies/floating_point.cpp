#include <xmmintrin.h>
#include <cfenv>

#include "../compositions.hpp"
#include "../meshes.hpp"

namespace {

/// Bits of SSE's control register: denormal results become zero, denormal operands count as zero.
constexpr unsigned flush_to_zero = 1U << 15;
constexpr unsigned denormals_are_zero = 1U << 6;

/// Changes this thread's floating-point environment while it lives.
class changed_environment {
public:
    changed_environment(unsigned control_bits, int rounding) {
        std::fesetround(rounding);
        _mm_setcsr(_mm_getcsr() | control_bits);
    }
    changed_environment(const changed_environment&) = delete;
    changed_environment& operator=(const changed_environment&) = delete;
    ~changed_environment() { std::fesetenv(&before_); }

private:
    std::fenv_t before_ = [] {
        std::fenv_t now;
        std::fegetenv(&now);
        return now;
    }();
};

/// The sentence in which a query is rejected in this environment.
std::string rejection_in(unsigned control_bits, int rounding, const std::function<void()>& query) {
    const changed_environment environment(control_bits, rounding);
    return refusal_in<aabb::input_error>(query);
}

}  // namespace

// tests/validation/extreme_scenes.cpp runs every query of every stage in two of these environments.
TEST_CASE("arithmetic in which results cannot be exact is rejected") {
    const std::vector<aabb::box> boxes{{{0, 0, 0}, {1, 1, 1}}};
    const auto search = global_of({});
    search->insert(0);
    search->update(boxes);
    const auto triangles = aabb::make_triangle_test({"exact", {}});
    const auto local = local_of({});
    const manual_scene scene({tetrahedron(1)}, {0});
    const auto global = global_of({});
    aabb::pipeline stages(scene, *global, *local);
    const std::vector<aabb::pose> poses(1);
    std::vector<aabb::index_pair> pairs;
    const std::vector<std::pair<std::string, std::function<void()>>> entries{
        {"update", [&] { search->update(boxes); }},
        {"search", [&] { search->search(pairs); }},
        {"triangles of floats", [&] { static_cast<void>(triangles->intersects(aabb::triangle3f{}, {})); }},
        {"triangles of doubles", [&] { static_cast<void>(triangles->intersects(aabb::triangle3d{}, {})); }},
        {"pipeline", [&] { stages.update(poses); }}};
    for (const auto& [name, query] : entries) {
        CAPTURE(name);
        CHECK(rejection_in(0, FE_TONEAREST, query) == "accepted");
        for (const unsigned bits : {flush_to_zero, denormals_are_zero, flush_to_zero | denormals_are_zero})
            CHECK_THAT(rejection_in(bits, FE_TONEAREST, query),
                       Catch::Matchers::ContainsSubstring("flushes denormal numbers to zero"));
        for (const int rounding : {FE_UPWARD, FE_DOWNWARD, FE_TOWARDZERO})
            CHECK_THAT(rejection_in(0, rounding, query),
                       Catch::Matchers::ContainsSubstring("does not round to nearest"));
        CHECK(rejection_in(0, FE_TONEAREST, query) == "accepted");
    }
}
