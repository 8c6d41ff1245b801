module aabblab.files;

import :polygon;

// Floating-point expressions are evaluated as written: see aabb.base:floating_point.
#pragma clang fp contract(off) reassociate(off) reciprocal(off)

namespace aabblab {

namespace {

using aabb::vec3d;

constexpr auto sign_of = [](double x) { return static_cast<int>(x > 0) - static_cast<int>(x < 0); };

/// The index of the first key of the lexicographically least rotation of key(0), … key(count - 1): a start of the cycle
/// that does not depend on the given one (Shiloach, "Fast canonization of circular strings", 1981).
std::size_t least_rotation(std::size_t count, auto key) {
    // i and j are candidates for the start, and their first `equal` keys agree. All others below max(i, j) are out.
    std::size_t i = 0;
    std::size_t j = 1;
    std::size_t equal = 0;
    while (i < count && j < count && equal < count) {
        const auto a = key((i + equal) % count);
        const auto b = key((j + equal) % count);
        if (a == b) {
            ++equal;
            continue;
        }
        // The candidate with the greater key is out, and so is each start from there up to that key: as many steps
        // after the other candidate is a lesser start.
        (a < b ? j : i) += equal + 1;
        j += static_cast<std::size_t>(i == j);
        equal = 0;
    }
    return std::min(i, j);
}

}  // namespace

/// Adds a double exactly (Shewchuk's grow-expansion). The parts, in ascending order of magnitude, sum to the exact
/// value. x is added to each in turn and carries the rounded sum to the next, while the rounding error stays as a part.
void exact_sum::add(double x) {
    std::size_t kept = 0;
    for (const double part : parts_) {
        // sum + error is exactly x + part (Knuth's TwoSum).
        const double sum = x + part;
        const double rounded_part = sum - x;
        const double error = (x - (sum - rounded_part)) + (part - rounded_part);
        if (error != 0) parts_[kept++] = error;
        x = sum;
    }
    parts_.resize(kept);
    if (x != 0) parts_.push_back(x);
}

int exact_sum::sign() const noexcept {
    return parts_.empty() ? 0 : sign_of(parts_.back());
}

void exact_sum::set_difference_of_magnitudes(const exact_sum& a, const exact_sum& b) {
    parts_.clear();
    for (const double part : a.parts_) add(a.sign() * part);
    for (const double part : b.parts_) add(-b.sign() * part);
}

/// Replaces the fan of a concave polygon by an ear-clipping triangulation; the fan of a convex one is valid and stays.
/// @param triangles the fan from the first corner: (0, 1, 2), (0, 2, 3) and so on, as indices of `vertices`
polygon_shape polygon_cutter::cut(std::span<const aabb::vec3d> vertices,
                                  std::span<std::array<std::uint32_t, 3>> triangles) {
    corners_.clear();
    const auto add = [&](std::uint32_t vertex) { corners_.push_back({.p = vertices[vertex], .vertex = vertex}); };
    add(triangles.front()[0]);
    add(triangles.front()[1]);
    for (const auto& triangle : triangles) add(triangle[2]);
    if (distinct_corners() < 4) return polygon_shape::convex;
    const int orientation = project();  // 1 if the projected polygon is counter-clockwise, -1 if it is clockwise
    if (orientation == 0) return polygon_shape::no_normal;
    if (is_convex(orientation)) return polygon_shape::convex;
    // Ear clipping expects counter-clockwise order.
    if (orientation < 0) std::ranges::reverse(corners_);
    begin_at_least_corner();
    if (!cut_ears(triangles)) return polygon_shape::crosses_itself;
    if (orientation < 0)
        for (auto& [a, b, c] : triangles) std::swap(a, c);
    return polygon_shape::concave;
}

std::size_t polygon_cutter::distinct_corners() const noexcept {
    std::size_t count = 0;
    for (std::size_t i = 0; i < corners_.size(); ++i)
        count += static_cast<std::size_t>(corners_[i].p != corners_[i > 0 ? i - 1 : corners_.size() - 1].p);
    return count;
}

/// Chooses the axis along which the polygon is projected to two dimensions, so that its area remains large: the axis on
/// which Newell's normal, the sum of the cross products of consecutive corners, has its greatest component.
/// @returns the sign of that component: 1 if the projected polygon is counter-clockwise, 0 if the normal is zero
int polygon_cutter::project() {
    for (exact_sum& component : normal_) component.clear();
    double greatest = 0;
    for (const corner& c : corners_)
        for (const double x : c.p.at) greatest = std::max(greatest, std::abs(x));
    // Scales the greatest coordinate to about 2^500, so that sums of products do not overflow, and products of
    // coordinates down to 2^-900 times the greatest do not underflow.
    const int exponent = greatest == 0 ? 0 : 500 - std::ilogb(greatest);
    const auto scaled = [&](const vec3d& v) {
        return vec3d{std::ldexp(v[0], exponent), std::ldexp(v[1], exponent), std::ldexp(v[2], exponent)};
    };
    const auto add_product = [](exact_sum& sum, double x, double y) {
        const double product = x * y;
        sum.add(product);
        sum.add(__builtin_fma(x, y, -product));  // its rounding error, exactly
    };
    vec3d p = scaled(corners_.back().p);
    for (const corner& c : corners_) {
        const vec3d q = scaled(c.p);
        for (int k = 0; k < 3; ++k) {
            const int x = (k + 1) % 3, y = (k + 2) % 3;
            add_product(normal_[static_cast<std::size_t>(k)], p[x], q[y]);
            add_product(normal_[static_cast<std::size_t>(k)], -p[y], q[x]);
        }
        p = q;
    }
    std::size_t dominant = 0;  // the axis of the component of greatest magnitude; the first of equals
    for (std::size_t k = 1; k < 3; ++k) {
        difference_.set_difference_of_magnitudes(normal_[k], normal_[dominant]);
        if (difference_.sign() > 0) dominant = k;
    }
    axis_ = static_cast<int>(dominant);
    return normal_[dominant].sign();
}

/// Whether the projected polygon is convex: it never turns against the orientation (1: counter-clockwise, -1), and
/// winds around once, changing exactly twice between ascending and descending order (`precedes`).
bool polygon_cutter::is_convex(int orientation) const noexcept {
    const auto coincide = [&](const vec3d& a, const vec3d& b) { return !precedes(a, b) && !precedes(b, a); };
    const std::size_t n = corners_.size();
    std::size_t last = n - 1;
    while (coincide(corners_[last].p, corners_[0].p)) --last;
    const vec3d* a = &corners_[last].p;  // a, b, c: consecutive corners at different points
    const vec3d* b = &corners_[0].p;
    std::size_t direction_changes = 0;
    for (std::size_t i = 1; i <= n; ++i) {
        const vec3d& c = corners_[i % n].p;
        if (coincide(*b, c)) continue;
        const int turned = turn(*a, *b, c);
        const bool changes_direction = precedes(*a, *b) != precedes(*b, c);
        // Without a turn, a change of direction means that the boundary runs back along itself.
        if (turned == -orientation || (turned == 0 && changes_direction)) return false;
        direction_changes += static_cast<std::size_t>(changes_direction);
        a = b;
        b = &c;
    }
    return direction_changes == 2;
}

void polygon_cutter::begin_at_least_corner() {
    const auto key = [&](std::size_t i) {
        const corner& c = corners_[i];
        return std::tuple(c.p[0], c.p[1], c.p[2], c.vertex);
    };
    std::ranges::rotate(corners_, corners_.begin() + static_cast<std::ptrdiff_t>(least_rotation(corners_.size(), key)));
}

/// The exact sign of the projected area of a, b, c: 1 if the path turns left at b, -1 right, 0 if collinear.
int polygon_cutter::turn(const vec3d& a, const vec3d& b, const vec3d& c) const noexcept {
    const int x = (axis_ + 1) % 3, y = (axis_ + 2) % 3;
    const double left = (b[x] - a[x]) * (c[y] - a[y]);
    const double right = (b[y] - a[y]) * (c[x] - a[x]);
    // Shewchuk's error bound of orient2d. Where the difference is within the bound, or the products may overflow or
    // underflow, exact arithmetic decides.
    constexpr double unit = std::numeric_limits<double>::epsilon() / 2;
    const double error = (3 + 16 * unit) * unit * (std::abs(left) + std::abs(right));
    const double turned = left - right;
    return std::abs(turned) > error && error > 0x1p-900 ? sign_of(turned) : aabb::exact_turn(a, b, c, axis_);
}

bool polygon_cutter::precedes(const vec3d& a, const vec3d& b) const noexcept {
    const int x = (axis_ + 1) % 3, y = (axis_ + 2) % 3;
    return a[x] < b[x] || (a[x] == b[x] && a[y] < b[y]);
}

void polygon_cutter::link_neighbours() noexcept {
    const auto n = static_cast<std::uint32_t>(corners_.size());
    for (std::uint32_t i = 0; i < n; ++i) {
        corners_[i].before = i > 0 ? i - 1 : n - 1;
        corners_[i].next = i + 1 < n ? i + 1 : 0;
    }
}

int polygon_cutter::turn_at(const corner& b) const noexcept {
    return turn(corners_[b.before].p, b.p, corners_[b.next].p);
}

bool polygon_cutter::is_needle(const corner& b) const noexcept {
    const vec3d& a = corners_[b.before].p;
    const vec3d& c = corners_[b.next].p;
    const bool goes_on = (precedes(a, b.p) && precedes(b.p, c)) || (precedes(c, b.p) && precedes(b.p, a));
    return !goes_on && turn(a, b.p, c) == 0;
}

/// Classifies a corner b at which the boundary turns left, by its triangle t0, t1, t2: the corner before, b, the next.
/// It is an ear if the triangle lies in the polygon: no edge of the boundary enters the triangle's interior, and the
/// boundary winds once around it. An ear is `touched` if another corner lies on the triangle's boundary. The winding
/// number counts edges below a point, so edges above the triangle's bounding box, or beside it, are skipped.
polygon_cutter::ear polygon_cutter::kind_of(const corner& b) const noexcept {
    const int x = (axis_ + 1) % 3, y = (axis_ + 2) % 3;
    const vec3d& t0 = corners_[b.before].p;
    const vec3d& t1 = b.p;
    const vec3d& t2 = corners_[b.next].p;
    const auto [low_x, high_x] = std::minmax({t0[x], t1[x], t2[x]});
    const auto [low_y, high_y] = std::minmax({t0[y], t1[y], t2[y]});
    // The edge pq has a point inside the triangle, if no side of the triangle has p and q both beyond it, and the line
    // pq has corners of the triangle on both sides.
    const auto enters = [&](const vec3d& p, const vec3d& q) {
        const auto is_beyond = [&](const vec3d& s, const vec3d& t) { return turn(s, t, p) <= 0 && turn(s, t, q) <= 0; };
        if (is_beyond(t0, t1) || is_beyond(t1, t2) || is_beyond(t2, t0)) return false;
        const std::array<int, 3> sides = {turn(p, q, t0), turn(p, q, t1), turn(p, q, t2)};
        return std::ranges::min(sides) < 0 && std::ranges::max(sides) > 0;
    };
    // The winding number is taken at a point inside the triangle, as near to t1 as needed and nearest to the edge to
    // t0. A ray from it downwards crosses edges that run to the right (counted 1) or to the left (counted -1). It
    // crosses an edge that lies below the point and whose ends, low before high by `precedes`, have the point between
    // them: low <= t1 < high if the point comes just after t1 in this order, low < t1 <= high if just before.
    const bool is_right_of_corner = precedes(t1, t0);
    int winding = 0;
    const auto count_below = [&](const vec3d& p, const vec3d& q) {
        const bool is_forward = precedes(p, q);
        const vec3d& low = is_forward ? p : q;
        const vec3d& high = is_forward ? q : p;
        if (is_right_of_corner ? precedes(t1, low) || !precedes(t1, high) : !precedes(low, t1) || precedes(high, t1))
            return;
        // If the edge passes through t1, the other corners decide on which side of it the triangle lies.
        int side = turn(low, high, t1);
        if (side == 0) side = turn(low, high, t0);
        if (side == 0) side = turn(low, high, t2);
        if (side > 0) winding += is_forward ? 1 : -1;
    };
    const auto touches = [&](const vec3d& p) {
        return turn(t0, t1, p) >= 0 && turn(t1, t2, p) >= 0 && turn(t2, t0, p) >= 0 && p != t0 && p != t1 && p != t2;
    };
    // First the two edges at b, then the rest of the boundary, from t2 to t0.
    count_below(t0, t1);
    count_below(t1, t2);
    ear kind = ear::clear;
    const vec3d* p = &t2;
    for (std::uint32_t i = b.next; i != b.before;) {
        i = corners_[i].next;
        const vec3d* q = &corners_[i].p;
        const vec3d& from = *std::exchange(p, q);
        // Fast path: most edges lie to the left, to the right or above.
        if (std::max(from[x], (*q)[x]) < low_x || std::min(from[x], (*q)[x]) > high_x ||
            std::min(from[y], (*q)[y]) > high_y)
            continue;
        if (std::max(from[y], (*q)[y]) >= low_y) {
            if (enters(from, *q)) return ear::none;
            if (touches(*q)) kind = ear::touched;
        }
        count_below(from, *q);
    }
    return winding == 1 ? kind : ear::none;
}

/// Cuts corners off the counter-clockwise polygon, each with a triangle inside it, until three are left: ears, and
/// needles, at which the boundary stops or runs back, so that the triangle has no area.
/// @param triangles receives the triangles, n - 2 for n corners
/// @returns false if the boundary crosses itself, as then no corner can be cut
bool polygon_cutter::cut_ears(std::span<std::array<std::uint32_t, 3>> triangles) {
    link_neighbours();
    std::size_t remaining = corners_.size();
    const auto cut_corner = [&](std::uint32_t i) {
        const corner& b = corners_[i];
        corner& a = corners_[b.before];
        corner& c = corners_[b.next];
        // Cut k, from 0, fills triangle k, as n - k of the n = triangles.size() + 2 corners remain.
        triangles[triangles.size() + 2 - remaining] = {a.vertex, b.vertex, c.vertex};
        a.next = b.next;
        c.before = b.before;
        a.kind = c.kind = ear::unknown;
        --remaining;
    };
    // Needles are cut first, as they may block ears. `passed` counts corners in a row that are none; a cut may turn its
    // two neighbours into needles, so these are visited again.
    std::uint32_t at = 0;
    for (std::size_t passed = 0; remaining > 3 && passed < remaining;)
        if (is_needle(corners_[at])) {
            cut_corner(at);
            at = corners_[at].before;
            passed -= std::min<std::size_t>(passed, 2);
        } else {
            at = corners_[at].next;
            ++passed;
        }
    // Then ears are cut; `passed` counts the corners since the last cut. A corner can become an ear only when a
    // neighbour is cut, so its kind is kept until then.
    for (std::size_t passed = 0; remaining > 3;) {
        corner& b = corners_[at];
        // If no clear ear is left, the second round also cuts touched ears and corners in the middle of an edge.
        const bool is_second_round = passed >= remaining;
        const int turned = turn_at(b);  // a corner that turns right is never cut
        if (turned > 0 && (b.kind == ear::unknown || (is_second_round && b.kind == ear::touched))) b.kind = kind_of(b);
        const bool is_ready = turned == 0  ? is_second_round || is_needle(b)
                              : turned > 0 ? b.kind == ear::clear || (is_second_round && b.kind == ear::touched)
                                           : false;
        if (is_ready) {
            cut_corner(at);
            // Skipping a corner avoids a fan of ears around a single corner.
            at = corners_[b.next].next;
            passed = 0;
        } else {
            at = b.next;
            if (++passed > 2 * remaining) return false;
        }
    }
    const corner& last = corners_[at];
    if (turn_at(last) < 0) return false;
    triangles.back() = {corners_[last.before].vertex, last.vertex, corners_[last.next].vertex};
    return true;
}

}  // namespace aabblab
