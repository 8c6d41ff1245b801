#include <CGAL/Exact_rational.h>
#include <CGAL/determinant.h>

#include <random>

#include "../testing.hpp"

import aabb;

// Signs of orientations compared with rational arithmetic, on points for each method by which they are computed; how
// often each method is used is counted by its definition.

using aabb::triangle3d;
using aabb::vec3d;

namespace {

using number = CGAL::Exact_rational;
using points = std::array<vec3d, 4>;

int sign_of(const number& n) {
    return CGAL::sign(n);
}

number volume(const vec3d& a, const vec3d& b, const vec3d& c, const vec3d& d) {
    const auto row = [&](const vec3d& p, int k) -> number { return number(p[k]) - number(a[k]); };
    return CGAL::determinant(row(b, 0), row(b, 1), row(b, 2), row(c, 0), row(c, 1), row(c, 2), row(d, 0), row(d, 1),
                             row(d, 2));
}

number area(const vec3d& a, const vec3d& b, const vec3d& c, int axis) {
    const auto across = [&](const vec3d& p, int k) -> number { return number(p[k % 3]) - number(a[k % 3]); };
    return across(b, axis + 1) * across(c, axis + 2) - across(b, axis + 2) * across(c, axis + 1);
}

/// How often the sign of a volume is computed by each method.
struct methods {
    int in_steps = 0;   ///< in whole steps of the grid
    int truncated = 0;  ///< in steps, although bits were cut off
    int every_bit = 0;  ///< with all bits

    void count(const points& p) {
        number steps = 1;
        bool fits = true;
        for (int k = 0; k < 3; ++k) {
            double largest = 0;
            for (const vec3d& q : p) largest = std::max(largest, std::abs(q[k]));
            if (largest == 0) continue;
            const int exponent = std::max(std::ilogb(largest), std::numeric_limits<double>::min_exponent - 1) - 59;
            // The step itself may be too small for a double.
            steps *= number(std::ldexp(1, exponent / 2)) * number(std::ldexp(1, exponent - exponent / 2));
            for (const vec3d& q : p)
                fits &= exponent < std::numeric_limits<double>::min_exponent - 53 ||
                        std::fmod(q[k], std::ldexp(1, exponent)) == 0;
        }
        const number exact = CGAL::abs(volume(p[0], p[1], p[2], p[3]));
        const number bound = steps * number(0x1p128);
        if (fits)
            ++in_steps;
        else
            ++(exact >= bound ? truncated : every_bit);
    }
};

class point_generator {
public:
    /// A multiple of 2^-52 in (-2, 2).
    double coordinate() {
        return std::ldexp(static_cast<double>(random_() >> 11), -52) * (random_() % 2 == 0 ? 1 : -1);
    }
    vec3d point() {
        // Braces are evaluated from left to right.
        return vec3d{coordinate(), coordinate(), coordinate()};
    }
    int below(int count) { return static_cast<int>(random_() % static_cast<unsigned>(count)); }

    /// The last point lies in the plane of the others up to rounding.
    points near_plane() {
        points p{point(), point(), point(), {}};
        const double u = coordinate() / 2;
        const double v = coordinate() / 2;
        for (int k = 0; k < 3; ++k) p[3][k] = p[0][k] + u * (p[1][k] - p[0][k]) + v * (p[2][k] - p[0][k]);
        return p;
    }

    /// Exactly coplanar: a parallelogram whose first and last corner are as far apart as numbers of that size can be.
    points in_plane() {
        points p{point(), point(), {}, {}};
        for (int k = 0; k < 3; ++k) {
            p[3][k] = 2 - std::ldexp(std::abs(coordinate()), -below(40));
            p[0][k] = std::ldexp(std::abs(coordinate()), -below(40)) - 2;
            // Multiples of 2^-52 again, so that the next sum is exact.
            p[3][k] = std::ldexp(std::floor(std::ldexp(p[3][k], 52)), -52);
            p[0][k] = std::ldexp(std::floor(std::ldexp(p[0][k], 52)), -52);
            p[2][k] = p[0][k] + p[3][k] - p[1][k];
        }
        return p;
    }

private:
    std::mt19937_64 random_{1};
};

/// Whether the computed value is within the stated error.
bool is_near(aabb::scaled_double computed, const number& exact) {
    number value = computed.mantissa;
    for (; computed.exponent > 0; --computed.exponent) value *= 2;
    for (; computed.exponent < 0; ++computed.exponent) value /= 2;
    return CGAL::abs(value - exact) <= CGAL::abs(exact) * number(1.001) * number(0x1p-53);
}

/// Checks one rotation of the points: a mistake may show in some of them only.
void check(points p, int turns, int& wrong) {
    std::rotate(p.begin(), p.begin() + turns, p.end());
    const auto& [a, b, c, d] = p;
    const int expected = sign_of(volume(a, b, c, d));
    wrong += aabb::exact_side(a, b, c, d) != expected;
    const auto sides = aabb::exact_sides(triangle3d{{d, a, b}}, triangle3d{{a, b, c}});
    wrong += sides[0] != expected || sides[1] != 0 || sides[2] != 0;
    // This is slow, as the exponent is counted down one by one.
    if (turns == 0) wrong += !is_near(aabb::exact_volume(a, b, c, d), volume(a, b, c, d));
    for (int axis = 0; axis < 3; ++axis) {
        wrong += aabb::exact_turn(a, b, c, axis) != sign_of(area(a, b, c, axis));
        wrong += aabb::exact_turn(a, b, d, axis) != sign_of(area(a, b, d, axis));
    }
}

/// Checks `orientations` of two triangles.
void check_filtered(const triangle3d& s, const triangle3d& t, int& wrong) {
    vec3d low = s[0];
    vec3d high = s[0];
    for (const triangle3d* of : {&s, &t})
        for (const vec3d& p : of->corner)
            for (int k = 0; k < 3; ++k) {
                low[k] = std::min(low[k], p[k]);
                high[k] = std::max(high[k], p[k]);
            }
    const auto fresh = [&] { return aabb::orientations(s, t, aabb::coordinates(low), aabb::coordinates(high)); };
    const auto sides = [](const triangle3d& of, const triangle3d& plane) {
        const auto side = [&](int i) { return sign_of(volume(plane[0], plane[1], plane[2], of[i])); };
        return aabb::corner_sides(std::array{side(0), side(1), side(2)});
    };
    const aabb::corner_sides s_exact = sides(s, t);
    const aabb::corner_sides t_exact = sides(t, s);
    aabb::corner_sides s_to_t;
    aabb::corner_sides t_to_s;
    const bool are_separated = fresh().part(s_to_t, t_to_s);
    wrong += are_separated != (s_exact.on_one_side() || t_exact.on_one_side());
    if (!are_separated)
        for (int i = 0; i < 3; ++i) wrong += s_to_t[i] != s_exact[i] || t_to_s[i] != t_exact[i];
    wrong += fresh().side(s[0], s[1], t[0], t[1]) != sign_of(volume(s[0], s[1], t[0], t[1]));
    wrong += fresh().in_order(s[0], s[1], s[2], t[0], t[1], t[2]) !=
             (sign_of(volume(s[0], s[1], t[0], t[1])) <= 0 && sign_of(volume(s[0], s[2], t[0], t[2])) >= 0);
    for (int axis = 0; axis < 3; ++axis) {
        const int own = sign_of(area(s[0], s[1], s[2], axis));
        wrong += fresh().turn(s[0], s[1], s[2], axis) != own;
        std::array<int, 3> turns{};
        for (int i = 0; i < 3; ++i) turns[static_cast<std::size_t>(i)] = sign_of(area(s[0], s[1], t[i], axis));
        const bool on_same_side = turns[0] != 0 && turns[0] == turns[1] && turns[0] == turns[2];
        wrong += fresh().beyond(s[0], s[1], own, t, axis) != (on_same_side && turns[0] != own);
    }
}

}  // namespace

TEST_CASE("exact signs equal those of rational arithmetic, by every method") {
    point_generator draw;
    methods counts;
    int wrong = 0;
    for (int round = 0; round < 10000; ++round) {
        points p = round % 2 == 0 ? draw.near_plane() : draw.in_plane();
        // Some axes, or some coordinates, are much smaller: they end below a step of the grid.
        if (round % 3 == 1)
            for (vec3d& q : p) q[draw.below(3)] *= std::ldexp(1, -draw.below(70));
        if (round % 3 == 2) {
            const int axis = draw.below(3);
            for (vec3d& q : p) q[axis] = std::ldexp(q[axis], -draw.below(3)) + (draw.below(4) == 0 ? 0x1p-70 : 0);
        }
        if (round % 5 == 1) {
            // Two points on a line through the origin, below a grid step of the third; or off it in the last bit.
            vec3d near = draw.point();
            for (double& x : near.at) x = std::ldexp(x, -30 - draw.below(10));
            const double factor = std::ldexp(1, draw.below(30));
            vec3d further{factor * near[0], factor * near[1], factor * near[2]};
            if (draw.below(2) == 0) further[0] = std::nextafter(further[0], 1);
            p = {vec3d{0, 0, 0}, near, draw.point(), further};
        }
        // From the least to the greatest doubles.
        constexpr std::array<int, 6> exponents{0, 0, -1021, -600, 500, 1020};
        const int exponent = exponents[static_cast<std::size_t>(draw.below(6))];
        for (vec3d& q : p)
            for (double& x : q.at) x = std::ldexp(x, exponent);
        counts.count(p);
        check(p, draw.below(4), wrong);
    }
    CHECK(wrong == 0);
    CHECK(counts.in_steps > 1000);
    CHECK(counts.truncated > 1000);
    CHECK(counts.every_bit > 1000);
}

TEST_CASE("filtered signs equal those of rational arithmetic, on lattices and near them") {
    point_generator draw;
    std::array<int, 2> lattices{};
    int wrong = 0;
    for (int round = 0; round < 10000; ++round) {
        // Up to what fits, and a little more.
        const int side = draw.below(2) == 0 ? 1 << (1 + draw.below(24)) : 65534 + draw.below(4);
        std::array<vec3d, 6> p{};
        for (vec3d& q : p)
            for (double& x : q.at) x = draw.below(side + 1);
        // Parallelograms are flat, and one step off they are not.
        for (int k = 0; k < 3; ++k) {
            p[3][k] = p[1][k] + p[2][k] - p[0][k] + (draw.below(8) == 0 ? 1 : 0);
            p[4][k] = p[0][k] + p[0][k] - p[1][k];
        }
        if (draw.below(4) == 0)
            for (vec3d& q : p) q[draw.below(3)] = 0.3;
        triangle3d s{{p[0], p[1], p[2]}};
        triangle3d t{{p[3], p[4], p[5]}};
        // So far away that a sum with 2^52 and a half may keep halves.
        const bool is_far = draw.below(8) == 0;
        if (is_far)
            for (triangle3d* of : {&s, &t})
                for (vec3d& q : of->corner)
                    for (double& x : q.at) x -= 0x1p51 + (draw.below(30) == 0 ? 0.5 : 0);
        const double unit = std::ldexp(1, draw.below(100) - 50);
        for (triangle3d* of : {&s, &t})
            for (vec3d& q : of->corner)
                for (double& x : q.at) x *= unit;
        vec3d extent{};
        bool expected = true;
        for (int k = 0; k < 3; ++k) {
            const auto [low, high] = std::minmax({s[0][k], s[1][k], s[2][k], t[0][k], t[1][k], t[2][k]});
            extent[k] = high - low;
            if (extent[k] == 0) continue;
            const double step = std::ldexp(1, std::ilogb(extent[k]) - 15);
            for (const triangle3d* of : {&s, &t})
                for (const vec3d& q : of->corner) expected &= std::fmod(q[k], step) == 0;
        }
        const bool on_lattice = aabb::are_on_lattice(s, t, extent);
        ++lattices[on_lattice ? 1 : 0];
        wrong += on_lattice ? !expected : expected && !is_far;
        check_filtered(s, t, wrong);
        check_filtered(t, s, wrong);
    }
    CHECK(wrong == 0);
    CHECK(lattices[0] > 1000);
    CHECK(lattices[1] > 1000);
}

TEST_CASE("filtered signs equal those of rational arithmetic, near planes and at every scale") {
    point_generator draw;
    int wrong = 0;
    for (int round = 0; round < 10000; ++round) {
        const points p = draw.near_plane();
        const points q = draw.in_plane();
        triangle3d s{{p[0], p[1], p[2]}};
        triangle3d t{{p[3], q[0], round % 2 == 0 ? q[1] : p[0]}};
        if (round % 4 == 0) t = {{p[3], p[1], {p[0][0], p[2][1], p[2][2]}}};
        constexpr std::array<int, 5> exponents{0, 0, -1021, -300, 1020};
        const int exponent = exponents[static_cast<std::size_t>(draw.below(5))];
        for (triangle3d* of : {&s, &t})
            for (vec3d& c : of->corner)
                for (double& x : c.at) x = std::ldexp(x, exponent);
        check_filtered(s, t, wrong);
        check_filtered(t, s, wrong);
    }
    CHECK(wrong == 0);
}
