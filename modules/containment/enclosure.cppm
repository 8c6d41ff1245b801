export module aabb.containment:enclosure;

import aabb.local_detection;
import aabb.std;
import :components;
import :parity_ray;

export namespace aabb {

/// Where a point lies with respect to the solid of a mesh.
enum class solid_side : std::uint8_t {
    outside,
    inside,
    undecided  ///< outside by parity, but its winding number is not 0
};

/// What encloses a point that lies on no component.
struct surroundings {
    std::vector<std::uint32_t> components;  ///< the closed ones that enclose it, ascending
    int winding_number = 0;                 ///< of the oriented components around it, together
    bool are_oriented = true;               ///< whether those that enclose it are

    /// The winding number of an orientable surface is odd where parity says inside. Where it is even, but not 0,
    /// components that face the same way are nested or overlap, or one of them crosses itself: then the mesh does not
    /// say whether it means a cavity or one solid in another.
    [[nodiscard]] solid_side side() const noexcept {
        if (components.size() % 2 != 0) return solid_side::inside;
        return are_oriented && winding_number != 0 ? solid_side::undecided : solid_side::outside;
    }
};

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

    /// What encloses the start of a ray; nothing if it lies on a closed component that matters.
    /// @param is_asked whether a component matters
    template <class IsAsked>
    [[nodiscard]] std::optional<surroundings> around(parity_ray ray, const IsAsked& is_asked) const {
        for (std::uint64_t attempt = 0;; ++attempt) {
            ray.aim(attempt);
            crossings seen = crossings_of(ray, is_asked);
            if (seen.starts_on) return std::nullopt;
            if (seen.is_clear) return surroundings_of(std::move(seen.crossed));
        }
    }

private:
    struct crossing {
        std::uint32_t component;
        ray_crossing in;  ///< `leaves` or `enters`
    };
    /// What a ray crosses, up to the first triangle that makes it useless.
    struct crossings {
        bool is_clear = true;    ///< no edge was met
        bool starts_on = false;  ///< the ray starts on a component that matters
        std::vector<crossing> crossed = {};
    };

    template <class IsAsked>
    [[nodiscard]] crossings crossings_of(const parity_ray& ray, const IsAsked& is_asked) const {
        crossings seen;
        each_triangle_in(surface_, ray.reach(), [&](std::uint32_t triangle) {
            const std::uint32_t component = components_.of_triangles[triangle];
            if (!parts()[component].is_closed() || !is_asked(component)) return false;
            const ray_crossing in = ray.crossing(triangle);
            if (in == ray_crossing::leaves || in == ray_crossing::enters) seen.crossed.push_back({component, in});
            seen.is_clear = in != ray_crossing::unclear;
            seen.starts_on = in == ray_crossing::starts_on;
            return !seen.is_clear || seen.starts_on;
        });
        return seen;
    }

    [[nodiscard]] surroundings surroundings_of(std::vector<crossing> crossed) const {
        std::ranges::sort(crossed, {}, &crossing::component);
        surroundings result;
        for (std::size_t i = 0; i < crossed.size();) {
            const std::uint32_t component = crossed[i].component;
            const bool is_oriented = parts()[component].is_oriented;
            bool is_odd = false;
            for (; i < crossed.size() && crossed[i].component == component; ++i) {
                is_odd = !is_odd;
                if (is_oriented) result.winding_number += crossed[i].in == ray_crossing::leaves ? 1 : -1;
            }
            if (!is_odd) continue;
            result.components.push_back(component);
            result.are_oriented &= is_oriented;
        }
        return result;
    }

    model<Tree> surface_;
    surface_components components_;
};

/// Rays from the vertices of one mesh through the surface of another.
template <TreePolicy Tree>
class vertex_rays {
public:
    /// @param from,through must outlive this object
    vertex_rays(const enclosure<Tree>& from, const pose& pose_from, const enclosure<Tree>& through,
                const pose& pose_through)
        : from_(&from), through_(&through), pose_from_(pose_from), pose_through_(pose_through) {
        try {
            to_image_.emplace(pose_relative_to(through.surface(), pose_through, from.surface(), pose_from));
        } catch (const input_error&) {
            to_image_.reset();  // `from` leaves the range of float in that frame, so that everything is decided exactly
        }
    }

    [[nodiscard]] parity_ray operator()(std::uint32_t vertex) const {
        const mesh& m = from_->triangles();
        parity_ray ray(through_->triangles(), pose_through_, through_->surface().bounds(), m.given_vertex(vertex),
                       pose_from_);
        if (to_image_) ray.set_image((*to_image_)(m.vertices[vertex]), to_image_->image_error());
        return ray;
    }

private:
    const enclosure<Tree>* from_;
    const enclosure<Tree>* through_;
    pose pose_from_;
    pose pose_through_;
    std::optional<relative_pose> to_image_;
};

}  // namespace aabb

namespace aabb::detail {

/// Passes each component of `inner` that may lie in the box of `outer` to `take`, with what encloses it: a component
/// that does not meet another one lies inside it if any of its vertices does, so that one ray decides.
template <TreePolicy Tree, class Take>
void for_each_surrounded(const enclosure<Tree>& inner, const pose& pose_of_inner, const enclosure<Tree>& outer,
                         const pose& pose_of_outer, std::span<const index_pair> meeting, const Take& take) {
    require_ieee_arithmetic();
    if (std::ranges::none_of(outer.parts(), &surface_component::is_closed)) return;
    const vertex_rays<Tree> rays(inner, pose_of_inner, outer, pose_of_outer);
    for (std::uint32_t i = 0; i < inner.parts().size(); ++i) {
        const std::uint32_t vertex = inner.triangles().triangles[inner.parts()[i].first_triangle][0];
        const parity_ray ray = rays(vertex);
        if (ray.starts_outside()) continue;
        const auto is_asked = [&](std::uint32_t j) { return !std::ranges::binary_search(meeting, index_pair{i, j}); };
        const std::optional<surroundings> around = outer.around(ray, is_asked);
        if (!around)
            throw input_error("vertex " + std::to_string(vertex) +
                              " of one mesh lies on the other, so that neither lies inside the other");
        take(i, *around);
    }
}

/// Whether a component that is not closed might enclose something in a box, however it were closed within its own box.
[[nodiscard]] inline bool has_open_part(std::span<const surface_component> parts, const mesh& m, const pose& at,
                                        const box& world) {
    return std::ranges::any_of(parts, [&](const surface_component& part) {
        return !part.is_closed() && overlaps(world_bounds(part.bounds, at, m.frame), world);
    });
}

}  // namespace aabb::detail

export namespace aabb {

/// The pairs of components of which the first, of `inner`, lies inside the second, of `outer`, in ascending order.
/// Components that are not closed have no inside.
/// @param meeting the pairs of components that share a point, ascending; they are left out
/// @throws input_error if components of another pair share a point that decides, and as `require_ieee_arithmetic`
template <TreePolicy Tree>
[[nodiscard]] std::vector<index_pair> enclosed_components(const enclosure<Tree>& inner, const pose& pose_of_inner,
                                                          const enclosure<Tree>& outer, const pose& pose_of_outer,
                                                          std::span<const index_pair> meeting = {}) {
    std::vector<index_pair> pairs;
    detail::for_each_surrounded(inner, pose_of_inner, outer, pose_of_outer, meeting,
                                [&](std::uint32_t i, const surroundings& around) {
                                    for (const std::uint32_t j : around.components) pairs.push_back({i, j});
                                });
    return pairs;
}

/// How two meshes lie whose surfaces share no point. The solid of a mesh is where the parity of its closed components
/// says inside.
enum class solid_relation : std::uint8_t {
    disjoint,       ///< their solids share no point
    a_inside_b,     ///< A and its solid lie in the solid of B
    b_inside_a,     ///< the other way round
    partly_inside,  ///< some components lie in the other's solid, others do not
    not_closed,     ///< a component that is not closed, and whose box meets that of the other mesh, leaves it open
    undecided       ///< for a component, parity and winding number differ (`solid_side`)
};
inline constexpr std::array<std::string_view, 6> solid_relation_names = {"disjoint",      "a_inside_b", "b_inside_a",
                                                                         "partly_inside", "not_closed", "undecided"};
[[nodiscard]] constexpr std::string_view name_of(solid_relation relation) noexcept {
    return solid_relation_names[static_cast<std::uint8_t>(relation)];
}

struct enclosed_pairs {
    solid_relation relation = solid_relation::disjoint;
    std::vector<index_pair> a_inside_b;  ///< a component of A inside one of B, ascending
    std::vector<index_pair> b_inside_a;  ///< a component of B inside one of A (A's first), ascending
};

/// The relation of two meshes whose surfaces share no point, and of each pair of their components: two closed ones that
/// are not listed are disjoint.
/// @throws input_error as `enclosed_components`
template <TreePolicy Tree>
[[nodiscard]] enclosed_pairs relation_of(const enclosure<Tree>& a, const pose& pose_a, const enclosure<Tree>& b,
                                         const pose& pose_b) {
    enclosed_pairs result;
    std::vector<solid_side> of_a(a.parts().size()), of_b(b.parts().size());  // by component
    detail::for_each_surrounded(a, pose_a, b, pose_b, {}, [&](std::uint32_t i, const surroundings& around) {
        for (const std::uint32_t j : around.components) result.a_inside_b.push_back({i, j});
        of_a[i] = around.side();
    });
    detail::for_each_surrounded(b, pose_b, a, pose_a, {}, [&](std::uint32_t j, const surroundings& around) {
        for (const std::uint32_t i : around.components) result.b_inside_a.push_back({i, j});
        of_b[j] = around.side();
    });
    std::ranges::sort(result.b_inside_a);
    const auto each_is = [](const std::vector<solid_side>& sides, solid_side side) {
        return std::ranges::all_of(sides, [side](solid_side s) { return s == side; });
    };
    const auto some_are = [](const std::vector<solid_side>& sides, solid_side side) {
        return std::ranges::find(sides, side) != sides.end();
    };
    const box world_a = world_bounds(a.surface().bounds(), pose_a, a.triangles().frame);
    const box world_b = world_bounds(b.surface().bounds(), pose_b, b.triangles().frame);
    const bool a_is_open = detail::has_open_part(a.parts(), a.triangles(), pose_a, world_b);
    const bool b_is_open = detail::has_open_part(b.parts(), b.triangles(), pose_b, world_a);
    if (!b_is_open && each_is(of_a, solid_side::inside) && each_is(of_b, solid_side::outside))
        result.relation = solid_relation::a_inside_b;
    else if (!a_is_open && each_is(of_b, solid_side::inside) && each_is(of_a, solid_side::outside))
        result.relation = solid_relation::b_inside_a;
    else if (a_is_open || b_is_open)
        result.relation = solid_relation::not_closed;
    else if (some_are(of_a, solid_side::undecided) || some_are(of_b, solid_side::undecided))
        result.relation = solid_relation::undecided;
    else if (some_are(of_a, solid_side::inside) || some_are(of_b, solid_side::inside))
        result.relation = solid_relation::partly_inside;
    return result;
}

}  // namespace aabb
