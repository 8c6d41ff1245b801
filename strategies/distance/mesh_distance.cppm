/// The distance of two meshes, through their trees.
export module aabb.distance.mesh_distance;

export import aabb.distance.near_walk;
export import aabb.distance_stage;
import aabb.distance.triangle_distance;
import aabb.std;

export namespace aabb {

/// Finds the distance of two meshes: branch and bound over pairs of nodes, the nearer first. A pair of triangles is
/// measured between bounds that are certain (`bounds_of_distance`), and nodes are left out only if the gap of their
/// boxes is not below the least upper bound so far. The least lower bound of the measured pairs then bounds the
/// distance of the meshes from below, and the least upper bound from above.
template <TreeBuilder Build, TreePolicy Tree, CounterPolicy Counters = no_counters>
class distance_detection {
public:
    /// @param tree without nodes
    explicit distance_detection(Build build = {}, Tree tree = {}) : build_(std::move(build)), tree_(std::move(tree)) {}

    /// Builds the tree of a mesh, which must outlive this object; models are numbered from 0.
    /// @throws input_error on a mesh that `require_valid` rejects
    std::uint32_t add_model(const mesh& m) {
        models_.emplace_back(m, build_, tree_);
        return static_cast<std::uint32_t>(models_.size() - 1);
    }

    /// @param pose_a,pose_b of full rank
    /// @throws input_error as `require_ieee_arithmetic`, and if the nearest triangles lie in less than 2^-200 or in
    /// more than 2^200
    [[nodiscard]] mesh_distance distance(std::uint32_t model_a, const pose& pose_a, std::uint32_t model_b,
                                         const pose& pose_b) {
        const model<Tree>&a = models_[model_a], &b = models_[model_b];
        const pose_pair poses{pose_a, pose_b};
        constexpr double infinity = std::numeric_limits<double>::infinity();
        measured_distance nearest{.lower = infinity, .upper = infinity};
        double lower = infinity;
        index_pair triangles{};
        walk_.find(
            a, pose_a, b, pose_b, [&] { return square_not_below(nearest.upper); },
            [&](std::uint32_t s, std::uint32_t t) {
                const measured_distance here =
                    measured(poses, a.triangles().given_triangle(s), b.triangles().given_triangle(t), nearest.upper);
                lower = std::min(lower, here.lower);
                if (here.upper < nearest.upper) {
                    nearest = here;
                    triangles = {s, t};
                }
                return here.upper == 0;  // nothing is nearer
            });
        const double value = nearest.value;
        return {.distance = value,
                .error = std::max(nearest.upper - value, value - std::min(lower, nearest.upper)),
                .triangles = triangles,
                .point_a = nearest.p,
                .point_b = nearest.q,
                .point_error = nearest.point_error};
    }

    [[nodiscard]] const Counters& counters() const noexcept { return walk_.counters(); }

private:
    [[no_unique_address]] Build build_;
    Tree tree_;  // without nodes
    std::deque<model<Tree>> models_;
    near_walk<Tree, Counters> walk_;
};

}  // namespace aabb
