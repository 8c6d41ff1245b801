module aabb.triangle.intersection;

import aabb.std;
import aabb.triangle.orientation_test;

// Sums and products as they are written: see aabb.base:floating_point.
#pragma clang fp contract(off) reassociate(off) reciprocal(off)

namespace aabb {

namespace {

using signs_of_corners = std::array<int, 3>;

/// An intersection in the making.
class result {
public:
    void add_corner(const vec3d& p) { made_.corners[made_.size++] = p; }

    /// Where the edge from a to b, which lie at the distances p and q of opposite signs (or zero), meets the other set.
    void add_crossing(vec3d a, vec3d b, scaled_double p, scaled_double q) {
        if (p.mantissa == 0) return add_corner(a);
        if (q.mantissa == 0) return add_corner(b);
        const int largest = std::max(p.exponent, q.exponent);
        double to_a = std::abs(std::ldexp(p.mantissa, p.exponent - largest));
        double to_b = std::abs(std::ldexp(q.mantissa, q.exponent - largest));
        if (to_a > to_b) {
            std::swap(a, b);
            std::swap(to_a, to_b);
        }
        const double t = to_a / (to_a + to_b);
        vec3d at{};
        for (int k = 0; k < 3; ++k) {
            const double difference = b[k] - a[k];
            // Beyond the range of double only where both are large, so that halves are exact.
            at[k] = std::isfinite(difference) ? a[k] + difference * t : 2 * (a[k] / 2 + (b[k] / 2 - a[k] / 2) * t);
            const double length = std::abs(b[k] / 2 - a[k] / 2);
            const double bound = 8 * unit * length + unit * std::abs(at[k]) + std::numeric_limits<double>::denorm_min();
            if (a[k] != b[k]) made_.error[k] = std::max(made_.error[k], bound);
        }
        add_corner(at);
    }

    [[nodiscard]] std::uint32_t size() const { return made_.size; }
    void reorder(const std::array<std::uint32_t, 6>& order) {
        const std::array<vec3d, 6> before = made_.corners;
        for (std::size_t i = 0; i < made_.size; ++i) made_.corners[i] = before[order[i]];
    }
    [[nodiscard]] triangle_intersection as(intersection_kind kind) {
        made_.kind = kind;
        return made_;
    }
    /// A point or a segment that touches, or a polygon; nothing where there are no corners.
    [[nodiscard]] triangle_intersection by_size() {
        using enum intersection_kind;
        return as(made_.size == 0 ? none : made_.size == 1 ? point : made_.size == 2 ? segment : overlap);
    }

private:
    static constexpr double unit = std::numeric_limits<double>::epsilon() / 2;

    triangle_intersection made_;
};

/// The corners of a triangle without area, or all three: what it is the convex hull of.
struct hull {
    std::array<vec3d, 3> corner;
    int size;
};

hull hull_of(const triangle3d& t) {
    for (int axis = 0; axis < 3; ++axis)
        if (exact_turn(t[0], t[1], t[2], axis) != 0) return {{t[0], t[1], t[2]}, 3};
    // On a line, the lexicographic order of points is their order along it.
    const auto before = [](const vec3d& p, const vec3d& q) {
        return std::lexicographical_compare(std::begin(p.at), std::end(p.at), std::begin(q.at), std::end(q.at));
    };
    const vec3d first = std::min({t[0], t[1], t[2]}, before);
    const vec3d last = std::max({t[0], t[1], t[2]}, before);
    return {{first, last, last}, first == last ? 1 : 2};
}

// In one plane, seen along an axis in which it is not edge-on. What lies on a line is named by bits, one an edge: those
// of the first hull from bit 0 on, those of the other from bit 3 on.

/// Where points and hulls lie, seen along an axis.
struct view {
    int axis;

    [[nodiscard]] int turn(const vec3d& a, const vec3d& b, const vec3d& c) const { return exact_turn(a, b, c, axis); }
    [[nodiscard]] bool between(const vec3d& p, const vec3d& a, const vec3d& b) const {
        for (int k = 0; k < 3; ++k)
            if (p[k] < std::min(a[k], b[k]) || p[k] > std::max(a[k], b[k])) return false;
        return true;
    }

    /// Whether p, in the plane of the hull, lies in it.
    [[nodiscard]] bool holds(const hull& h, const vec3d& p) const {
        if (h.size == 1) return p == h.corner[0];
        if (h.size == 2) return turn(h.corner[0], h.corner[1], p) == 0 && between(p, h.corner[0], h.corner[1]);
        const int inside = turn(h.corner[0], h.corner[1], h.corner[2]);
        for (std::size_t i = 0; i < 3; ++i)
            if (turn(h.corner[i], h.corner[(i + 1) % 3], p) == -inside) return false;
        return true;
    }

    /// The edges of the hull on whose lines p lies.
    [[nodiscard]] unsigned edges_through(const hull& h, const vec3d& p) const {
        unsigned edges = 0;
        for (int i = 0; i < edges_of(h); ++i)
            if (turn(from(h, i), to(h, i), p) == 0) edges |= 1U << i;
        return edges;
    }

    [[nodiscard]] static int edges_of(const hull& h) { return h.size == 3 ? 3 : h.size - 1; }
    [[nodiscard]] static const vec3d& from(const hull& h, int edge) { return h.corner[static_cast<std::size_t>(edge)]; }
    [[nodiscard]] static const vec3d& to(const hull& h, int edge) {
        return h.corner[static_cast<std::size_t>(edge + 1) % static_cast<std::size_t>(h.size)];
    }
};

/// The corners of the intersection of two hulls in one plane: corners of one that lie in the other, and where edges
/// cross within both. None of them is there twice, and none lies between others.
triangle_intersection flat_intersection(const hull& g, const hull& h, const view& seen) {
    result made;
    std::array<unsigned, 6> lines{};
    for (std::size_t i = 0; i < static_cast<std::size_t>(g.size); ++i)
        if (seen.holds(h, g.corner[i])) {
            lines[made.size()] = seen.edges_through(g, g.corner[i]) | seen.edges_through(h, g.corner[i]) << 3;
            made.add_corner(g.corner[i]);
        }
    for (std::size_t i = 0; i < static_cast<std::size_t>(h.size); ++i) {
        const vec3d& p = h.corner[i];
        const auto* const end = g.corner.data() + g.size;
        if (std::find(g.corner.data(), end, p) != end || !seen.holds(g, p)) continue;
        lines[made.size()] = seen.edges_through(g, p) | seen.edges_through(h, p) << 3;
        made.add_corner(p);
    }
    for (int i = 0; i < view::edges_of(g); ++i)
        for (int j = 0; j < view::edges_of(h); ++j) {
            const vec3d& a = view::from(g, i);
            const vec3d& b = view::to(g, i);
            const vec3d& c = view::from(h, j);
            const vec3d& d = view::to(h, j);
            if (seen.turn(c, d, a) * seen.turn(c, d, b) >= 0 || seen.turn(a, b, c) * seen.turn(a, b, d) >= 0) continue;
            lines[made.size()] = 1U << i | 8U << j;
            made.add_crossing(a, b, exact_area(c, d, a, seen.axis), exact_area(c, d, b, seen.axis));
        }
    if (made.size() > 3) {
        // Neighbours around the polygon, and no others, lie on the line of one edge.
        std::array<std::uint32_t, 6> order{};
        unsigned placed = 1;
        for (std::size_t i = 1; i < made.size(); ++i)
            for (std::uint32_t next = 1; next < made.size(); ++next)
                if ((placed >> next & 1) == 0 && (lines[order[i - 1]] & lines[next]) != 0) {
                    order[i] = next;
                    placed |= 1U << next;
                    break;
                }
        made.reorder(order);
    }
    return made.by_size();
}

triangle_intersection coplanar_intersection(const hull& g, const hull& h) {
    if (g.size < 3 && h.size < 3) {
        // Along a line nothing can be seen edge-on but the line itself; two that cross span a plane.
        for (int axis = 0; axis < 3; ++axis) {
            const hull& longer = g.size > h.size ? g : h;
            const hull& other = g.size > h.size ? h : g;
            for (int i = 0; i < other.size; ++i)
                if (exact_turn(longer.corner[0], longer.corner[1], other.corner[static_cast<std::size_t>(i)], axis) !=
                    0)
                    return flat_intersection(g, h, {axis});
        }
        result made;
        const view along{0};
        for (const auto& [own, others] : {std::pair(&g, &h), std::pair(&h, &g)})
            for (std::size_t i = 0; i < static_cast<std::size_t>(own->size); ++i) {
                const vec3d& p = own->corner[i];
                const auto* const end = g.corner.data() + g.size;
                if (own == &h && std::find(g.corner.data(), end, p) != end) continue;
                if (along.between(p, others->corner[0], others->corner[1])) made.add_corner(p);
            }
        return made.by_size();
    }
    const hull& area = g.size == 3 ? g : h;
    for (int axis = 0; axis < 3; ++axis)
        if (exact_turn(area.corner[0], area.corner[1], area.corner[2], axis) != 0)
            return flat_intersection(g, h, {axis});
    return {};
}

/// A segment meets a triangle whose plane it crosses in one point.
triangle_intersection pierced(const hull& segment, const triangle3d& t) {
    result made;
    for (const vec3d& corner : t.corner) {
        const auto is_straight = [&](int axis) {
            return exact_turn(segment.corner[0], segment.corner[1], corner, axis) == 0;
        };
        if (!is_straight(0) || !is_straight(1) || !is_straight(2)) continue;
        made.add_corner(corner);
        return made.as(intersection_kind::point);
    }
    const auto height = [&](const vec3d& p) { return exact_volume(t[0], t[1], t[2], p); };
    made.add_crossing(segment.corner[0], segment.corner[1], height(segment.corner[0]), height(segment.corner[1]));
    return made.as(intersection_kind::point);
}

/// Corner 0 is what the other plane cuts off, at least one other corner being on the other side or on the plane; or it
/// lies on the plane alone.
triangle3d turned_to_apex(const triangle3d& s, const signs_of_corners& d, int& up) {
    for (int i = 0; i < 3; ++i)
        for (const int side : {1, -1}) {
            const auto at = [&](int j) { return side * d[static_cast<std::size_t>((i + j) % 3)]; };
            if ((at(0) > 0 && at(1) <= 0 && at(2) <= 0) || (at(0) == 0 && at(1) < 0 && at(2) < 0)) {
                up = side;
                return {{s[i], s[(i + 1) % 3], s[(i + 2) % 3]}};
            }
        }
    return s;
}

/// Planes that differ, both triangles with area, and they intersect: the part that the intervals share in which each
/// cuts the common line. With each turned so that the other's apex lies above it, the one runs from the cut on edge 01
/// to that on edge 02, the other against it.
triangle_intersection crossing_intersection(const triangle3d& given_s, const signs_of_corners& s_to_t,
                                            const triangle3d& given_t, const signs_of_corners& t_to_s) {
    int s_up = 1;
    int t_up = 1;
    triangle3d s = turned_to_apex(given_s, s_to_t, s_up);
    triangle3d t = turned_to_apex(given_t, t_to_s, t_up);
    if (t_up < 0) std::swap(s[1], s[2]);
    if (s_up < 0) std::swap(t[1], t[2]);
    const auto heights_over = [](const triangle3d& plane, const triangle3d& of) {
        const auto height = [&](int i) { return exact_volume(plane[0], plane[1], plane[2], of[i]); };
        return std::array{height(0), height(1), height(2)};
    };
    const auto s_heights = heights_over(t, s);
    const auto t_heights = heights_over(s, t);
    // The cut on edge 0i is a corner, so nothing rounds it.
    const auto is_corner = [](const std::array<scaled_double, 3>& heights, std::size_t i) {
        return heights[0].mantissa == 0 || heights[i].mantissa == 0;
    };
    // Of where edge 0i of s lies to where edge 0j of t does.
    const auto order = [&](int i, int j) { return exact_side(s[0], s[i], t[0], t[j]); };
    const int low = order(1, 2);
    const int high = order(2, 1);
    const bool low_is_of_s = low > 0 || (low == 0 && is_corner(s_heights, 1));
    const bool high_is_of_s = high < 0 || (high == 0 && is_corner(s_heights, 2));
    const auto on_plane = [](const signs_of_corners& d) { return std::ranges::count(d, 0); };
    // One corner on the plane, the others on one side.
    const auto is_point = [&](const signs_of_corners& d) { return on_plane(d) == 1 && d[0] + d[1] + d[2] != 0; };
    const bool is_single = low_is_of_s == high_is_of_s ? is_point(low_is_of_s ? s_to_t : t_to_s)
                           : low_is_of_s               ? order(1, 1) == 0
                                                       : order(2, 2) == 0;
    result made;
    const auto add = [&](const triangle3d& of, const std::array<scaled_double, 3>& heights, int end) {
        made.add_crossing(of[0], of[end], heights[0], heights[static_cast<std::size_t>(end)]);
    };
    low_is_of_s ? add(s, s_heights, 1) : add(t, t_heights, 2);
    if (is_single) return made.as(intersection_kind::point);
    high_is_of_s ? add(s, s_heights, 2) : add(t, t_heights, 1);
    const bool an_edge_touches = on_plane(s_to_t) == 2 || on_plane(t_to_s) == 2;
    return made.as(an_edge_touches ? intersection_kind::segment : intersection_kind::transversal);
}

}  // namespace

triangle_intersection intersection_of(const triangle3d& s, const triangle3d& t) {
    require_ieee_arithmetic();
    // A corner in common is a hit, but what else is common must still be found.
    if (!orientation_test<orientations>::intersects(s, t)) return {};
    const hull g = hull_of(s);
    const hull h = hull_of(t);
    const auto sides = [](const triangle3d& of, const triangle3d& plane) {
        const auto side = [&](int i) { return exact_side(plane[0], plane[1], plane[2], of[i]); };
        return signs_of_corners{side(0), side(1), side(2)};
    };
    // Without an area there is no plane, and all sides are zero.
    const signs_of_corners s_to_t = sides(s, t);
    const signs_of_corners t_to_s = sides(t, s);
    const bool s_on_t = s_to_t == signs_of_corners{};
    const bool t_on_s = t_to_s == signs_of_corners{};
    if (s_on_t && t_on_s) return coplanar_intersection(g, h);
    if (t_on_s) return pierced(g, t);
    if (s_on_t) return pierced(h, s);
    return crossing_intersection(s, s_to_t, t, t_to_s);
}

}  // namespace aabb
