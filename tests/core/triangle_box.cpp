#include "../random_poses.hpp"

import aabb.triangle.exact;

using namespace aabb;

namespace {

float any_number(float size) {
    return static_cast<float>(uniform(-1, 1)) * size;
}

/// A box of up to this size on each axis, at this offset from the origin.
box any_box(const vec3f& size, const vec3f& offset) {
    box b = empty_box();
    for (int i = 0; i < 2; ++i)
        b = merged(b, bounds_of(offset + vec3f{any_number(size[0]), any_number(size[1]), any_number(size[2])}));
    return b;
}

vec3f corner(const box& b, unsigned which) {
    return {which & 1 ? b.max[0] : b.min[0], which & 2 ? b.max[1] : b.min[1], which & 4 ? b.max[2] : b.min[2]};
}

/// Decided exactly: a corner of the triangle lies in the box, or the triangle intersects one of the box's faces.
bool exactly_intersects(const triangle3f& t, const box& b) {
    for (int i = 0; i < 3; ++i)
        if (contains(b, bounds_of(t[i]))) return true;
    constexpr std::array<std::array<unsigned, 4>, 6> faces = {
        {{0, 1, 3, 2}, {4, 5, 7, 6}, {0, 1, 5, 4}, {2, 3, 7, 6}, {0, 2, 6, 4}, {1, 3, 7, 5}}};
    for (const auto& f : faces)
        for (const std::size_t second : {1U, 2U})
            if (exact_triangle::intersects(t, {{corner(b, f[0]), corner(b, f[second]), corner(b, f[second + 1])}}))
                return true;
    return false;
}

/// A triangle through a corner of the box or a point of its edge, so that it touches up to rounding.
triangle3f touching(const box& b, const vec3f& size) {
    const vec3f on = corner(b, *rc::gen::inRange(0U, 8U));
    vec3f along = on;
    const int axis = *rc::gen::inRange(0, 3);
    along[axis] = any_number(size[axis]);
    triangle3f t{{{any_number(size[0]), any_number(size[1]), any_number(size[2])}, {}, {}}};
    // The corner is the midpoint of an edge of the triangle, or lies on a corner or another edge of it.
    for (int k = 0; k < 3; ++k) {
        t[1][k] = *rc::gen::element(2 * on[k] - t[0][k], on[k]);
        t[2][k] = *rc::gen::element(along[k], 2 * along[k] - t[0][k], any_number(size[k]));
    }
    return t;
}

}  // namespace

TEST_CASE("the triangle-box test misses no intersection, but would without its margin") {
    int missed_by_original = 0;
    int missed_without_margin = 0;
    int intersecting = 0;
    int culled = 0;
    REQUIRE(rc::check([&] {
        for (int i = 0; i < 100; ++i) {
            const int exponent = *rc::gen::element(-140, -60, -8, 0, 0, 4, 34, 60);
            vec3f size;
            vec3f offset;
            for (int k = 0; k < 3; ++k) {
                // Some are thin, down to denormals.
                size[k] = std::ldexp(1.0F, *rc::gen::element(exponent, exponent, exponent, -10, -133));
                offset[k] = *rc::gen::element(0.0F, 0.0F, 7.0F, 1000.0F) * size[k];
            }
            const box b = any_box(size, offset);
            const triangle3f t = touching(b, size);
            if (exactly_intersects(t, b)) {
                ++intersecting;
                missed_without_margin += !triangle_meets_box(t, b, 0, 0);
                missed_by_original += !moller_triangle_meets_box(t, b);
                RC_ASSERT(triangle_meets_box(t, b));
            } else {
                culled += !triangle_meets_box(t, b);
            }
        }
    }));
    CHECK(intersecting > 1000);
    CHECK(culled > 1000);
    CHECK(missed_without_margin > 0);
    CHECK(missed_by_original > 0);
}

TEST_CASE("the triangle-box test separates what is disjoint by more than rounding, on each of its axes") {
    int disjoint = 0;
    REQUIRE(rc::check([&] {
        const box b = any_box({1, 1, 1}, {0, 0, 0});
        box grown = b;
        for (int k = 0; k < 3; ++k) {
            grown.min[k] -= 1e-4F;
            grown.max[k] += 1e-4F;
        }
        triangle3f t;
        for (int i = 0; i < 3; ++i) t[i] = {any_number(2), any_number(2), any_number(2)};
        if (!exactly_intersects(t, grown)) {
            ++disjoint;
            RC_ASSERT(!triangle_meets_box(t, b));
            RC_ASSERT(!moller_triangle_meets_box(t, b));
        } else if (exactly_intersects(t, b)) {
            RC_ASSERT(triangle_meets_box(t, b));
        }
    }));
    CHECK(disjoint > 10);
    // Slanted, past an edge of the cube: only a cross product of edges separates them, no box axis and not the normal.
    const box cube{{-1, -1, -1}, {1, 1, 1}};
    CHECK_FALSE(triangle_meets_box({{{2.1F, 0.5F, 0}, {0.5F, 2.1F, 0}, {2, 2, 1}}}, cube));
    CHECK_FALSE(moller_triangle_meets_box({{{2.1F, 0.5F, 0}, {0.5F, 2.1F, 0}, {2, 2, 1}}}, cube));
    CHECK(triangle_meets_box({{{1.4F, 0.5F, 0}, {0.5F, 1.4F, 0}, {2, 2, 1}}}, cube));
}
