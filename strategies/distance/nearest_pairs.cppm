/// Pairs of triangles of two meshes that may be near each other.
export module aabb.distance.nearest_pairs;

export import aabb.distance.near_walk;
export import aabb.distance.wide_nearest_walk;
import aabb.std;

namespace aabb::detail {

/// Takes the place of a traversal of wide nodes for trees that have none.
struct no_wide_walk {
    template <class... Arguments>
    [[nodiscard]] bool find(const Arguments&... /*unused*/) const noexcept {
        return false;
    }
    void prefer(const vec3d& /*direction*/) const noexcept {}
    [[nodiscard]] no_counters counters() const noexcept { return {}; }
    [[nodiscard]] std::size_t bytes() const noexcept { return 0; }
};

template <class Tree, class Counters>
struct wide_nearest_walk_of {
    using type = no_wide_walk;
};
template <WideTreePolicy Tree, class Counters>
struct wide_nearest_walk_of<Tree, Counters> {
    using type = wide_nearest_walk<Tree, Counters>;
};

}  // namespace aabb::detail

export namespace aabb {

/// Walks trees with wide nodes by `wide_nearest_walk`, if the poses are rotations, and others by `near_walk`.
template <TreePolicy Tree, CounterPolicy Counters>
class nearest_pairs {
public:
    /// Passes the indices of each pair of triangles whose distance may be at most `limit()` to `visit`, until it
    /// returns true.
    /// @param nearest_first whether near boxes should come first
    /// @param limit is read again for each pair of nodes, so that it may decrease meanwhile
    template <class Limit, class Visit>
    void find(const model<Tree>& a, const pose& pose_a, const model<Tree>& b, const pose& pose_b, bool nearest_first,
              const Limit& limit, const Visit& visit) {
        if (!by_wide_nodes_.find(a, pose_a, b, pose_b, nearest_first, limit, visit))
            by_nodes_.find(a, pose_a, b, pose_b, [&] { return square_not_below(limit()); }, visit);
    }

    /// Sets a direction in the world from A to B that probably separates triangles, until the end of the query.
    void prefer(const vec3d& direction) noexcept { by_wide_nodes_.prefer(direction); }

    [[nodiscard]] Counters counters() const noexcept {
        Counters sum = by_nodes_.counters();
        if constexpr (Counters::enabled)
            for (std::size_t kind = 0; kind < work_names.size(); ++kind)
                sum.add(static_cast<work>(kind), by_wide_nodes_.counters()[static_cast<work>(kind)]);
        return sum;
    }
    [[nodiscard]] std::size_t bytes() const noexcept { return by_nodes_.bytes() + by_wide_nodes_.bytes(); }

private:
    near_walk<Tree, Counters> by_nodes_;
    [[no_unique_address]] typename detail::wide_nearest_walk_of<Tree, Counters>::type by_wide_nodes_;
};

}  // namespace aabb
