#include <CGAL/Exact_predicates_exact_constructions_kernel.h>
#include <CGAL/intersections.h>

#include <algorithm>
#include <array>
#include <boost/optional.hpp>
#include <boost/variant.hpp>
#include <catch2/catch_test_macros.hpp>
#include <cstddef>
#include <cstdlib>
#include <map>
#include <string>
#include <variant>
#include <vector>

#include "../triangle_pairs.hpp"

import aabb;
import aabb.triangle.intersection;

// What two triangles have in common, against CGAL's exact construction.

namespace {

using kernel = CGAL::Exact_predicates_exact_constructions_kernel;
using point_3 = kernel::Point_3;
using segment_3 = kernel::Segment_3;
using triangle_3 = kernel::Triangle_3;
using shape = std::variant<point_3, segment_3, triangle_3>;
using points = std::vector<point_3>;

shape shape_of(const aabb::triangle3d& t) {
    std::array<point_3, 3> p;
    for (std::size_t i = 0; i < 3; ++i) {
        const aabb::vec3d& c = t[static_cast<int>(i)];
        p[i] = {c[0], c[1], c[2]};
    }
    if (!CGAL::collinear(p[0], p[1], p[2])) return triangle_3(p[0], p[1], p[2]);
    std::sort(p.begin(), p.end());
    if (p[0] == p[2]) return p[0];
    return segment_3(p[0], p[2]);
}

struct to_points {
    using result_type = points;
    points operator()(const point_3& p) const { return {p}; }
    points operator()(const segment_3& s) const { return {s.source(), s.target()}; }
    points operator()(const triangle_3& t) const { return {t[0], t[1], t[2]}; }
    points operator()(const points& all) const { return all; }
};

/// The corners of what is common.
struct common {
    points operator()(const point_3& s, const point_3& t) const { return s == t ? points{s} : points{}; }
    points operator()(const point_3& s, const auto& t) const { return t.has_on(s) ? points{s} : points{}; }
    points operator()(const auto& s, const point_3& t) const { return (*this)(t, s); }
    points operator()(const auto& s, const auto& t) const {
        const auto found = CGAL::intersection(s, t);
        if (!found) return {};
        points all = boost::apply_visitor(to_points{}, *found);
        points once;
        for (const point_3& p : all)
            if (std::find(once.begin(), once.end(), p) == once.end()) once.push_back(p);
        return once;
    }
};

bool on_border(const shape& s, const point_3& p) {
    const auto* const t = std::get_if<triangle_3>(&s);
    if (t == nullptr) return true;
    for (int i = 0; i < 3; ++i)
        if (segment_3((*t)[i], (*t)[i + 1]).has_on(p)) return true;
    return false;
}

std::string kind_of(const points& corners, const shape& s, const shape& t) {
    if (corners.empty()) return "none";
    if (corners.size() == 1) return "point";
    if (corners.size() > 2) return "overlap";
    const point_3 middle = CGAL::midpoint(corners[0], corners[1]);
    return on_border(s, middle) || on_border(t, middle) ? "segment" : "transversal";
}

bool is_near(const aabb::vec3d& ours, const point_3& exact, const aabb::vec3d& error) {
    for (int k = 0; k < 3; ++k)
        if (CGAL::abs(kernel::FT(ours[k]) - exact[k]) > kernel::FT(error[k])) return false;
    return true;
}

/// Which of CGAL's corners each of ours is; empty where one of ours may be several, so near do they lie to each other.
std::vector<std::size_t> matched(const aabb::triangle_intersection& ours, const points& corners) {
    std::vector<std::size_t> numbers;
    for (std::size_t i = 0; i < ours.size; ++i) {
        std::vector<std::size_t> near;
        for (std::size_t k = 0; k < corners.size(); ++k)
            if (is_near(ours.corners[i], corners[k], ours.error)) near.push_back(k);
        if (near.size() != 1) return {};
        numbers.push_back(near[0]);
    }
    return numbers;
}

/// Around a polygon in one of the two ways.
bool is_around(const std::vector<std::size_t>& numbers) {
    const std::size_t n = numbers.size();
    for (const std::size_t step : {std::size_t{1}, n - 1}) {
        bool same = true;
        for (std::size_t i = 0; i < n; ++i) same &= numbers[(i + 1) % n] == (numbers[i] + step) % n;
        if (same) return true;
    }
    return n < 4;
}

aabb::triangle3d as_triangle(const triangle_pairs::triangle& t) {
    aabb::triangle3d made{};
    for (int i = 0; i < 3; ++i)
        for (int k = 0; k < 3; ++k) made[i][k] = t[static_cast<std::size_t>(i)][static_cast<std::size_t>(k)];
    return made;
}

template <class Real>
void compare_all(int count) {
    triangle_pairs::generator g{4};
    std::map<std::string, int> kinds;
    int wrong = 0;
    int uncertain = 0;  // corners so near to each other that the bound cannot tell them apart
    const auto check = [&](const triangle_pairs::pair& pair) {
        const aabb::triangle3d s = as_triangle(pair[0]);
        const aabb::triangle3d t = as_triangle(pair[1]);
        const shape a = shape_of(s);
        const shape b = shape_of(t);
        const points corners = std::visit(common{}, a, b);
        const aabb::triangle_intersection ours = aabb::intersection_of(s, t);
        const std::string kind = kind_of(corners, a, b);
        ++kinds[kind];
        const std::vector<std::size_t> numbers = matched(ours, corners);
        const bool near_all = std::ranges::all_of(corners, [&](const point_3& p) {
            return std::any_of(ours.corners.begin(), ours.corners.begin() + ours.size,
                               [&](const aabb::vec3d& c) { return is_near(c, p, ours.error); });
        });
        const bool is_matched = !numbers.empty() || corners.empty();
        uncertain += !is_matched;
        wrong += name_of(ours.kind) != kind || ours.size != corners.size() || !near_all ||
                 (is_matched && !is_around(numbers));
    };
    for (std::size_t pattern = 0; pattern < triangle_pairs::patterns.size(); ++pattern)
        for (std::size_t placement = 0; placement < triangle_pairs::placements.size(); ++placement) {
            CAPTURE(triangle_pairs::patterns[pattern], triangle_pairs::placements[placement]);
            const int before = wrong;
            for (int i = 0; i < count; ++i)
                check(triangle_pairs::placed<Real>(g, triangle_pairs::patterned(g, pattern), placement));
            CHECK(wrong == before);
        }
    for (int i = 0; i < 10 * count; ++i) check(triangle_pairs::spread<Real>(g));
    CHECK(wrong == 0);
    for (const char* kind : {"none", "point", "segment", "transversal", "overlap"}) {
        INFO(kind);
        CHECK(kinds[kind] > count);
    }
    CHECK(uncertain < 63 * count / 20);
}

}  // namespace

TEST_CASE("what triangles of floats have in common is what CGAL constructs, within the stated error") {
    compare_all<float>(300);
}

TEST_CASE("what triangles of doubles have in common is what CGAL constructs, within the stated error") {
    compare_all<double>(300);
}

TEST_CASE("corners that are corners of a triangle are exact") {
    using aabb::intersection_kind;
    const aabb::triangle3d face{{{0, 0, 0}, {4, 0, 0}, {0, 4, 0}}};
    const auto point = aabb::intersection_of(face, {{{1, 1, 0}, {1, 1, 3}, {2, 1, 3}}});
    CHECK(point.kind == intersection_kind::point);
    CHECK(point.corners[0] == aabb::vec3d{1, 1, 0});
    CHECK(point.error == aabb::vec3d{0, 0, 0});
    const auto overlap = aabb::intersection_of(face, {{{1, 1, 0}, {2, 1, 0}, {1, 2, 0}}});
    CHECK(overlap.kind == intersection_kind::overlap);
    CHECK(overlap.size == 3);
    const auto star = aabb::intersection_of(aabb::triangle3d{{{0, 0, 0}, {6, 0, 0}, {3, 6, 0}}},
                                            {{{0, 4, 0}, {6, 4, 0}, {3, -2, 0}}});
    REQUIRE(star.size == 6);
    int turns = 0;
    for (std::size_t i = 0; i < 6; ++i) {  // round about the middle, always the same way
        const aabb::vec3d p = star.corners[i];
        const aabb::vec3d q = star.corners[(i + 1) % 6];
        turns += (p[0] - 3) * (q[1] - 2) > (p[1] - 2) * (q[0] - 3) ? 1 : -1;
    }
    CHECK(std::abs(turns) == 6);
    CHECK(aabb::intersection_of(face, {{{1, 1, 1}, {1, 1, 3}, {2, 1, 3}}}).kind == intersection_kind::none);
    CHECK(aabb::intersection_of(face, {{{1, 1, -1}, {1, 1, 3}, {2, 1, 3}}}).kind == intersection_kind::transversal);
    CHECK(aabb::intersection_of(face, {{{1, 0, 0}, {2, 0, 0}, {1, 0, 3}}}).kind == intersection_kind::segment);
    CHECK(name_of(intersection_kind::transversal) == "transversal");
    // An end that is a cut of one triangle and a corner of the other.
    const aabb::triangle3d slanted{{{0, 0, 0}, {49, 49, 0}, {0, 49, 0}}};
    const aabb::triangle3d upright{{{1, 1, 0}, {1, 0, 1}, {1, 2, 1}}};
    for (const auto& made : {aabb::intersection_of(slanted, upright), aabb::intersection_of(upright, slanted)}) {
        CHECK(made.kind == intersection_kind::point);
        CHECK(made.corners[0] == aabb::vec3d{1, 1, 0});
        CHECK(made.error == aabb::vec3d{0, 0, 0});
    }
    const auto pierced = aabb::intersection_of(aabb::triangle3d{{{1, 1, 0}, {3, 0, 0}, {0, 4, 0}}},
                                               {{{1, 1, 49}, {1, 1, -3}, {1, 1, -3}}});
    CHECK(pierced.kind == intersection_kind::point);
    CHECK(pierced.corners[0] == aabb::vec3d{1, 1, 0});
    CHECK(pierced.error == aabb::vec3d{0, 0, 0});
}
