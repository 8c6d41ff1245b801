#include "pairs.hpp"

import aabb.triangle.self_intersection;

// Self-intersection is compared with its definition, by the intersection that CGAL constructs exactly.

namespace {

using aabb::intersection_kind;
using aabb::self_intersection;
using aabb::triangle3d;

/// Whether the intersection is more than the shared corners and the edge between two of these.
bool exceeds_shared_corners(const triangle3d& s, const triangle3d& t) {
    const self_intersection::corner_sets corners(s, t);
    const aabb::exact_intersection common(s, t);
    aabb::triangle_intersection shared;
    shared.kind = common.kind();
    switch (corners.shared.size) {
        case 0: return common.kind() != intersection_kind::none;
        case 1: return common.kind() != intersection_kind::point;
        case 2:
            if (common.kind() == intersection_kind::overlap) return true;
            shared.size = 2;
            for (int i = 0; i < 2; ++i)
                shared.corners[static_cast<std::size_t>(i)] = corners.shared.at[static_cast<std::size_t>(i)];
            return !common.errors_of(shared).within;
        default: return common.kind() == intersection_kind::overlap;
    }
}

}  // namespace

TEST_CASE("self-intersection is what two triangles share beyond their common corners and edge") {
    triangle_pairs::generator g(54);
    std::array<std::array<int, 2>, 4> results{};  // by the number of shared corners, and the result
    int wrong = 0;
    // Few coordinates give many triangles without area, in one plane and on one line; 0 stands for real ones.
    for (const int most : {0, 1, 2, 3})
        for (int i = 0; i < 40'000; ++i) {
            std::uniform_int_distribution<int> small(0, most);
            std::uniform_real_distribution<double> real(-1, 1);
            const auto coordinate = [&] { return most == 0 ? real(g) : double(small(g)); };
            // Half of the triangles lie in one plane, or nearly so.
            const double height = i % 2 != 0 ? 1 : most == 0 ? 0x1p-53 : 0;
            const auto corner = [&] { return aabb::vec3d{coordinate(), coordinate(), height * coordinate()}; };
            const triangle3d s{{corner(), corner(), corner()}};
            triangle3d t{{corner(), corner(), corner()}};
            for (int shared = 0; shared < i % 4; ++shared) t[shared] = s[(shared + i / 4) % 3];
            const bool intersect = self_intersection::intersects(s, t);
            wrong += intersect != exceeds_shared_corners(s, t);
            wrong += intersect != self_intersection::intersects(t, s);
            ++results[self_intersection::corner_sets(s, t).shared.size][intersect ? 1 : 0];
        }
    CHECK(wrong == 0);
    for (const auto& [disjoint, intersecting] : results) {
        CHECK(disjoint > 100);
        CHECK(intersecting > 100);
    }
}

TEST_CASE("self-intersection of neighbours is decided where doubles cannot") {
    // The corners of two faces at an edge or a corner: nearly in one plane, by one unit in the last place.
    const double up = std::nextafter(1.0, 2.0);
    const triangle3d face{{{0, 0, 1}, {3, 0, 1}, {0, 3, 1}}};
    for (const double height : {1.0, up})
        for (const aabb::vec3d& apex : {aabb::vec3d{1, 1, height}, aabb::vec3d{1, -1, height}}) {
            const triangle3d at_edge{{{0, 0, 1}, {3, 0, 1}, apex}};
            CHECK(self_intersection::intersects(face, at_edge) == exceeds_shared_corners(face, at_edge));
            const triangle3d at_corner{{{0, 0, 1}, apex, {2, 4, 1}}};
            CHECK(self_intersection::intersects(face, at_corner) == exceeds_shared_corners(face, at_corner));
        }
}

TEST_CASE("self-intersection of neighbours in one plane is found where doubles round their volume") {
    // Volumes of integers below 2^22 have up to 66 bits. In a skew plane they are 0, but not if they are rounded.
    std::mt19937 g(54);
    std::uniform_int_distribution<int> coordinate(-(1 << 21), 1 << 21);
    int missed = 0;
    for (int i = 0; i < 2'000; ++i) {
        const auto corner = [&] {
            return aabb::vec3d{double(coordinate(g)), double(coordinate(g)), double(coordinate(g))};
        };
        const aabb::vec3d p = corner();
        const aabb::vec3d q = corner();
        const triangle3d face{{{0, 0, 0}, p, q}};
        const triangle3d at_edge{{{0, 0, 0}, p, p + q}};
        const triangle3d at_corner{{{0, 0, 0}, p + q, p + p + q}};
        for (const triangle3d& t : {at_edge, at_corner})
            missed += !self_intersection::intersects(face, t) + !self_intersection::intersects(t, face);
    }
    CHECK(missed == 0);
}
