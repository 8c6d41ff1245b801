module aabb.touching;

import aabb.triangle.intersection;

namespace aabb {

namespace {

constexpr std::uint32_t no_triangle = 0xffffffff;

/// An edge of a triangle between two positions.
struct triangle_edge {
    std::uint32_t low, high;
    bool goes_up;
    std::uint32_t triangle;
    std::uint8_t edge;
};

/// The triangles across the edges of each triangle; none where an edge does not join two, in opposite directions.
std::vector<std::array<std::uint32_t, 3>> neighbours_in(const mesh& m) {
    const std::vector<std::uint32_t> first = first_at_position(m);
    std::vector<triangle_edge> edges;
    for (std::uint32_t t = 0; t < m.triangle_count(); ++t)
        for (std::uint8_t i = 0; i < 3; ++i) {
            const std::uint32_t from = first[m.triangles[t][i]], to = first[m.triangles[t][(i + 1U) % 3]];
            edges.push_back({std::min(from, to), std::max(from, to), from < to, t, i});
        }
    const auto ends = [](const triangle_edge& e) { return std::uint64_t{e.low} << 32U | e.high; };
    std::ranges::sort(edges, {}, ends);
    std::vector<std::array<std::uint32_t, 3>> neighbours(m.triangles.size(), {no_triangle, no_triangle, no_triangle});
    for (std::size_t i = 0; i < edges.size();) {
        std::size_t end = i + 1;
        while (end < edges.size() && ends(edges[end]) == ends(edges[i])) ++end;
        const triangle_edge &p = edges[i], &q = edges[end - 1];
        if (end - i == 2 && p.goes_up != q.goes_up) {
            neighbours[p.triangle][p.edge] = q.triangle;
            neighbours[q.triangle][q.edge] = p.triangle;
        }
        i = end;
    }
    return neighbours;
}

bool has_area(const triangle3d& t) noexcept {
    for (int axis = 0; axis < 3; ++axis)
        if (exact_turn(t[0], t[1], t[2], axis) != 0) return true;
    return false;
}

/// Whether each component consists of triangles with area that are connected by edges of two triangles each.
std::vector<bool> are_manifold(const mesh& m, const surface_components& components,
                               std::span<const std::array<std::uint32_t, 3>> neighbours) {
    std::vector<bool> is_manifold(components.parts.size(), true), is_reached(m.triangles.size());
    std::vector<std::uint32_t> open;
    for (const surface_component& part : components.parts) {
        is_reached[part.first_triangle] = true;
        open.push_back(part.first_triangle);
    }
    while (!open.empty()) {
        const std::uint32_t t = open.back();
        open.pop_back();
        for (const std::uint32_t other : neighbours[t])
            if (other != no_triangle && !is_reached[other]) {
                is_reached[other] = true;
                open.push_back(other);
            }
    }
    for (std::uint32_t t = 0; t < m.triangle_count(); ++t) {
        const bool is_inner = std::ranges::find(neighbours[t], no_triangle) == neighbours[t].end();
        if (!is_reached[t] || !is_inner || !has_area(m.given_triangle(t)))
            is_manifold[components.of_triangles[t]] = false;
    }
    return is_manifold;
}

/// A corner of a triangle at a pose.
struct posed_triangle {
    triangle3d given{};
    const pose* at = nullptr;

    [[nodiscard]] posed_point corner(int i) const noexcept { return {&given[i], at}; }
};

exact_corners corners_of(const posed_triangle& s, const posed_triangle& t) {
    return exact_corners({s.corner(0), s.corner(1), s.corner(2), t.corner(0), t.corner(1), t.corner(2)});
}

/// The solid of one component near a point of its surface: half of space, or a wedge at an edge of the triangle.
struct local_solid {
    posed_triangle face;
    int edge = -1;             ///< the edge at which the wedge is; negative for half of space
    posed_triangle neighbour;  ///< the face across that edge
    int opposite = 0;          ///< its corner off the edge
    int facing = 0;            ///< 1 if the normal of the face points outwards, -1 if inwards

    /// The corners off the edge, in whose directions the surface leaves it; of one face alone, all of its corners.
    [[nodiscard]] std::vector<posed_point> sheets() const {
        if (edge < 0) return {face.corner(0), face.corner(1), face.corner(2)};
        return {face.corner((edge + 2) % 3), neighbour.corner(opposite)};
    }

    /// Whether a half-plane that begins at the edge, or a point of it, lies inside (1), outside (-1) or neither.
    [[nodiscard]] int side_of(const posed_point& p) const {
        if (edge < 0) {
            const exact_corners corners({face.corner(0), face.corner(1), face.corner(2), p, p, p});
            return -facing * corners.side(0, 1, 2, 3);
        }
        // Seen along the edge, the face's inside is clockwise of it, up to the neighbour.
        const exact_corners corners({face.corner(edge), face.corner((edge + 1) % 3), neighbour.corner(opposite),
                                     face.corner((edge + 2) % 3), p, p});
        return facing * in_sector(corners);
    }

private:
    enum class direction : std::int8_t { along_edge = -1, same, left, opposite, right };

    /// The direction of a point's half-plane about the edge from corner 0 to 1, relative to that of another point.
    [[nodiscard]] static direction direction_of(const exact_corners& corners, int from, int to) {
        const int side = corners.side(0, 1, from, to);
        if (side != 0) return side > 0 ? direction::left : direction::right;
        for (int axis = 0; axis < 3; ++axis) {
            const int turn = corners.turn(0, 1, from, axis);
            if (turn == 0) continue;
            const int other = corners.turn(0, 1, to, axis);
            return other == 0 ? direction::along_edge : other == turn ? direction::same : direction::opposite;
        }
        return direction::along_edge;
    }

    /// Whether the half-plane of point 4 lies in the sector to the left of point 2, up to point 3: 1 inside, -1
    /// outside, 0 on its border or on the edge itself.
    [[nodiscard]] static int in_sector(const exact_corners& corners) {
        const direction of_point = direction_of(corners, 2, 4);
        if (of_point == direction::along_edge || of_point == direction::same) return 0;
        const direction of_end = direction_of(corners, 2, 3);
        if (of_point != of_end) return of_point < of_end ? 1 : -1;
        return of_point == direction::opposite ? 0 : corners.side(0, 1, 4, 3);
    }
};

/// The edges of two triangles along which they touch, negative if none.
struct common_edge {
    int of_s = -1, of_t = -1;
};

/// Whether two collinear segments have more than a point in common.
bool overlap_on_line(const exact_corners& corners, int p, int q, int r, int s) {
    for (int axis = 0; axis < 3; ++axis) {
        const int order = corners.order(p, q, axis);
        if (order == 0) continue;
        const auto [low, high] = order < 0 ? std::pair(p, q) : std::pair(q, p);
        const auto [other_low, other_high] = corners.order(r, s, axis) < 0 ? std::pair(r, s) : std::pair(s, r);
        return corners.order(low, other_high, axis) < 0 && corners.order(other_low, high, axis) < 0;
    }
    return false;
}

bool are_collinear(const exact_corners& corners, int p, int q, int r) {
    for (int axis = 0; axis < 3; ++axis)
        if (corners.turn(p, q, r, axis) != 0) return false;
    return true;
}

/// The edges along which two triangles touch that share a segment, but no more.
common_edge common_edge_of(const posed_triangle& s, const posed_triangle& t) {
    const exact_corners corners = corners_of(s, t);
    std::array<bool, 3> s_on_plane{}, t_on_plane{};
    for (int i = 0; i < 3; ++i) {
        s_on_plane[static_cast<std::size_t>(i)] = corners.side(3, 4, 5, i) == 0;
        t_on_plane[static_cast<std::size_t>(i)] = corners.side(0, 1, 2, 3 + i) == 0;
    }
    common_edge common;
    const bool are_coplanar = s_on_plane[0] && s_on_plane[1] && s_on_plane[2];
    for (int i = 0; i < 3; ++i) {
        const auto next = static_cast<std::size_t>((i + 1) % 3);
        if (are_coplanar) {
            for (int j = 0; j < 3; ++j) {
                const int p = i, q = (i + 1) % 3, r = 3 + j, u = 3 + (j + 1) % 3;
                if (are_collinear(corners, p, q, r) && are_collinear(corners, p, q, u) &&
                    overlap_on_line(corners, p, q, r, u))
                    common = {i, j};
            }
            continue;
        }
        if (s_on_plane[static_cast<std::size_t>(i)] && s_on_plane[next]) common.of_s = i;
        if (t_on_plane[static_cast<std::size_t>(i)] && t_on_plane[next]) common.of_t = i;
    }
    return common;
}

}  // namespace

contact_relation contact_evidence::relation() const noexcept {
    if (crosses || (has_common && has_a_alone && has_b_alone)) return contact_relation::crossing;
    if (!has_common) return contact_relation::touching;
    if (has_a_alone) return contact_relation::b_inside_a;
    return has_b_alone ? contact_relation::a_inside_b : contact_relation::equal;
}

contact_judge::surface contact_judge::surface_of(const mesh& m, const surface_components& components, const pose& at) {
    surface of{&m, &components, at, neighbours_in(m), {}};
    const std::vector<bool> is_manifold = are_manifold(m, components, of.neighbours);
    const int mirrored = determinant_sign(at);
    for (std::size_t i = 0; i < components.parts.size(); ++i)
        of.facing.push_back(is_manifold[i] ? mirrored * components.parts[i].volume_sign : 0);
    return of;
}

contact_judge::contact_judge(const mesh& mesh_a, const surface_components& components_a, const pose& pose_a,
                             const mesh& mesh_b, const surface_components& components_b, const pose& pose_b)
    : a_(surface_of(mesh_a, components_a, pose_a)), b_(surface_of(mesh_b, components_b, pose_b)) {}

bool contact_judge::are_regular(index_pair components) const noexcept {
    return a_.facing[components.a] != 0 && b_.facing[components.b] != 0;
}

void contact_judge::add(index_pair hit) {
    const index_pair components{a_.components->of_triangles[hit.a], b_.components->of_triangles[hit.b]};
    contact_evidence& known = evidence_[components];
    if (known.crosses) return;
    const intersection_kind kind =
        intersection_kind_of({a_.at, b_.at}, a_.m->given_triangle(hit.a), b_.m->given_triangle(hit.b));
    known.crosses = kind == intersection_kind::transversal;
    if (!are_regular(components)) return;
    if (kind == intersection_kind::segment) add_along_edge(hit, known);
    if (kind == intersection_kind::overlap) add_overlap(hit, known);
}

/// Finds on which side of the other solid each surface leaves the segment that the triangles share.
void contact_judge::add_along_edge(index_pair hit, contact_evidence& known) const {
    const auto solid_at = [](const surface& of, std::uint32_t triangle) {
        local_solid solid;
        solid.face = {of.m->given_triangle(triangle), &of.at};
        solid.facing = of.facing[of.components->of_triangles[triangle]];
        return solid;
    };
    const auto add_neighbour = [](local_solid& solid, const surface& of, std::uint32_t triangle, int edge) {
        if (edge < 0) return;
        const std::uint32_t other = of.neighbours[triangle][static_cast<std::size_t>(edge)];
        const auto& back = of.neighbours[other];
        const auto from = static_cast<int>(std::ranges::find(back, triangle) - back.begin());
        solid.edge = edge;
        solid.neighbour = {of.m->given_triangle(other), &of.at};
        solid.opposite = (from + 2) % 3;
    };
    local_solid of_a = solid_at(a_, hit.a), of_b = solid_at(b_, hit.b);
    const common_edge common = common_edge_of(of_a.face, of_b.face);
    add_neighbour(of_a, a_, hit.a, common.of_s);
    add_neighbour(of_b, b_, hit.b, common.of_t);
    for (const posed_point& sheet : of_a.sheets()) {
        const int side = of_b.side_of(sheet);
        known.has_common |= side > 0;
        known.has_b_alone |= side > 0;
        known.has_a_alone |= side < 0;
    }
    for (const posed_point& sheet : of_b.sheets()) {
        const int side = of_a.side_of(sheet);
        known.has_common |= side > 0;
        known.has_a_alone |= side > 0;
        known.has_b_alone |= side < 0;
    }
}

/// Two faces that overlap have their solids on one side, or on both.
void contact_judge::add_overlap(index_pair hit, contact_evidence& known) const {
    const posed_triangle s{a_.m->given_triangle(hit.a), &a_.at}, t{b_.m->given_triangle(hit.b), &b_.at};
    const exact_corners corners = corners_of(s, t);
    for (int axis = 0; axis < 3; ++axis) {
        const int turn = corners.turn(0, 1, 2, axis);
        if (turn == 0) continue;
        const int facing_a = a_.facing[a_.components->of_triangles[hit.a]];
        const int facing_b = b_.facing[b_.components->of_triangles[hit.b]];
        const bool on_one_side = turn * facing_a == corners.turn(3, 4, 5, axis) * facing_b;
        known.has_common |= on_one_side;
        known.has_a_alone |= !on_one_side;
        known.has_b_alone |= !on_one_side;
        return;
    }
}

}  // namespace aabb
