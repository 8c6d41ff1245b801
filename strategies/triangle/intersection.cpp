module aabb.triangle.intersection;

import aabb.std;
import aabb.triangle.orientation_test;
import aabb.triangle.self_intersection;

#pragma clang fp contract(off) reassociate(off) reciprocal(off)  // see aabb.base:floating_point

namespace aabb {

namespace {

/// The corners of two triangles, by index: 0 to 2 of the first, 3 to 5 of the second.
using corner = int;
using corner_triple = vec3<corner>;

constexpr double unit = std::numeric_limits<double>::epsilon() / 2;

/// Corners as they are given, with exact predicates.
class given_corners {
public:
    given_corners(const triangle3d& s, const triangle3d& t) noexcept
        : s_(s), t_(t), signs_(s_, t_, extreme(std::ranges::min), extreme(std::ranges::max)) {}

    [[nodiscard]] const vec3d& operator[](corner i) const noexcept { return i < 3 ? s_[i] : t_[i - 3]; }
    /// A bound on the errors of coordinates.
    [[nodiscard]] static vec3d error() noexcept { return {}; }

    [[nodiscard]] int side(corner a, corner b, corner c, corner d) noexcept {
        return signs_.side((*this)[a], (*this)[b], (*this)[c], (*this)[d]);
    }
    [[nodiscard]] int turn(corner a, corner b, corner c, int axis) noexcept {
        return signs_.turn((*this)[a], (*this)[b], (*this)[c], axis);
    }
    /// The sign of a - b on an axis.
    [[nodiscard]] int order(corner a, corner b, int axis) const noexcept {
        const double p = (*this)[a][axis], q = (*this)[b][axis];
        return static_cast<int>(p > q) - static_cast<int>(p < q);
    }
    /// The determinant of `side`.
    [[nodiscard]] scaled_double volume(corner a, corner b, corner c, corner d) const noexcept {
        return exact_volume((*this)[a], (*this)[b], (*this)[c], (*this)[d]);
    }
    /// The determinant of `turn`.
    [[nodiscard]] scaled_double area(corner a, corner b, corner c, int axis) const noexcept {
        return exact_area((*this)[a], (*this)[b], (*this)[c], axis);
    }

private:
    [[nodiscard]] lanes<double> extreme(const auto& choose) const noexcept {
        vec3d result{};
        for (int k = 0; k < 3; ++k) result[k] = choose({s_[0][k], s_[1][k], s_[2][k], t_[0][k], t_[1][k], t_[2][k]});
        return coordinates(result);
    }

    const triangle3d& s_;
    const triangle3d& t_;
    orientations signs_;
};

/// The same in world coordinates R v + t, for exact predicates of vertices at poses; coordinates are rounded.
class world_corners {
public:
    world_corners(const pose_pair& poses, const triangle3d& s, const triangle3d& t) noexcept : signs_(poses, s, t) {}

    /// Computes the coordinates in the world, and per axis the greatest bound on their rounding errors: a coordinate is
    /// within 2^-52, 2 u, of the true one, or equal to it.
    void round() noexcept {
        for (corner i = 0; i < 6; ++i)
            for (int k = 0; k < 3; ++k) {
                const rounded_coordinate at = signs_.exact().coordinate(i, k);
                rounded_[static_cast<std::size_t>(i)][k] = at.value;
                if (!at.is_exact)
                    error_[k] =
                        std::max(error_[k], 2 * unit * std::abs(at.value) + std::numeric_limits<double>::denorm_min());
            }
    }
    [[nodiscard]] const vec3d& operator[](corner i) const noexcept { return rounded_[static_cast<std::size_t>(i)]; }
    [[nodiscard]] const vec3d& error() const noexcept { return error_; }

    [[nodiscard]] int side(corner a, corner b, corner c, corner d) noexcept {
        return signs_.side(at(a), at(b), at(c), at(d));
    }
    [[nodiscard]] int turn(corner a, corner b, corner c, int axis) noexcept {
        return signs_.turn(at(a), at(b), at(c), axis);
    }
    [[nodiscard]] int order(corner a, corner b, int axis) noexcept { return signs_.order(at(a), at(b), axis); }
    [[nodiscard]] scaled_double volume(corner a, corner b, corner c, corner d) noexcept {
        return signs_.exact().volume(a, b, c, d);
    }
    [[nodiscard]] scaled_double area(corner a, corner b, corner c, int axis) noexcept {
        return signs_.exact().area(a, b, c, axis);
    }

private:
    [[nodiscard]] const vec3d& at(corner i) const noexcept { return i < 3 ? signs_.s()[i] : signs_.t()[i - 3]; }

    posed_orientations signs_;  // about the first translation
    std::array<vec3d, 6> rounded_{};
    vec3d error_{};
};

/// A corner of an intersection: a corner of a triangle (`from` is `to`), or the point where the edge between two
/// corners crosses a plane or, in the projection along an axis, the line of an edge.
struct crossing {
    corner from, to;
    corner_triple other;  // corners of the plane, or of the line
    int axis;             // -1 for a plane
};

/// The intersection of two triangles before coordinates are computed.
class common_part {
public:
    void add_corner(corner p) { crossings_[size_++] = {p, p, {}, 0}; }
    void add_crossing(const crossing& c) { crossings_[size_++] = c; }
    /// Adds the point where the edge from a to b crosses a plane; a and b lie on different sides of it.
    void add_cut(corner a, corner b, int side_of_a, int side_of_b, const corner_triple& plane) {
        if (side_of_a == 0) return add_corner(a);
        if (side_of_b == 0) return add_corner(b);
        add_crossing({a, b, plane, -1});
    }

    [[nodiscard]] std::uint32_t size() const { return size_; }
    void reorder(const std::array<std::uint32_t, 6>& order) {
        const std::array<crossing, 6> before = crossings_;
        for (std::size_t i = 0; i < size_; ++i) crossings_[i] = before[order[i]];
    }
    [[nodiscard]] common_part as(intersection_kind kind) {
        kind_ = kind;
        return *this;
    }
    /// Derives the kind of a coplanar intersection from the number of corners.
    [[nodiscard]] common_part by_size() {
        using enum intersection_kind;
        return as(size_ == 0 ? none : size_ == 1 ? point : size_ == 2 ? segment : overlap);
    }

    [[nodiscard]] intersection_kind kind() const { return kind_; }

    /// Computes the coordinates, with the error bound that is derived at `intersection_of`. A crossing from a corner to
    /// itself is that corner; one without an axis is that of an edge with a plane; any other is that of two coplanar
    /// edges, in the projection along the axis.
    [[nodiscard]] triangle_intersection in_coordinates(auto& corners) const {
        triangle_intersection result;
        result.kind = kind_;
        result.error = corners.error();
        for (std::size_t i = 0; i < size_; ++i) {
            const auto& [from, to, other, axis] = crossings_[i];
            if (from == to)
                result.corners[result.size++] = corners[from];
            else if (axis < 0)
                add_crossing(result, corners, from, to, corners.volume(other[0], other[1], other[2], from),
                             corners.volume(other[0], other[1], other[2], to));
            else
                add_crossing(result, corners, from, to, corners.area(other[0], other[1], from, axis),
                             corners.area(other[0], other[1], to, axis));
        }
        return result;
    }

private:
    /// Adds the point where the edge from a to b crosses a plane or line, at signed distances p of a and q of b from
    /// it.
    static void add_crossing(triangle_intersection& result, const auto& corners, corner from, corner to,
                             scaled_double p, scaled_double q) {
        vec3d a = corners[from], b = corners[to];
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
            const double of_corners = corners.error()[k] * (1 + 16 * unit);
            const double bound = 8 * unit * (half_length + of_corners) + of_corners + unit * std::abs(at[k]) +
                                 std::numeric_limits<double>::denorm_min();
            if (a[k] != b[k] || of_corners != 0) result.error[k] = std::max(result.error[k], bound);
        }
        result.corners[result.size++] = at;
    }

    std::array<crossing, 6> crossings_{};
    std::uint32_t size_ = 0;
    intersection_kind kind_ = intersection_kind::none;
};

/// A triangle as a convex hull: three corners, or fewer if it has zero area.
struct hull {
    std::array<corner, 3> corners;
    std::size_t size;

    [[nodiscard]] std::span<const corner> distinct_corners() const { return std::span(corners).first(size); }
    [[nodiscard]] std::size_t edges() const { return size == 3 ? 3 : size - 1; }
    [[nodiscard]] corner from(std::size_t edge) const { return corners[edge]; }
    [[nodiscard]] corner to(std::size_t edge) const { return corners[(edge + 1) % size]; }
};

/// Constructs the intersection of two triangles by the signs of predicates.
template <class Corners>
class construction {
public:
    explicit construction(Corners& corners) : corners_(corners) {}

    /// Distinguishes coplanar triangles, those of zero area that cross a plane, and crossing triangles.
    /// @returns the intersection of triangles that are known to intersect
    [[nodiscard]] common_part common() {
        const hull g = hull_of(0), h = hull_of(3);
        // A zero-area triangle has no plane, so that all sides are zero.
        for (corner i = 0; i < 3; ++i) {
            sides_[static_cast<std::size_t>(i)] = corners_.side(3, 4, 5, i);
            sides_[static_cast<std::size_t>(3 + i)] = corners_.side(0, 1, 2, 3 + i);
        }
        const bool s_on_t = side(0) == 0 && side(1) == 0 && side(2) == 0;
        const bool t_on_s = side(3) == 0 && side(4) == 0 && side(5) == 0;
        if (s_on_t && t_on_s) return coplanar(g, h);
        if (t_on_s) return segment_through(g, second);
        if (s_on_t) return segment_through(h, first);
        return crossing_triangles();
    }

private:
    static constexpr corner_triple first{0, 1, 2}, second{3, 4, 5};

    [[nodiscard]] int side(corner i) const { return sides_[static_cast<std::size_t>(i)]; }
    [[nodiscard]] bool are_equal(corner p, corner q) {
        return corners_.order(p, q, 0) == 0 && corners_.order(p, q, 1) == 0 && corners_.order(p, q, 2) == 0;
    }
    [[nodiscard]] bool is_straight(corner a, corner b, corner c) {
        return corners_.turn(a, b, c, 0) == 0 && corners_.turn(a, b, c, 1) == 0 && corners_.turn(a, b, c, 2) == 0;
    }

    /// Reduces the triangle that begins at a corner to a segment or point if it has zero area.
    [[nodiscard]] hull hull_of(corner begin) {
        if (!is_straight(begin, begin + 1, begin + 2)) return {{begin, begin + 1, begin + 2}, 3};
        // On a line, the lexicographic order of points is their order along it.
        const auto precedes = [&](corner p, corner q) {
            for (int k = 0; k < 3; ++k)
                if (const int order = corners_.order(p, q, k); order != 0) return order < 0;
            return false;
        };
        const corner low = std::ranges::min({begin, begin + 1, begin + 2}, precedes);
        const corner high = std::ranges::max({begin, begin + 1, begin + 2}, precedes);
        return {{low, high, high}, are_equal(low, high) ? std::size_t{1} : 2};
    }

    // Coplanar hulls, projected along an axis along which their plane is not edge-on. Bit masks say on which edges'
    // lines a point lies: bits 0 to 2 are edges of the first hull, bits 3 to 5 those of the second.

    [[nodiscard]] bool is_between(corner p, corner a, corner b) {
        for (int k = 0; k < 3; ++k)
            if (corners_.order(p, a, k) * corners_.order(p, b, k) > 0) return false;
        return true;
    }
    /// Whether p, which is coplanar with the hull, lies in it.
    [[nodiscard]] bool contains(const hull& h, corner p, int axis) {
        if (h.size == 1) return are_equal(p, h.corners[0]);
        if (h.size == 2)
            return corners_.turn(h.from(0), h.to(0), p, axis) == 0 && is_between(p, h.corners[0], h.corners[1]);
        const int inside = corners_.turn(h.corners[0], h.corners[1], h.corners[2], axis);
        for (std::size_t i = 0; i < 3; ++i)
            if (corners_.turn(h.from(i), h.to(i), p, axis) == -inside) return false;
        return true;
    }
    [[nodiscard]] bool is_corner_of(const hull& h, corner p) {
        return std::ranges::any_of(h.distinct_corners(), [&](corner q) { return are_equal(p, q); });
    }
    /// The mask of the hull's edges whose lines contain p.
    [[nodiscard]] unsigned edges_through(const hull& h, corner p, int axis) {
        unsigned edges = 0;
        for (std::size_t i = 0; i < h.edges(); ++i)
            if (corners_.turn(h.from(i), h.to(i), p, axis) == 0) edges |= 1U << i;
        return edges;
    }

    /// Intersects two coplanar hulls. The corners are those of one hull that lie in the other, and the proper crossings
    /// of edges. They are distinct, and none lies between two others. `lines` are masks of the edges on whose lines
    /// they lie: bit i for edge i of g, bit 3 + i for edge i of h.
    [[nodiscard]] common_part flat(const hull& g, const hull& h, int axis) {
        common_part common;
        std::array<unsigned, 6> lines{};
        const auto add = [&](corner p) {
            lines[common.size()] = edges_through(g, p, axis) | edges_through(h, p, axis) << 3;
            common.add_corner(p);
        };
        for (const corner p : g.distinct_corners())
            if (contains(h, p, axis)) add(p);
        for (const corner p : h.distinct_corners())
            if (!is_corner_of(g, p) && contains(g, p, axis)) add(p);
        for (std::size_t i = 0; i < g.edges(); ++i)
            for (std::size_t j = 0; j < h.edges(); ++j) {
                const corner a = g.from(i), b = g.to(i), c = h.from(j), d = h.to(j);
                if (corners_.turn(c, d, a, axis) * corners_.turn(c, d, b, axis) >= 0 ||
                    corners_.turn(a, b, c, axis) * corners_.turn(a, b, d, axis) >= 0)
                    continue;
                lines[common.size()] = 1U << i | 8U << j;
                common.add_crossing({a, b, {c, d, d}, axis});
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
    [[nodiscard]] common_part coplanar(const hull& g, const hull& h) {
        const hull& larger = g.size >= h.size ? g : h;
        const hull& other = g.size >= h.size ? h : g;
        for (int axis = 0; axis < 3; ++axis) {
            // Two crossing segments span a plane; otherwise everything is on one line.
            const bool is_flat = larger.size == 3
                                     ? corners_.turn(larger.corners[0], larger.corners[1], larger.corners[2], axis) == 0
                                     : std::ranges::all_of(other.distinct_corners(), [&](corner p) {
                                           return corners_.turn(larger.corners[0], larger.corners[1], p, axis) == 0;
                                       });
            if (!is_flat) return flat(g, h, axis);
        }
        common_part common;
        for (const corner p : g.distinct_corners())
            if (is_between(p, h.corners[0], h.corners[1])) common.add_corner(p);
        for (const corner p : h.distinct_corners())
            if (!is_corner_of(g, p) && is_between(p, g.corners[0], g.corners[1])) common.add_corner(p);
        return common.by_size();
    }

    /// Intersects a segment with a triangle whose plane it crosses in one point. A corner on the segment is exact.
    [[nodiscard]] common_part segment_through(const hull& segment, const corner_triple& t) {
        const corner a = segment.corners[0], b = segment.corners[1];
        common_part common;
        for (const corner p : t.at)
            if (is_straight(a, b, p)) {
                common.add_corner(p);
                return common.as(intersection_kind::point);
            }
        common.add_cut(a, b, side(a), side(b), t);
        return common.as(intersection_kind::point);
    }

    /// Intersects triangles with area in different planes: the overlap of their intervals on the common line. Each is
    /// flipped so that the other's apex lies above it; then the interval of s runs from the cut on edge 01 to that on
    /// edge 02, and the interval of t in the opposite direction.
    [[nodiscard]] common_part crossing_triangles() {
        const std::array s_to_t{side(0), side(1), side(2)}, t_to_s{side(3), side(4), side(5)};
        corner_triple s = first, t = second;
        const bool s_is_below = rotate_to_apex(s, s_to_t);
        const bool t_is_below = rotate_to_apex(t, t_to_s);
        if (t_is_below) std::swap(s[1], s[2]);
        if (s_is_below) std::swap(t[1], t[2]);
        // The cut on edge 0i is a corner.
        const auto is_corner = [&](const corner_triple& of, int i) { return side(of[0]) == 0 || side(of[i]) == 0; };
        // Compares the cut on edge 0i of s with that on edge 0j of t.
        const auto order = [&](int i, int j) { return corners_.side(s[0], s[i], t[0], t[j]); };
        const int low = order(1, 2);
        const int high = order(2, 1);
        const bool low_is_of_s = low > 0 || (low == 0 && is_corner(s, 1));
        const bool high_is_of_s = high < 0 || (high == 0 && is_corner(s, 2));
        const auto on_plane = [](const std::array<int, 3>& d) { return std::ranges::count(d, 0); };
        // The triangle touches the plane in one corner, with the others on one side.
        const auto is_point = [&](const std::array<int, 3>& d) { return on_plane(d) == 1 && d[0] + d[1] + d[2] != 0; };
        const bool is_single = low_is_of_s == high_is_of_s ? is_point(low_is_of_s ? s_to_t : t_to_s)
                               : low_is_of_s               ? order(1, 1) == 0
                                                           : order(2, 2) == 0;
        common_part common;
        const auto add = [&](const corner_triple& of, int end, const corner_triple& plane) {
            common.add_cut(of[0], of[end], side(of[0]), side(of[end]), plane);
        };
        low_is_of_s ? add(s, 1, second) : add(t, 2, first);
        if (is_single) return common.as(intersection_kind::point);
        high_is_of_s ? add(s, 2, second) : add(t, 1, first);
        const bool an_edge_touches = on_plane(s_to_t) == 2 || on_plane(t_to_s) == 2;
        return common.as(an_edge_touches ? intersection_kind::segment : intersection_kind::transversal);
    }

    Corners& corners_;
    std::array<int, 6> sides_{};  // of each corner to the plane of the other triangle
};

}  // namespace

triangle_intersection intersection_of(const triangle3d& s, const triangle3d& t) {
    require_ieee_arithmetic();
    // A shared corner is a hit, but the rest of the intersection must still be computed.
    if (!orientation_test<orientations>::intersects(s, t)) return {};
    given_corners corners(s, t);
    return construction(corners).common().in_coordinates(corners);
}

triangle_intersection intersection_of(const pose_pair& poses, const triangle3d& s, const triangle3d& t) {
    if (poses.a == pose{} && poses.b == pose{}) return intersection_of(s, t);
    require_ieee_arithmetic();
    if (!orientation_test<posed_orientations>::intersects(poses, s, t)) return {};
    world_corners corners(poses, s, t);
    const common_part common = construction(corners).common();  // decided by exact signs, without coordinates
    corners.round();
    return common.in_coordinates(corners);
}

intersection_kind intersection_kind_of(const pose_pair& poses, const triangle3d& s, const triangle3d& t) {
    require_ieee_arithmetic();
    if (poses.a == poses.b) {  // a common map of full rank changes no kind
        // A filter decides that most neighbours share no more than a corner or an edge.
        const std::uint32_t shared = self_intersection::corner_sets(s, t).shared.size;
        if ((shared == 1 || shared == 2) && !self_intersection::intersects(s, t))
            return shared == 1 ? intersection_kind::point : intersection_kind::segment;
        if (!orientation_test<orientations>::intersects(s, t)) return intersection_kind::none;
        given_corners corners(s, t);
        return construction(corners).common().kind();
    }
    if (!orientation_test<posed_orientations>::intersects(poses, s, t)) return intersection_kind::none;
    world_corners corners(poses, s, t);
    return construction(corners).common().kind();
}

}  // namespace aabb
