export module aabb.containment:enclosure;

import aabb.local_detection;
import aabb.std;
import :components;
import :parity_ray;

export namespace aabb {

/// A mesh with its tree and its connected components, prepared for what it encloses and what encloses it.
template <TreePolicy Tree>
class enclosure {
public:
    /// @param m must outlive this object
    /// @throws input_error as the constructor of `model`
    template <TreeBuilder Builder>
    enclosure(const mesh& m, const Builder& builder, Tree tree = {})
        : surface_(m, builder, std::move(tree)), components_(components_of(m)) {}

    [[nodiscard]] const mesh& triangles() const noexcept { return surface_.triangles(); }
    [[nodiscard]] const model<Tree>& surface() const noexcept { return surface_; }
    [[nodiscard]] const surface_components& components() const noexcept { return components_; }
    [[nodiscard]] std::span<const surface_component> parts() const noexcept { return components_.parts; }
    [[nodiscard]] bool is_closed() const noexcept {
        return std::ranges::all_of(parts(), &surface_component::is_closed);
    }

    /// The closed components that enclose the start of a ray, ascending; nothing if it lies on one of them.
    /// @param is_asked whether a component matters
    template <class IsAsked>
    [[nodiscard]] std::optional<std::vector<std::uint32_t>> around(parity_ray ray, const IsAsked& is_asked) const {
        for (std::uint64_t attempt = 0;; ++attempt) {
            ray.aim(attempt);
            crossings seen = crossings_of(ray, is_asked);
            if (seen.starts_on) return std::nullopt;
            if (seen.is_clear) return odd_ones(std::move(seen.components));
        }
    }

private:
    /// What a ray crosses, up to the first triangle that makes it useless.
    struct crossings {
        bool is_clear = true;                        ///< no edge was met
        bool starts_on = false;                      ///< the ray starts on a component that matters
        std::vector<std::uint32_t> components = {};  ///< once per crossing
    };

    template <class IsAsked>
    [[nodiscard]] crossings crossings_of(const parity_ray& ray, const IsAsked& is_asked) const {
        const Tree& tree = surface_.tree();
        crossings seen;
        std::vector<typename Tree::cursor> open(1, surface_.root());
        while (!open.empty()) {
            const typename Tree::cursor node = open.back();
            open.pop_back();
            if (!ray.may_meet(tree.bounds(node))) continue;
            if (!tree.is_leaf(node)) {
                for (const typename Tree::cursor& child : tree.children(node, triangles())) open.push_back(child);
                continue;
            }
            const std::uint32_t triangle = tree.triangle(node);
            const std::uint32_t component = components_.of_triangles[triangle];
            if (!parts()[component].is_closed() || !is_asked(component)) continue;
            const ray_crossing crossing = ray.crossing(triangle);
            if (crossing == ray_crossing::crosses) seen.components.push_back(component);
            seen.is_clear = crossing != ray_crossing::unclear;
            seen.starts_on = crossing == ray_crossing::starts_on;
            if (!seen.is_clear || seen.starts_on) break;
        }
        return seen;
    }

    [[nodiscard]] static std::vector<std::uint32_t> odd_ones(std::vector<std::uint32_t> components) {
        std::ranges::sort(components);
        std::vector<std::uint32_t> odd;
        for (std::size_t i = 0; i < components.size();) {
            const std::size_t begin = i;
            while (i < components.size() && components[i] == components[begin]) ++i;
            if ((i - begin) % 2 != 0) odd.push_back(components[begin]);
        }
        return odd;
    }

    model<Tree> surface_;
    surface_components components_;
};

/// The pairs of components of which the first, of `inner`, lies inside the second, of `outer`, in ascending order. A
/// component that does not meet another one lies inside it if any of its vertices does: one ray per component of
/// `inner`. Components that are not closed have no inside.
/// @param meeting the pairs of components that share a point, ascending; they are left out
/// @throws input_error if components of another pair share a point that decides, and as `require_ieee_arithmetic`
template <TreePolicy Tree>
[[nodiscard]] std::vector<index_pair> enclosed_components(const enclosure<Tree>& inner, const pose& pose_of_inner,
                                                          const enclosure<Tree>& outer, const pose& pose_of_outer,
                                                          std::span<const index_pair> meeting = {}) {
    require_ieee_arithmetic();
    std::vector<index_pair> pairs;
    if (std::ranges::none_of(outer.parts(), &surface_component::is_closed)) return pairs;
    std::optional<relative_pose> to_outer;
    try {
        to_outer.emplace(pose_relative_to(outer.surface(), pose_of_outer, inner.surface(), pose_of_inner));
    } catch (const input_error&) {
        to_outer.reset();  // `inner` leaves the range of float in that frame, so that everything is decided exactly
    }
    const mesh& m = inner.triangles();
    for (std::uint32_t i = 0; i < inner.parts().size(); ++i) {
        const std::uint32_t vertex = m.triangles[inner.parts()[i].first_triangle][0];
        parity_ray ray(outer.triangles(), pose_of_outer, outer.surface().bounds(), m.given_vertex(vertex),
                       pose_of_inner);
        if (to_outer) ray.set_image((*to_outer)(m.vertices[vertex]), to_outer->image_error());
        if (ray.starts_outside()) continue;
        const auto is_asked = [&](std::uint32_t j) { return !std::ranges::binary_search(meeting, index_pair{i, j}); };
        const std::optional<std::vector<std::uint32_t>> around = outer.around(ray, is_asked);
        if (!around)
            throw input_error("vertex " + std::to_string(vertex) +
                              " of one mesh lies on the other, so that neither lies inside the other");
        for (const std::uint32_t j : *around) pairs.push_back({i, j});
    }
    return pairs;
}

/// How two meshes lie whose surfaces share no point. The solid of a mesh is what an odd number of its closed components
/// encloses.
enum class solid_relation : std::uint8_t {
    apart,          ///< their solids share no point
    a_inside_b,     ///< A and its solid lie in the solid of B
    b_inside_a,     ///< the other way round
    partly_inside,  ///< some components lie in the other's solid, others do not
    not_closed,     ///< a component that is not closed, and whose box meets that of the other mesh, leaves it open
};
inline constexpr std::array<std::string_view, 5> solid_relation_names = {"apart", "a_inside_b", "b_inside_a",
                                                                         "partly_inside", "not_closed"};
[[nodiscard]] constexpr std::string_view name_of(solid_relation relation) noexcept {
    return solid_relation_names[static_cast<std::uint8_t>(relation)];
}

struct enclosed_pairs {
    solid_relation relation = solid_relation::apart;
    std::vector<index_pair> a_inside_b;  ///< a component of A inside one of B, ascending
    std::vector<index_pair> b_inside_a;  ///< a component of B inside one of A (A's first), ascending
};

}  // namespace aabb

namespace aabb::detail {

/// Whether a component that is not closed might enclose something in a box, however it were closed within its own box.
[[nodiscard]] inline bool has_open_part(std::span<const surface_component> parts, const mesh& m, const pose& at,
                                        const box& world) {
    return std::ranges::any_of(parts, [&](const surface_component& part) {
        return !part.is_closed() && overlaps(world_bounds(part.bounds, at, m.frame), world);
    });
}

}  // namespace aabb::detail

export namespace aabb {

/// The relation of two meshes whose surfaces share no point, and of each pair of their components: two closed ones that
/// are not listed lie apart.
/// @throws input_error as `enclosed_components`
template <TreePolicy Tree>
[[nodiscard]] enclosed_pairs relation_of(const enclosure<Tree>& a, const pose& pose_a, const enclosure<Tree>& b,
                                         const pose& pose_b) {
    enclosed_pairs result;
    result.a_inside_b = enclosed_components(a, pose_a, b, pose_b);
    for (const auto [of_b, of_a] : enclosed_components(b, pose_b, a, pose_a)) result.b_inside_a.push_back({of_a, of_b});
    std::ranges::sort(result.b_inside_a);
    // The components inside the other's solid are those inside an odd number of its components.
    std::vector<std::uint32_t> around_a(a.parts().size()), around_b(b.parts().size());
    for (const index_pair p : result.a_inside_b) ++around_a[p.a];
    for (const index_pair p : result.b_inside_a) ++around_b[p.b];
    const auto is_odd = [](std::uint32_t count) { return count % 2 != 0; };
    const bool none_in_b = std::ranges::none_of(around_a, is_odd), none_in_a = std::ranges::none_of(around_b, is_odd);
    const box world_a = world_bounds(a.surface().bounds(), pose_a, a.triangles().frame);
    const box world_b = world_bounds(b.surface().bounds(), pose_b, b.triangles().frame);
    const bool a_is_open = detail::has_open_part(a.parts(), a.triangles(), pose_a, world_b);
    const bool b_is_open = detail::has_open_part(b.parts(), b.triangles(), pose_b, world_a);
    if (!b_is_open && none_in_a && std::ranges::all_of(around_a, is_odd))
        result.relation = solid_relation::a_inside_b;
    else if (!a_is_open && none_in_b && std::ranges::all_of(around_b, is_odd))
        result.relation = solid_relation::b_inside_a;
    else if (a_is_open || b_is_open)
        result.relation = solid_relation::not_closed;
    else if (!none_in_a || !none_in_b)
        result.relation = solid_relation::partly_inside;
    return result;
}

}  // namespace aabb
