export module aabb.triangle.self_intersection;

import aabb.std;
import aabb.triangle.orientation_test;

#pragma clang fp contract(off) reassociate(off) reciprocal(off)  // see aabb.base:floating_point

export namespace aabb {

/// Self-intersection of a mesh as meshing means it: two triangles intersect if they have more in common than the
/// corners that they share and the edge between two of these. Corners are shared where their coordinates are equal,
/// whatever their indices. Exact, also for triangles without area, which count as segments or points.
class self_intersection {
public:
    /// The distinct corners that two triangles share, and those that each has alone.
    struct corner_sets {
        explicit corner_sets(const triangle3d& s, const triangle3d& t) noexcept {
            for (const vec3d& corner : s.corner) (is_in(corner, t.corner) ? shared : of_s).add(corner);
            for (const vec3d& corner : t.corner)
                if (!is_in(corner, s.corner)) of_t.add(corner);
        }

        /// A list of at most three different corners.
        struct list {
            std::array<vec3d, 3> at;
            std::uint32_t size = 0;

            void add(const vec3d& corner) noexcept {
                if (std::find(at.begin(), at.begin() + size, corner) == at.begin() + size) at[size++] = corner;
            }
        };

        list shared, of_s, of_t;

    private:
        [[nodiscard]] static bool is_in(const vec3d& corner, const vec3d (&corners)[3]) noexcept {
            return corner == corners[0] || corner == corners[1] || corner == corners[2];
        }
    };

    /// Whether the triangles have more in common than the corners that they share and the edge between two of these.
    [[nodiscard]] static bool intersects(const triangle3d& s, const triangle3d& t) noexcept {
        if (are_clean_neighbours(s, t)) return false;  // a fast filter for the most frequent pairs
        const corner_sets corners(s, t);
        if (corners.shared.size == 0) return orientation_test<orientations>::intersects(s, t);
        if (corners.shared.size == 3) return has_area(s);
        // A triangle without a corner of its own is a shared point or edge.
        if (corners.of_s.size == 0 || corners.of_t.size == 0) return false;
        if (corners.shared.size == 2) return overlaps_beyond_edge(corners);
        return reaches(s, corners.of_s, t) || reaches(t, corners.of_t, s);
    }

    /// False if the corners of a triangle lie on a line.
    [[nodiscard]] static bool has_area(const triangle3d& t) noexcept {
        signs_of signs(t, t);
        for (int axis = 0; axis < 3; ++axis)
            if (signs.turn(t[0], t[1], t[2], axis) != 0) return true;
        return false;
    }

private:
    /// Decides most neighbours, by a filter in double: true if two triangles certainly have no more in common than one
    /// corner or edge. At a corner, the two others of one triangle lie strictly on one side of the other's plane; at an
    /// edge, it and the two other corners span a volume.
    [[nodiscard]] static bool are_clean_neighbours(const triangle3d& s, const triangle3d& t) noexcept {
        std::uint32_t equal = 0;  // bit 3 i + j for corner i of s and j of t
        for (int i = 0; i < 3; ++i)
            for (int j = 0; j < 3; ++j) equal |= std::uint32_t{s[i] == t[j]} << (3 * i + j);
        const int first = std::countr_zero(equal);
        const int second = std::countr_zero(equal & (equal - 1));
        const bool is_corner = std::popcount(equal) == 1;
        const bool is_edge = std::popcount(equal) == 2 && first / 3 != second / 3 && first % 3 != second % 3;
        if (!is_corner && !is_edge) return false;
        const vec3d& origin = s[first / 3];
        const auto from_origin = [&](const vec3d& p) { return p - origin; };
        // At an edge, `p` is its other end, `q` the corner of s (indices add up to 3) and `r` that of t.
        const vec3d p = from_origin(is_edge ? s[second / 3] : s[(first / 3 + 1) % 3]);
        const vec3d q = from_origin(is_edge ? s[3 - first / 3 - second / 3] : s[(first / 3 + 2) % 3]);
        const vec3d r = from_origin(is_edge ? t[3 - first % 3 - second % 3] : t[(first % 3 + 1) % 3]);
        const vec3d w = is_edge ? r : from_origin(t[(first % 3 + 2) % 3]);
        double extent = 0;
        for (const vec3d* v : {&p, &q, &r, &w})
            for (int k = 0; k < 3; ++k) extent = std::max(extent, std::abs((*v)[k]));
        if (!(extent >= 0x1p-200 && extent <= 0x1p200)) return false;
        // Six products of three differences, each at most E and rounded at most eight times: 6 ((1 + u)^8 - 1) E³ is
        // below 48.1 u E³. The rest covers the rounding of this product, and underflow.
        const double error = 50 * (std::numeric_limits<double>::epsilon() / 2) * extent * extent * extent;
        const auto are_on_one_side = [&](const vec3d& normal, const vec3d& a, const vec3d& b) {
            const double of_a = dot(normal, a), of_b = dot(normal, b);
            return (of_a > error && of_b > error) || (of_a < -error && of_b < -error);
        };
        return are_on_one_side(cross(p, q), r, w) || (is_corner && are_on_one_side(cross(r, w), p, q));
    }

    /// The exact signs of orientations of the corners of two triangles.
    struct signs_of : orientations {
        signs_of(const triangle3d& s, const triangle3d& t) noexcept : orientations(s, t, lowest(s, t), highest(s, t)) {}

    private:
        [[nodiscard]] static lanes<double> lowest(const triangle3d& s, const triangle3d& t) noexcept {
            return extreme(s, t, [](const auto& p, const auto& q) { return p < q ? p : q; });
        }
        [[nodiscard]] static lanes<double> highest(const triangle3d& s, const triangle3d& t) noexcept {
            return extreme(s, t, [](const auto& p, const auto& q) { return p > q ? p : q; });
        }
        [[nodiscard]] static lanes<double> extreme(const triangle3d& s, const triangle3d& t, auto choose) noexcept {
            lanes<double> result = coordinates(s[0]);
            for (const vec3d* corner : {&s[1], &s[2], &t[0], &t[1], &t[2]})
                result = choose(result, coordinates(*corner));
            return result;
        }
    };

    /// Two triangles at a shared edge overlap beyond it if they lie in one plane, on the same side of the edge.
    [[nodiscard]] static bool overlaps_beyond_edge(const corner_sets& corners) noexcept {
        const triangle3d s{{corners.shared.at[0], corners.shared.at[1], corners.of_s.at[0]}};
        const triangle3d t{{corners.shared.at[0], corners.shared.at[1], corners.of_t.at[0]}};
        signs_of signs(s, t);
        if (signs.side(s[0], s[1], s[2], t[2]) != 0) return false;
        for (int axis = 0; axis < 3; ++axis) {
            const int s_side = signs.turn(s[0], s[1], s[2], axis);
            const int t_side = signs.turn(s[0], s[1], t[2], axis);
            // One without area adds a segment of the edge's line, which the other has no part in.
            if (s_side != 0 || t_side != 0) return s_side == t_side;
        }
        // On one line: both extend the edge beyond the same end.
        const auto extends = [](const vec3d& from, const vec3d& end, const vec3d& p) {
            for (int k = 0; k < 3; ++k)
                if (from[k] != end[k]) return from[k] < end[k] ? p[k] > end[k] : p[k] < end[k];
            return false;
        };
        return (extends(s[0], s[1], s[2]) && extends(s[0], s[1], t[2])) ||
               (extends(s[1], s[0], s[2]) && extends(s[1], s[0], t[2]));
    }

    /// Whether a triangle meets another, with which it shares a single corner, by the edge opposite that corner:
    /// the line through the corner and any other common point leaves one of the two triangles first, at that edge.
    /// Without area, such an edge may contain the shared corner itself, and only its ends count.
    [[nodiscard]] static bool reaches(const triangle3d& s, const corner_sets::list& own, const triangle3d& t) noexcept {
        const vec3d& first = own.at[0];
        const vec3d& last = own.at[own.size - 1];
        if (!segment_meets(first, last, t)) return false;
        return own.size == 1 || has_area(s) || segment_meets(first, first, t) || segment_meets(last, last, t);
    }

    /// Whether the segment, or the point if both ends are equal, has a point in common with the triangle.
    [[nodiscard]] static bool segment_meets(const vec3d& p, const vec3d& q, const triangle3d& t) noexcept {
        const triangle3d edge{{p, q, q}};
        signs_of signs(edge, t);
        const int from = signs.side(t[0], t[1], t[2], edge[0]);
        const int to = signs.side(t[0], t[1], t[2], edge[1]);
        if (from == 0 && to == 0) return orientation_test<orientations>::intersects(edge, t);
        if (from == to) return false;
        // The edge meets the plane in a point, which is in the triangle if the edge passes all sides in one sense.
        bool left = false, right = false;
        for (int i = 0; i < 3; ++i) {
            const int passing = signs.side(edge[0], edge[1], t[i], t[(i + 1) % 3]);
            left |= passing > 0;
            right |= passing < 0;
        }
        return !(left && right);
    }
};

}  // namespace aabb
