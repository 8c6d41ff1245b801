/// How the solids of two surfaces lie that share points.
export module aabb.touching;

export import aabb.containment;

import aabb.std;
import aabb.triangle.exact;
import aabb.triangle.self_intersection;

export namespace aabb {

/// How two closed components lie whose surfaces share a point, by the volumes of their solids.
enum class contact_relation : std::uint8_t {
    touching,    ///< they have no volume in common
    a_inside_b,  ///< A lies in B, and touches its surface from inside
    b_inside_a,  ///< the other way round
    equal,       ///< they are one solid
    crossing,    ///< they have some volume in common, and each has some alone
    undecided    ///< a component is no closed oriented manifold, intersects itself, or has all vertices on the other
};
inline constexpr std::array<std::string_view, 6> contact_relation_names = {"touching", "a_inside_b", "b_inside_a",
                                                                           "equal",    "crossing",   "undecided"};
[[nodiscard]] constexpr std::string_view name_of(contact_relation relation) noexcept {
    return contact_relation_names[static_cast<std::uint8_t>(relation)];
}

struct component_contact {
    std::uint32_t a;
    std::uint32_t b;
    contact_relation relation;

    friend bool operator==(const component_contact&, const component_contact&) = default;
};

/// The triangles across the edges of a surface. A triangle with two corners at one position is left out, so that its
/// neighbours share an edge.
class surface_topology {
public:
    static constexpr std::uint32_t no_triangle = 0xffffffff;

    /// Takes O(n log n) time.
    surface_topology(const mesh& m, const surface_components& components);

    /// By edge of a triangle, of which edge i begins at corner i; `no_triangle` where an edge does not join two
    /// triangles in opposite directions.
    [[nodiscard]] const std::array<std::uint32_t, 3>& neighbours(std::uint32_t triangle) const noexcept {
        return neighbours_[triangle];
    }
    /// Whether the triangles of a component have area and are connected by edges of two triangles each.
    [[nodiscard]] bool is_manifold(std::uint32_t component) const noexcept { return is_manifold_[component]; }

private:
    void find_neighbours(const mesh& m, const surface_components& components);
    void find_manifolds(const mesh& m, const surface_components& components);

    std::vector<std::array<std::uint32_t, 3>> neighbours_;
    std::vector<bool> is_manifold_;
};

/// A mesh prepared for `contacts_of` at any poses. What only some contacts need is computed with the first of these.
template <TreePolicy Tree>
class contact_surface {
public:
    /// @param solid must outlive this object
    explicit contact_surface(const enclosure<Tree>& solid) : solid_(&solid) {}

    [[nodiscard]] const enclosure<Tree>& solid() const noexcept { return *solid_; }
    [[nodiscard]] const surface_topology& topology() {
        if (!topology_) topology_.emplace(solid_->triangles(), solid_->components());
        return *topology_;
    }
    /// Whether triangles of one component intersect each other (`self_intersection`).
    [[nodiscard]] bool intersects_itself(std::uint32_t component) {
        if (self_intersecting_.empty()) find_self_intersections();
        return self_intersecting_[component];
    }
    /// By component; empty as long as no contact depended on it.
    [[nodiscard]] const std::vector<bool>& self_intersecting() const noexcept { return self_intersecting_; }

private:
    void find_self_intersections() {
        const mesh& m = solid_->triangles();
        const std::vector<std::uint32_t>& component_of = solid_->components().of_triangles;
        self_intersecting_.resize(solid_->parts().size());
        local_detection<Tree, exact_triangle> detection;
        detection.each_self_pair(solid_->surface(), [&](index_pair pair) {
            const std::uint32_t component = component_of[pair.a];
            if (component == component_of[pair.b] && !self_intersecting_[component])
                self_intersecting_[component] =
                    self_intersection::intersects(m.given_triangle(pair.a), m.given_triangle(pair.b));
            return false;  // continues
        });
    }

    const enclosure<Tree>* solid_;
    std::optional<surface_topology> topology_;
    std::vector<bool> self_intersecting_;
};

/// What hits of triangles show about two components. If triangles pass through each other, their surfaces cross. Else
/// the surfaces meet in points, along edges, and in polygons. Each connected part of one surface that is off the other
/// has a part of its border along an edge of either, unless they meet in points only, and lies inside or outside the
/// wedge of the other solid there: this is decided by signs of orientations at the edge, for each hit along an edge.
struct contact_evidence {
    bool crosses = false;            ///< triangles pass through each other
    bool has_edges = false;          ///< triangles share segments or polygons
    std::vector<index_pair> points;  ///< the hits, as long as all are points
    bool is_manifold = false;        ///< both are closed oriented manifolds that enclose a volume; unless `crosses`
    bool has_common = false, has_a_alone = false, has_b_alone = false;  ///< volume

    [[nodiscard]] bool is_empty() const noexcept { return !has_common && !has_a_alone && !has_b_alone; }
    [[nodiscard]] contact_relation relation() const noexcept;
};

/// Collects the evidence of hits, exactly, for vertices and poses as they are given.
class contact_judge {
public:
    /// A mesh at a pose, which must outlive the judge.
    struct surface {
        const mesh& m;
        const surface_components& components;
        const pose& at;
    };
    /// @param hits all pairs of triangles that share a point, of A and of B
    contact_judge(const surface& a, const surface& b, std::span<const index_pair> hits);

    /// Whether there are components of which no triangles pass through each other, so that `add_edges` says more.
    [[nodiscard]] bool has_open_cases() const noexcept;
    /// Finds out on which side of the other solid each surface leaves the segments and polygons that they share.
    void add_edges(const surface_topology& topology_a, const surface_topology& topology_b);

    /// By pair of components, ascending.
    [[nodiscard]] std::map<index_pair, contact_evidence>& evidence() noexcept { return evidence_; }

private:
    struct edge_hit {
        index_pair triangles;
        bool is_overlap;  ///< whether they share a polygon, else a segment
        contact_evidence* known;
    };

    surface a_, b_;
    std::map<index_pair, contact_evidence> evidence_;
    std::vector<edge_hit> edge_hits_;
};

}  // namespace aabb

namespace aabb::detail {

/// Whether a component of one mesh, which meets one of another in points only, lies inside it; nothing if all of its
/// vertices lie on it.
/// @param touched its triangles that share these points, ascending
template <TreePolicy Tree>
[[nodiscard]] std::optional<bool> lies_inside(const enclosure<Tree>& inner, std::uint32_t i,
                                              std::span<const std::uint32_t> touched, const enclosure<Tree>& outer,
                                              std::uint32_t j, const vertex_rays<Tree>& rays) {
    const auto is_inside = [&](std::uint32_t vertex) -> std::optional<bool> {
        const auto around = outer.around(rays(vertex), [j](std::uint32_t component) { return component == j; });
        if (!around) return std::nullopt;
        return !around->components.empty();
    };
    const std::span<const std::uint32_t> triangles = inner.components().triangles_of(i);
    const auto& corners = inner.triangles().triangles;
    // A triangle that is not touched has all its vertices off the other surface.
    if (const auto untouched = std::ranges::mismatch(triangles, touched).in1; untouched != triangles.end())
        return is_inside(corners[*untouched][0]);
    for (const std::uint32_t t : triangles)
        for (const std::uint32_t vertex : corners[t])
            if (const std::optional<bool> known = is_inside(vertex)) return known;
    return std::nullopt;
}

}  // namespace aabb::detail

export namespace aabb {

/// How the components of two meshes lie that share a point, ascending.
/// @param hits all pairs of intersecting triangles
/// @throws input_error as `require_ieee_arithmetic`
template <TreePolicy Tree>
[[nodiscard]] std::vector<component_contact> contacts_of(contact_surface<Tree>& a, const pose& pose_a,
                                                         contact_surface<Tree>& b, const pose& pose_b,
                                                         std::span<const index_pair> hits) {
    require_ieee_arithmetic();
    const enclosure<Tree>&solid_a = a.solid(), &solid_b = b.solid();
    contact_judge judge({solid_a.triangles(), solid_a.components(), pose_a},
                        {solid_b.triangles(), solid_b.components(), pose_b}, hits);
    std::optional<vertex_rays<Tree>> from_a, from_b;
    if (judge.has_open_cases()) {
        judge.add_edges(a.topology(), b.topology());
        from_a.emplace(solid_a, pose_a, solid_b, pose_b);
        from_b.emplace(solid_b, pose_b, solid_a, pose_a);
    }
    const auto touched = [](const contact_evidence& known, std::uint32_t index_pair::* mesh) {
        std::vector<std::uint32_t> triangles;
        for (const index_pair& hit : known.points) triangles.push_back(hit.*mesh);
        std::ranges::sort(triangles);
        triangles.erase(std::ranges::unique(triangles).begin(), triangles.end());
        return triangles;
    };
    std::vector<component_contact> contacts;
    for (auto& [components, known] : judge.evidence()) {
        const auto [i, j] = components;
        const bool is_decidable =
            known.crosses || (known.is_manifold && !a.intersects_itself(i) && !b.intersects_itself(j));
        if (is_decidable && !known.points.empty()) {
            const std::optional<bool> a_in_b =
                detail::lies_inside<Tree>(solid_a, i, touched(known, &index_pair::a), solid_b, j, *from_a);
            const std::optional<bool> b_in_a =
                detail::lies_inside<Tree>(solid_b, j, touched(known, &index_pair::b), solid_a, i, *from_b);
            // One inside the other has volume in common with it, and the other has some alone.
            known.has_common = a_in_b == true || b_in_a == true;
            const bool are_disjoint = a_in_b == false && b_in_a == false;
            known.has_a_alone = b_in_a == true || are_disjoint;
            known.has_b_alone = a_in_b == true || are_disjoint;
        }
        const bool is_known = is_decidable && (known.crosses || !known.is_empty());
        contacts.push_back({i, j, is_known ? known.relation() : contact_relation::undecided});
    }
    return contacts;
}

}  // namespace aabb
