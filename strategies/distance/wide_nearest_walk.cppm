/// A traversal of two trees with eight children per node down to pairs of triangles that may be near each other.
export module aabb.distance.wide_nearest_walk;

export import aabb.wide_tree;
import aabb.distance.rigid_motion;
import aabb.std;

export namespace aabb {

/// `gap_walk` in A's frame, with distances and directions in the world.
template <WideTreePolicy Tree, CounterPolicy Counters>
class wide_nearest_walk {
public:
    /// Passes the indices of pairs of triangles whose distance may be at most `limit()` to `visit`, until it returns
    /// true. At poses that do not keep lengths, and far beyond the range of float, nothing is visited.
    /// @param nearest_first,limit as in `gap_walk`
    /// @returns whether it could work
    template <class Limit, class Visit>
    [[nodiscard]] bool find(const model<Tree>& a, const pose& pose_a, const model<Tree>& b, const pose& pose_b,
                            bool nearest_first, const Limit& limit, const Visit& visit) {
        const std::optional<relative_pose> to_a = rigid_motion(a, pose_a, b, pose_b);
        if (!to_a || !is_moderate(a.bounds()) || !is_moderate((*to_a)(b.bounds()))) return false;
        const double units = most_stretch / a.triangles().frame.scale;
        rotation_of_a_ = pose_a.rotation;
        walk_.find(
            a, b, *to_a, nearest_first, counters_, [&] { return gap_walk<Tree>::square_not_below(limit() * units); },
            visit);
        return true;
    }

    /// Sets a direction in the world from A to B that probably separates triangles, until the end of the query.
    void prefer(const vec3d& direction) noexcept {
        vec3d in_a{};
        for (std::size_t i = 0; i < 3; ++i)
            for (std::size_t j = 0; j < 3; ++j)
                in_a[static_cast<int>(j)] += rotation_of_a_[3 * i + j] * direction[static_cast<int>(i)];
        walk_.prefer(in_a);
    }

    [[nodiscard]] const Counters& counters() const noexcept { return counters_; }
    [[nodiscard]] std::size_t bytes() const noexcept { return walk_.bytes(); }

private:
    [[nodiscard]] static bool is_moderate(const box& b) noexcept {
        constexpr float most = gap_walk<Tree>::most_coordinate;
        bool is_within = true;
        for (int k = 0; k < 3; ++k) is_within &= b.min[k] >= -most && b.max[k] <= most;
        return is_within;
    }

    [[no_unique_address]] Counters counters_;
    gap_walk<Tree> walk_;
    std::array<double, 9> rotation_of_a_{};
};

}  // namespace aabb
