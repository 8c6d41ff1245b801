module aabb.touching;

import aabb.triangle.intersection;

namespace aabb {

namespace {

/// An edge of a triangle, from the lower one of its positions.
struct triangle_edge {
    std::uint32_t high;
    std::uint32_t triangle;
    std::uint8_t edge;
    bool goes_up;
};

/// Whether two corners of a triangle lie at one position.
bool is_collapsed(const mesh& m, const surface_components& components, std::uint32_t triangle) noexcept {
    const auto& [p, q, r] = m.triangles[triangle];
    const std::vector<std::uint32_t>& at = components.positions;
    return at[p] == at[q] || at[q] == at[r] || at[r] == at[p];
}

}  // namespace

surface_topology::surface_topology(const mesh& m, const surface_components& components) {
    find_neighbours(m, components);
    find_manifolds(m, components);
}

void surface_topology::find_neighbours(const mesh& m, const surface_components& components) {
    const auto for_each_edge = [&](const auto& take) {
        for (std::uint32_t t = 0; t < m.triangle_count(); ++t) {
            if (is_collapsed(m, components, t)) continue;
            for (std::uint8_t i = 0; i < 3; ++i) {
                const std::uint32_t from = components.positions[m.triangles[t][i]];
                const std::uint32_t to = components.positions[m.triangles[t][(i + 1U) % 3]];
                take(std::min(from, to), triangle_edge{std::max(from, to), t, i, from < to});
            }
        }
    };
    // The edges of each lower end, by counting.
    std::vector<std::size_t> begins(m.vertices.size() + 2);
    for_each_edge([&](std::uint32_t low, const triangle_edge&) { ++begins[low + 2U]; });
    for (std::size_t v = 2; v < begins.size(); ++v) begins[v] += begins[v - 1];
    std::vector<triangle_edge> edges(begins.back());
    for_each_edge([&](std::uint32_t low, const triangle_edge& edge) { edges[begins[low + 1U]++] = edge; });
    neighbours_.assign(m.triangles.size(), {no_triangle, no_triangle, no_triangle});
    for (std::size_t low = 0; low < m.vertices.size(); ++low) {
        const std::span<triangle_edge> at_low = std::span(edges).subspan(begins[low], begins[low + 1] - begins[low]);
        std::ranges::sort(at_low, {}, &triangle_edge::high);
        for (std::size_t i = 0; i < at_low.size();) {
            std::size_t end = i + 1;
            while (end < at_low.size() && at_low[end].high == at_low[i].high) ++end;
            const triangle_edge &p = at_low[i], &q = at_low[end - 1];
            if (end - i == 2 && p.goes_up != q.goes_up) {
                neighbours_[p.triangle][p.edge] = q.triangle;
                neighbours_[q.triangle][q.edge] = p.triangle;
            }
            i = end;
        }
    }
}

void surface_topology::find_manifolds(const mesh& m, const surface_components& components) {
    std::vector<bool> is_reached(m.triangles.size());
    std::vector<std::uint32_t> open;
    for (std::uint32_t c = 0; c < components.parts.size(); ++c) {
        const std::span<const std::uint32_t> triangles = components.triangles_of(c);
        std::size_t connected = 0;
        for (const std::uint32_t first : triangles) {
            if (is_collapsed(m, components, first)) continue;
            is_reached[first] = true;
            open.push_back(first);
            break;
        }
        while (!open.empty()) {
            const std::uint32_t t = open.back();
            open.pop_back();
            ++connected;
            for (const std::uint32_t other : neighbours_[t])
                if (other != no_triangle && !is_reached[other]) {
                    is_reached[other] = true;
                    open.push_back(other);
                }
        }
        is_manifold_.push_back(connected > 0 && std::ranges::all_of(triangles, [&](std::uint32_t t) {
                                   if (is_collapsed(m, components, t)) return true;
                                   return is_reached[t] &&
                                          std::ranges::find(neighbours_[t], no_triangle) == neighbours_[t].end() &&
                                          self_intersection::has_area(m.given_triangle(t));
                               }));
    }
}

namespace {

/// The poses of two meshes.
struct two_poses {
    pose_pair poses;
    bool differ = poses.a != poses.b;  ///< else they do not matter, being one map of both meshes
};

/// Exact signs of orientations of the corners of two triangles, by index: 0 to 2 of the first one, 3 to 5 of the
/// second.
class corner_signs {
public:
    /// @param poses,s,t must outlive this object
    corner_signs(const two_poses& poses, const triangle3d& s, const triangle3d& t) : s_(s), t_(t) {
        if (poses.differ) posed_.emplace(poses.poses, s, t);
    }

    [[nodiscard]] int side(int a, int b, int c, int d) {
        return posed_ ? posed_->side(at(a), at(b), at(c), at(d)) : exact_side(at(a), at(b), at(c), at(d));
    }
    [[nodiscard]] int turn(int a, int b, int c, int axis) {
        return posed_ ? posed_->turn(at(a), at(b), at(c), axis) : exact_turn(at(a), at(b), at(c), axis);
    }
    /// The sign of a - b on an axis.
    [[nodiscard]] int order(int a, int b, int axis) {
        if (posed_) return posed_->order(at(a), at(b), axis);
        const double p = at(a)[axis], q = at(b)[axis];
        return static_cast<int>(p > q) - static_cast<int>(p < q);
    }

private:
    [[nodiscard]] const vec3d& at(int i) const {
        const triangle3d& of = i < 3 ? (posed_ ? posed_->s() : s_) : (posed_ ? posed_->t() : t_);
        return of[i % 3];
    }

    const triangle3d& s_;
    const triangle3d& t_;
    std::optional<posed_orientations> posed_;
};

/// The solid of one component near a triangle of its surface: half of space, or a wedge at an edge of the triangle.
class local_solid {
public:
    /// @param facing 1 if the normals of the mesh as given point outwards there, -1 if inwards
    /// @param poses of this mesh and of the other one, in this order; outlive this object
    /// @param mirrored -1 if the first of them is a mirror, else 1
    local_solid(const triangle3d& face, int facing, const two_poses& poses, int mirrored)
        : face_(face), facing_(facing * mirrored), mirrored_(mirrored), poses_(poses) {}

    /// Makes it the wedge at an edge of the face.
    /// @param off_edge the corner of the neighbour there
    void narrow(int edge, const vec3d& off_edge) {
        face_ = {{face_[edge], face_[(edge + 1) % 3], face_[(edge + 2) % 3]}};
        off_edge_ = off_edge;
        if (const int side = exact_side(face_[0], face_[1], off_edge, face_[2]); side != 0) {
            of_face_ = side == mirrored_ ? direction::left : direction::right;
            return;
        }
        for (int axis = 0; axis < 3; ++axis)
            if (const int turn = exact_turn(face_[0], face_[1], off_edge, axis); turn != 0)
                of_face_ =
                    exact_turn(face_[0], face_[1], face_[2], axis) == turn ? direction::same : direction::opposite;
    }

    /// Passes the corners off the edge, in whose directions the surface leaves it, to `take`; of one face alone, all of
    /// its corners.
    void each_sheet(const auto& take) const {
        if (off_edge_) {
            take(face_[2]);
            take(*off_edge_);
            return;
        }
        for (const vec3d& corner : face_.corner) take(corner);
    }

    /// Whether the half-plane from the edge through a vertex of the other mesh, or that vertex if there is no edge,
    /// lies inside (1), outside (-1) or neither.
    [[nodiscard]] int side_of(const vec3d& vertex) const {
        if (!poses_.differ && is_corner(vertex)) return 0;
        const triangle3d point{{vertex, vertex, vertex}};
        if (!off_edge_) return -facing_ * side_of_face(point);
        // Seen along the edge, the inside is the sector to the left of the neighbour, up to the face, or else the rest.
        const direction of_point = direction_from_neighbour(point);
        if (of_point == direction::along_edge || of_point == direction::same) return 0;
        if (of_point != of_face_) return of_point < of_face_ ? facing_ : -facing_;
        return of_point == direction::opposite ? 0 : -facing_ * side_of_face(point);
    }

private:
    /// Of a half-plane from the edge, relative to that of the neighbour.
    enum class direction : std::int8_t { along_edge = -1, same, left, opposite, right };

    [[nodiscard]] bool is_corner(const vec3d& vertex) const {
        return vertex == face_[0] || vertex == face_[1] || vertex == face_[2] || vertex == off_edge_;
    }
    [[nodiscard]] int side_of_face(const triangle3d& point) const {
        return corner_signs(poses_, face_, point).side(0, 1, 2, 3);
    }
    [[nodiscard]] direction direction_from_neighbour(const triangle3d& point) const {
        const triangle3d neighbour{{face_[0], face_[1], *off_edge_}};
        corner_signs signs(poses_, neighbour, point);
        const int side = signs.side(0, 1, 2, 3);
        if (side != 0) return side > 0 ? direction::left : direction::right;
        for (int axis = 0; axis < 3; ++axis) {
            const int turn = signs.turn(0, 1, 2, axis);
            if (turn == 0) continue;
            const int other = signs.turn(0, 1, 3, axis);
            return other == 0 ? direction::along_edge : other == turn ? direction::same : direction::opposite;
        }
        return direction::along_edge;
    }

    triangle3d face_;  // of a wedge, corners 0 and 1 are the edge
    int facing_;       // 1 if its normal points outwards where orientations are decided, -1 if inwards
    int mirrored_;
    const two_poses& poses_;
    std::optional<vec3d> off_edge_;
    direction of_face_ = direction::same;  // of the face, of a wedge
};

/// The edges of two triangles along which they touch, negative if none.
struct common_edge {
    int of_s = -1, of_t = -1;
};

/// Finds the edges along which two triangles touch that share a segment, but no more.
class edge_finder {
public:
    edge_finder(const two_poses& poses, const triangle3d& s, const triangle3d& t) : signs_(poses, s, t) {
        if (!poses.differ) find_equal(s, t);
    }

    [[nodiscard]] common_edge find() {
        if (equal_.of_s >= 0) return equal_;
        std::array<bool, 3> s_on_plane{}, t_on_plane{};
        for (int i = 0; i < 3; ++i) {
            s_on_plane[static_cast<std::size_t>(i)] = signs_.side(3, 4, 5, i) == 0;
            t_on_plane[static_cast<std::size_t>(i)] = signs_.side(0, 1, 2, 3 + i) == 0;
        }
        if (s_on_plane[0] && s_on_plane[1] && s_on_plane[2]) return in_one_plane();
        common_edge common;
        for (int i = 0; i < 3; ++i) {
            const auto from = static_cast<std::size_t>(i), to = static_cast<std::size_t>((i + 1) % 3);
            if (s_on_plane[from] && s_on_plane[to]) common.of_s = i;
            if (t_on_plane[from] && t_on_plane[to]) common.of_t = i;
        }
        return common;
    }

private:
    /// Finds an edge between two equal corners.
    void find_equal(const triangle3d& s, const triangle3d& t) {
        for (int i = 0; i < 3; ++i)
            for (int j = 0; j < 3; ++j) {
                const vec3d &p = s[i], &q = s[(i + 1) % 3], &r = t[j], &u = t[(j + 1) % 3];
                if ((p == r && q == u) || (p == u && q == r)) equal_ = {i, j};
            }
    }

    [[nodiscard]] common_edge in_one_plane() {
        for (int i = 0; i < 3; ++i)
            for (int j = 0; j < 3; ++j) {
                const int p = i, q = (i + 1) % 3, r = 3 + j, u = 3 + (j + 1) % 3;
                if (are_collinear(p, q, r) && are_collinear(p, q, u) && overlap_on_line(p, q, r, u)) return {i, j};
            }
        return {};
    }

    [[nodiscard]] bool are_collinear(int p, int q, int r) {
        for (int axis = 0; axis < 3; ++axis)
            if (signs_.turn(p, q, r, axis) != 0) return false;
        return true;
    }

    /// Whether two collinear segments have more than a point in common.
    [[nodiscard]] bool overlap_on_line(int p, int q, int r, int s) {
        for (int axis = 0; axis < 3; ++axis) {
            const int order = signs_.order(p, q, axis);
            if (order == 0) continue;
            const auto [low, high] = order < 0 ? std::pair(p, q) : std::pair(q, p);
            const auto [other_low, other_high] = signs_.order(r, s, axis) < 0 ? std::pair(r, s) : std::pair(s, r);
            return signs_.order(low, other_high, axis) < 0 && signs_.order(other_low, high, axis) < 0;
        }
        return false;
    }

    corner_signs signs_;
    common_edge equal_;
};

/// One of two meshes that share points, with the pose of the other.
struct solid_surface {
    const mesh& m;
    const surface_components& components;
    const surface_topology& topology;
    two_poses poses;  ///< its own, and that of the other
    int mirrored = poses.differ ? determinant_sign(poses.poses.a) : 1;

    [[nodiscard]] int facing(std::uint32_t triangle) const {
        return components.parts[components.of_triangles[triangle]].volume_sign;
    }
    /// The solid at an edge of a triangle, or at the triangle if there is none.
    [[nodiscard]] local_solid solid_at(std::uint32_t triangle, int edge) const {
        local_solid solid(m.given_triangle(triangle), facing(triangle), poses, mirrored);
        if (edge < 0) return solid;
        const std::uint32_t other = topology.neighbours(triangle)[static_cast<std::size_t>(edge)];
        const auto& back = topology.neighbours(other);
        const auto from = static_cast<int>(std::ranges::find(back, triangle) - back.begin());
        solid.narrow(edge, m.given_triangle(other)[(from + 2) % 3]);
        return solid;
    }
};

/// Finds on which side of the other solid each surface leaves the segment that two triangles share.
void add_along_edge(const solid_surface& a, const solid_surface& b, index_pair hit, contact_evidence& known) {
    const common_edge common = edge_finder(a.poses, a.m.given_triangle(hit.a), b.m.given_triangle(hit.b)).find();
    const local_solid of_a = a.solid_at(hit.a, common.of_s), of_b = b.solid_at(hit.b, common.of_t);
    of_a.each_sheet([&](const vec3d& sheet) {
        const int side = of_b.side_of(sheet);
        known.has_common |= side > 0;
        known.has_b_alone |= side > 0;
        known.has_a_alone |= side < 0;
    });
    of_b.each_sheet([&](const vec3d& sheet) {
        const int side = of_a.side_of(sheet);
        known.has_common |= side > 0;
        known.has_a_alone |= side > 0;
        known.has_b_alone |= side < 0;
    });
}

/// Two faces that overlap have their solids on one side, or on both.
void add_overlap(const solid_surface& a, const solid_surface& b, index_pair hit, contact_evidence& known) {
    const triangle3d of_a = a.m.given_triangle(hit.a), of_b = b.m.given_triangle(hit.b);
    corner_signs signs(a.poses, of_a, of_b);
    for (int axis = 0; axis < 3; ++axis) {
        const int turn = signs.turn(0, 1, 2, axis);
        if (turn == 0) continue;
        const bool on_one_side =
            turn * a.mirrored * a.facing(hit.a) == signs.turn(3, 4, 5, axis) * b.mirrored * b.facing(hit.b);
        known.has_common |= on_one_side;
        known.has_a_alone |= !on_one_side;
        known.has_b_alone |= !on_one_side;
        return;
    }
}

}  // namespace

contact_relation contact_evidence::relation() const noexcept {
    if (crosses || (has_common && has_a_alone && has_b_alone)) return contact_relation::crossing;
    if (!has_common) return contact_relation::touching;
    if (has_a_alone) return contact_relation::b_inside_a;
    return has_b_alone ? contact_relation::a_inside_b : contact_relation::equal;
}

contact_judge::contact_judge(const surface& a, const surface& b, std::span<const index_pair> hits) : a_(a), b_(b) {
    const pose_pair poses{a.at, b.at};
    index_pair components{};
    contact_evidence* known = nullptr;
    for (const index_pair hit : hits) {
        const index_pair of_hit{a.components.of_triangles[hit.a], b.components.of_triangles[hit.b]};
        if (known == nullptr || of_hit != components) {
            components = of_hit;
            known = &evidence_[components];
        }
        if (known->crosses) continue;
        const intersection_kind kind =
            intersection_kind_of(poses, a.m.given_triangle(hit.a), b.m.given_triangle(hit.b));
        if (kind == intersection_kind::point) {
            if (!known->has_edges) known->points.push_back(hit);
            continue;
        }
        known->crosses = kind == intersection_kind::transversal;
        // The neighbours of a collapsed triangle share the same segments.
        if (!known->crosses && (is_collapsed(a.m, a.components, hit.a) || is_collapsed(b.m, b.components, hit.b)))
            continue;
        known->has_edges = true;
        known->points.clear();
        if (!known->crosses) edge_hits_.push_back({hit, kind == intersection_kind::overlap, known});
    }
}

bool contact_judge::has_open_cases() const noexcept {
    return std::ranges::any_of(evidence_, [](const auto& entry) { return !entry.second.crosses; });
}

void contact_judge::add_edges(const surface_topology& topology_a, const surface_topology& topology_b) {
    for (auto& [components, known] : evidence_)
        known.is_manifold = topology_a.is_manifold(components.a) && topology_b.is_manifold(components.b) &&
                            a_.components.parts[components.a].volume_sign != 0 &&
                            b_.components.parts[components.b].volume_sign != 0;
    const solid_surface a{a_.m, a_.components, topology_a, {{a_.at, b_.at}}};
    const solid_surface b{b_.m, b_.components, topology_b, {{b_.at, a_.at}}};
    for (const edge_hit& hit : edge_hits_) {
        contact_evidence& known = *hit.known;
        const bool is_crossing = known.crosses || (known.has_common && known.has_a_alone && known.has_b_alone);
        if (is_crossing || !known.is_manifold) continue;
        hit.is_overlap ? add_overlap(a, b, hit.triangles, known) : add_along_edge(a, b, hit.triangles, known);
    }
}

}  // namespace aabb
