module aabb.triangle.intersection;

import aabb.std;
import aabb.triangle.orientation_test;

#pragma clang fp contract(off) reassociate(off) reciprocal(off)  // see aabb.base:floating_point

namespace aabb {

namespace {

using signs_of_corners = std::array<int, 3>;

/// Collects the corners of an intersection.
class result {
public:
    void add_corner(const vec3d& p) { common_.corners[common_.size++] = p; }

    /// Adds where the edge ab crosses the other plane or edge, from which a and b have the signed distances p and q.
    void add_crossing(vec3d a, vec3d b, scaled_double p, scaled_double q) {
        if (p.mantissa == 0) return add_corner(a);
        if (q.mantissa == 0) return add_corner(b);
        const int largest = std::max(p.exponent, q.exponent);
        double to_a = std::abs(std::ldexp(p.mantissa, p.exponent - largest));
        double to_b = std::abs(std::ldexp(q.mantissa, q.exponent - largest));
        if (to_a > to_b) {  // begins at the nearer end, which halves the rounding error
            std::swap(a, b);
            std::swap(to_a, to_b);
        }
        const double t = to_a / (to_a + to_b);
        vec3d at{};
        for (int k = 0; k < 3; ++k) {
            const double difference = b[k] - a[k];
            // The difference overflows only if both are large, so that their halves are exact.
            at[k] = std::isfinite(difference) ? a[k] + difference * t : 2 * (a[k] / 2 + (b[k] / 2 - a[k] / 2) * t);
            const double half_length = std::abs(b[k] / 2 - a[k] / 2);
            // 4 u of the length and u of the result, as derived at `intersection_of`.
            const double bound =
                8 * unit * half_length + unit * std::abs(at[k]) + std::numeric_limits<double>::denorm_min();
            if (a[k] != b[k]) common_.error[k] = std::max(common_.error[k], bound);
        }
        add_corner(at);
    }

    [[nodiscard]] std::uint32_t size() const { return common_.size; }
    void reorder(const std::array<std::uint32_t, 6>& order) {
        const std::array<vec3d, 6> before = common_.corners;
        for (std::size_t i = 0; i < common_.size; ++i) common_.corners[i] = before[order[i]];
    }
    [[nodiscard]] triangle_intersection as(intersection_kind kind) {
        common_.kind = kind;
        return common_;
    }
    /// Derives the kind of a coplanar intersection from the number of corners.
    [[nodiscard]] triangle_intersection by_size() {
        using enum intersection_kind;
        return as(common_.size == 0 ? none : common_.size == 1 ? point : common_.size == 2 ? segment : overlap);
    }

private:
    static constexpr double unit = std::numeric_limits<double>::epsilon() / 2;

    triangle_intersection common_;
};

/// A triangle as a convex hull: three corners, or fewer if it has zero area.
struct hull {
    std::array<vec3d, 3> corner;
    int size;
};

/// Reduces a triangle of zero area to a segment or point.
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

// Coplanar hulls, projected along an axis along which their plane is not edge-on. Bit masks say on which edges' lines a
// point lies: bits 0 to 2 are edges of the first hull, bits 3 to 5 those of the second.

/// Predicates of points and hulls in the projection along an axis.
struct view {
    int axis;

    [[nodiscard]] int turn(const vec3d& a, const vec3d& b, const vec3d& c) const { return exact_turn(a, b, c, axis); }
    [[nodiscard]] bool between(const vec3d& p, const vec3d& a, const vec3d& b) const {
        for (int k = 0; k < 3; ++k)
            if (p[k] < std::min(a[k], b[k]) || p[k] > std::max(a[k], b[k])) return false;
        return true;
    }

    /// Whether p, which is coplanar with the hull, lies in it.
    [[nodiscard]] bool contains(const hull& h, const vec3d& p) const {
        if (h.size == 1) return p == h.corner[0];
        if (h.size == 2) return turn(h.corner[0], h.corner[1], p) == 0 && between(p, h.corner[0], h.corner[1]);
        const int inside = turn(h.corner[0], h.corner[1], h.corner[2]);
        for (std::size_t i = 0; i < 3; ++i)
            if (turn(h.corner[i], h.corner[(i + 1) % 3], p) == -inside) return false;
        return true;
    }

    /// The mask of the hull's edges whose lines contain p.
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

/// Intersects two coplanar hulls. The corners are those of one hull that lie in the other, and the proper crossings of
/// edges. They are distinct, and none lies between two others. `lines` are masks of the edges on whose lines they lie:
/// bit i for edge i of g, bit 3 + i for edge i of h.
triangle_intersection flat_intersection(const hull& g, const hull& h, const view& seen) {
    result common;
    std::array<unsigned, 6> lines{};
    for (std::size_t i = 0; i < static_cast<std::size_t>(g.size); ++i)
        if (seen.contains(h, g.corner[i])) {
            lines[common.size()] = seen.edges_through(g, g.corner[i]) | seen.edges_through(h, g.corner[i]) << 3;
            common.add_corner(g.corner[i]);
        }
    for (std::size_t i = 0; i < static_cast<std::size_t>(h.size); ++i) {
        const vec3d& p = h.corner[i];
        const auto* const end = g.corner.data() + g.size;
        if (std::find(g.corner.data(), end, p) != end || !seen.contains(g, p)) continue;
        lines[common.size()] = seen.edges_through(g, p) | seen.edges_through(h, p) << 3;
        common.add_corner(p);
    }
    for (int i = 0; i < view::edges_of(g); ++i)
        for (int j = 0; j < view::edges_of(h); ++j) {
            const vec3d& a = view::from(g, i);
            const vec3d& b = view::to(g, i);
            const vec3d& c = view::from(h, j);
            const vec3d& d = view::to(h, j);
            if (seen.turn(c, d, a) * seen.turn(c, d, b) >= 0 || seen.turn(a, b, c) * seen.turn(a, b, d) >= 0) continue;
            lines[common.size()] = 1U << i | 8U << j;
            common.add_crossing(a, b, exact_area(c, d, a, seen.axis), exact_area(c, d, b, seen.axis));
        }
    if (common.size() > 3) {
        // Two corners are adjacent in the polygon if and only if they share the line of an edge.
        std::array<std::uint32_t, 6> order{};
        unsigned placed = 1;
        for (std::size_t i = 1; i < common.size(); ++i)
            for (std::uint32_t next = 1; next < common.size(); ++next)
                if ((placed >> next & 1) == 0 && (lines[order[i - 1]] & lines[next]) != 0) {
                    order[i] = next;
                    placed |= 1U << next;
                    break;
                }
        common.reorder(order);
    }
    return common.by_size();
}

/// Intersects coplanar hulls in a projection in which their plane is not edge-on, or along their common line.
triangle_intersection coplanar_intersection(const hull& g, const hull& h) {
    if (g.size < 3 && h.size < 3) {
        // Two crossing segments span a plane; otherwise everything is on one line.
        for (int axis = 0; axis < 3; ++axis) {
            const hull& longer = g.size > h.size ? g : h;
            const hull& other = g.size > h.size ? h : g;
            for (int i = 0; i < other.size; ++i)
                if (exact_turn(longer.corner[0], longer.corner[1], other.corner[static_cast<std::size_t>(i)], axis) !=
                    0)
                    return flat_intersection(g, h, {axis});
        }
        result common;
        const view along{0};  // any axis, since `between` compares all coordinates
        for (const auto& [own, others] : {std::pair(&g, &h), std::pair(&h, &g)})
            for (std::size_t i = 0; i < static_cast<std::size_t>(own->size); ++i) {
                const vec3d& p = own->corner[i];
                const auto* const end = g.corner.data() + g.size;
                if (own == &h && std::find(g.corner.data(), end, p) != end) continue;  // added for g already
                if (along.between(p, others->corner[0], others->corner[1])) common.add_corner(p);
            }
        return common.by_size();
    }
    const hull& area = g.size == 3 ? g : h;
    for (int axis = 0; axis < 3; ++axis)
        if (exact_turn(area.corner[0], area.corner[1], area.corner[2], axis) != 0)
            return flat_intersection(g, h, {axis});
    return {};
}

/// Intersects a segment with a triangle whose plane it crosses in one point. A corner on the segment is not rounded.
triangle_intersection segment_intersection(const hull& segment, const triangle3d& t) {
    result common;
    for (const vec3d& corner : t.corner) {
        const auto is_straight = [&](int axis) {
            return exact_turn(segment.corner[0], segment.corner[1], corner, axis) == 0;
        };
        if (!is_straight(0) || !is_straight(1) || !is_straight(2)) continue;
        common.add_corner(corner);
        return common.as(intersection_kind::point);
    }
    const auto height = [&](const vec3d& p) { return exact_volume(t[0], t[1], t[2], p); };
    common.add_crossing(segment.corner[0], segment.corner[1], height(segment.corner[0]), height(segment.corner[1]));
    return common.as(intersection_kind::point);
}

/// Intersects triangles with area in different planes that are known to intersect: returns the overlap of their
/// intervals on the common line. Each is flipped so that the other's apex lies above it; then the interval of s runs
/// from the cut on edge 01 to that on edge 02, and the interval of t in the opposite direction.
triangle_intersection crossing_intersection(triangle3d s, const signs_of_corners& s_to_t, triangle3d t,
                                            const signs_of_corners& t_to_s) {
    const bool s_is_below = rotate_to_apex(s, s_to_t);
    const bool t_is_below = rotate_to_apex(t, t_to_s);
    if (t_is_below) std::swap(s[1], s[2]);
    if (s_is_below) std::swap(t[1], t[2]);
    const auto heights_over = [](const triangle3d& plane, const triangle3d& of) {
        const auto height = [&](int i) { return exact_volume(plane[0], plane[1], plane[2], of[i]); };
        return std::array{height(0), height(1), height(2)};
    };
    const auto s_heights = heights_over(t, s);
    const auto t_heights = heights_over(s, t);
    // The cut on edge 0i is a corner, which is not rounded.
    const auto is_corner = [](const std::array<scaled_double, 3>& heights, std::size_t i) {
        return heights[0].mantissa == 0 || heights[i].mantissa == 0;
    };
    // Compares the cut on edge 0i of s with that on edge 0j of t.
    const auto order = [&](int i, int j) { return exact_side(s[0], s[i], t[0], t[j]); };
    const int low = order(1, 2);
    const int high = order(2, 1);
    const bool low_is_of_s = low > 0 || (low == 0 && is_corner(s_heights, 1));
    const bool high_is_of_s = high < 0 || (high == 0 && is_corner(s_heights, 2));
    const auto on_plane = [](const signs_of_corners& d) { return std::ranges::count(d, 0); };
    // The triangle touches the plane in one corner, with the others on one side.
    const auto is_point = [&](const signs_of_corners& d) { return on_plane(d) == 1 && d[0] + d[1] + d[2] != 0; };
    const bool is_single = low_is_of_s == high_is_of_s ? is_point(low_is_of_s ? s_to_t : t_to_s)
                           : low_is_of_s               ? order(1, 1) == 0
                                                       : order(2, 2) == 0;
    result common;
    const auto add = [&](const triangle3d& of, const std::array<scaled_double, 3>& heights, int end) {
        common.add_crossing(of[0], of[end], heights[0], heights[static_cast<std::size_t>(end)]);
    };
    low_is_of_s ? add(s, s_heights, 1) : add(t, t_heights, 2);
    if (is_single) return common.as(intersection_kind::point);
    high_is_of_s ? add(s, s_heights, 2) : add(t, t_heights, 1);
    const bool an_edge_touches = on_plane(s_to_t) == 2 || on_plane(t_to_s) == 2;
    return common.as(an_edge_touches ? intersection_kind::segment : intersection_kind::transversal);
}

}  // namespace

/// Distinguishes coplanar triangles, those of zero area that cross a plane, and crossing triangles, by exact signs.
triangle_intersection intersection_of(const triangle3d& s, const triangle3d& t) {
    require_ieee_arithmetic();
    // A shared corner is a hit, but the rest of the intersection must still be computed.
    if (!orientation_test<orientations>::intersects(s, t)) return {};
    const hull g = hull_of(s);
    const hull h = hull_of(t);
    const auto sides = [](const triangle3d& of, const triangle3d& plane) {
        const auto side = [&](int i) { return exact_side(plane[0], plane[1], plane[2], of[i]); };
        return signs_of_corners{side(0), side(1), side(2)};
    };
    // A zero-area triangle has no plane, so that all sides are zero.
    const signs_of_corners s_to_t = sides(s, t);
    const signs_of_corners t_to_s = sides(t, s);
    const bool s_on_t = s_to_t == signs_of_corners{};
    const bool t_on_s = t_to_s == signs_of_corners{};
    if (s_on_t && t_on_s) return coplanar_intersection(g, h);
    if (t_on_s) return segment_intersection(g, t);
    if (s_on_t) return segment_intersection(h, s);
    return crossing_intersection(s, s_to_t, t, t_to_s);
}

}  // namespace aabb
