/// How the solids of two surfaces lie that share points.
export module aabb.touching;

export import aabb.containment;

import aabb.std;

export namespace aabb {

/// How two closed components lie whose surfaces share a point, by the volumes of their solids.
enum class contact_relation : std::uint8_t {
    touching,    ///< they have no volume in common
    a_inside_b,  ///< A lies in B, and touches its surface from inside
    b_inside_a,  ///< the other way round
    equal,       ///< they are one solid
    crossing,    ///< they have some volume in common, and each has some alone
    undecided    ///< a component is no closed oriented manifold, or intersects itself
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

/// What hits of triangles show about two components. If triangles pass through each other, their surfaces cross. Else
/// the surfaces meet in points, along edges, and in polygons. Each connected part of one surface that is off the other
/// has a part of its border along an edge of either, unless they meet in points only, and lies inside or outside the
/// wedge of the other solid there: this is decided by signs of orientations at the edge, for each hit along an edge.
struct contact_evidence {
    bool crosses = false;
    bool has_common = false, has_a_alone = false, has_b_alone = false;  ///< volume

    [[nodiscard]] bool is_empty() const noexcept { return !has_common && !has_a_alone && !has_b_alone; }
    [[nodiscard]] contact_relation relation() const noexcept;
};

/// Collects the evidence of hits, exactly, for vertices and poses as they are given.
class contact_judge {
public:
    /// @param mesh_a,mesh_b must outlive this object, as their components must
    contact_judge(const mesh& mesh_a, const surface_components& components_a, const pose& pose_a, const mesh& mesh_b,
                  const surface_components& components_b, const pose& pose_b);

    /// @param hit two triangles that share a point, of A and of B
    void add(index_pair hit);
    /// By pair of components, ascending.
    [[nodiscard]] const std::map<index_pair, contact_evidence>& evidence() const noexcept { return evidence_; }
    /// Whether both components are closed oriented manifolds that enclose a volume.
    [[nodiscard]] bool are_regular(index_pair components) const noexcept;

private:
    /// A mesh at a pose.
    struct surface {
        const mesh* m;
        const surface_components* components;
        pose at;
        std::vector<std::array<std::uint32_t, 3>> neighbours;  ///< by triangle and edge; edge i begins at corner i
        /// By component: 1 if its normals in world coordinates point outwards, -1 if inwards, 0 if it is not regular.
        std::vector<int> facing;
    };
    [[nodiscard]] static surface surface_of(const mesh& m, const surface_components& components, const pose& at);
    void add_along_edge(index_pair hit, contact_evidence& known) const;
    void add_overlap(index_pair hit, contact_evidence& known) const;

    surface a_, b_;
    std::map<index_pair, contact_evidence> evidence_;
};

/// How the components of two meshes lie that share a point, ascending.
/// @param hits all pairs of intersecting triangles
/// @param intersect_themselves whether either mesh does; then only crossings are decided
template <TreePolicy Tree>
[[nodiscard]] std::vector<component_contact> contacts_of(const enclosure<Tree>& a, const pose& pose_a,
                                                         const enclosure<Tree>& b, const pose& pose_b,
                                                         std::span<const index_pair> hits, bool intersect_themselves) {
    require_ieee_arithmetic();
    contact_judge judge(a.triangles(), a.components(), pose_a, b.triangles(), b.components(), pose_b);
    for (const index_pair hit : hits) judge.add(hit);
    // Whether a component, which meets the other in points only, lies inside it; nothing if all vertices are on it.
    const auto is_inside = [](const enclosure<Tree>& inner, const pose& at, std::uint32_t i,
                              const enclosure<Tree>& outer, const pose& outer_at, std::uint32_t j) {
        const mesh& m = inner.triangles();
        const auto is_asked = [j](std::uint32_t component) { return component == j; };
        for (std::uint32_t t = 0; t < m.triangle_count(); ++t) {
            if (inner.components().of_triangles[t] != i) continue;
            for (const std::uint32_t vertex : m.triangles[t]) {
                const parity_ray ray(outer.triangles(), outer_at, outer.surface().bounds(), m.given_vertex(vertex), at);
                if (const auto around = outer.around(ray, is_asked)) return std::optional(!around->empty());
            }
        }
        return std::optional<bool>();
    };
    std::vector<component_contact> contacts;
    for (const auto& [components, evidence] : judge.evidence()) {
        const auto [i, j] = components;
        contact_evidence known = evidence;
        const bool is_decidable = judge.are_regular(components) && !intersect_themselves;
        if (is_decidable && !known.crosses && known.is_empty()) {
            const std::optional<bool> a_in_b = is_inside(a, pose_a, i, b, pose_b, j);
            const std::optional<bool> b_in_a = is_inside(b, pose_b, j, a, pose_a, i);
            // One inside the other has volume in common with it, and the other has some alone.
            known.has_common = a_in_b == true || b_in_a == true;
            const bool are_disjoint = a_in_b == false && b_in_a == false;
            known.has_a_alone = b_in_a == true || are_disjoint;
            known.has_b_alone = a_in_b == true || are_disjoint;
        }
        const bool is_known = known.crosses || (is_decidable && !known.is_empty());
        contacts.push_back({i, j, is_known ? known.relation() : contact_relation::undecided});
    }
    return contacts;
}

}  // namespace aabb
