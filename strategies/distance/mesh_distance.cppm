/// The distance of two meshes, through their trees.
export module aabb.distance.mesh_distance;

export import aabb.distance.nearest_pairs;
export import aabb.distance_stage;
import aabb.distance.near_batch;
import aabb.distance.triangle_distance;
import aabb.std;

export namespace aabb {

/// Finds the distance of two meshes: branch and bound over pairs of nodes, the nearer first. A pair of triangles is
/// measured between bounds that are certain (`measured`), unless eight at once show it to be farther (`near_batch`),
/// and nodes are left out only if the gap of their boxes is not below the least upper bound so far. The least lower
/// bound of the measured pairs then bounds the distance of the meshes from below, and the least upper bound from above.
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

    /// As `distance_stage` does.
    [[nodiscard]] mesh_distance distance(std::uint32_t model_a, const pose& pose_a, std::uint32_t model_b,
                                         const pose& pose_b) {
        const auto nearest =
            distance_below(model_a, pose_a, model_b, pose_b, /*most=*/std::numeric_limits<double>::infinity());
        if (!nearest || !is_finite(nearest->point_a) || !is_finite(nearest->point_b))
            throw input_error("the distance of the meshes, or where it is, exceeds the range of double");
        return *nearest;
    }
    [[nodiscard]] std::optional<mesh_distance> distance_below(std::uint32_t model_a, const pose& pose_a,
                                                              std::uint32_t model_b, const pose& pose_b, double most) {
        const model<Tree>&a = models_[model_a], &b = models_[model_b];
        const pose_pair poses{pose_a, pose_b};
        double lower = most;
        measured_distance nearest{.upper = most};
        std::optional<index_pair> triangles;
        const auto measure = [&](index_pair pair, const triangle3d& s, const triangle3d& t) {
            const measured_distance here = measured(poses, s, t, nearest.upper);
            lower = std::min(lower, here.lower);
            if (here.upper < nearest.upper) {
                nearest = here;
                triangles = pair;
                pairs_.prefer(here.q - here.p);
            }
            return here.upper == 0;  // nothing is nearer
        };
        batch_.clear();
        pairs_.find(
            a, pose_a, b, pose_b, /*nearest_first=*/true, [&] { return nearest.upper; },
            [&](std::uint32_t s, std::uint32_t t) {
                batch_.add({s, t}, a.triangles().given_triangle(s), b.triangles().given_triangle(t));
                return batch_.is_full() && batch_.each_not_farther(poses, nearest.upper, measure);
            });
        batch_.each_not_farther(poses, nearest.upper, measure);
        if (!triangles) return std::nullopt;
        const double value = nearest.value;
        return mesh_distance{.distance = value,
                             .error = std::max(nearest.upper - value, value - std::min(lower, nearest.upper)),
                             .triangles = *triangles,
                             .point_a = nearest.p,
                             .point_b = nearest.q,
                             .point_error = nearest.point_error};
    }

    [[nodiscard]] Counters counters() const noexcept { return pairs_.counters(); }

private:
    [[no_unique_address]] Build build_;
    Tree tree_;  // without nodes
    std::deque<model<Tree>> models_;
    nearest_pairs<Tree, Counters> pairs_;
    near_batch batch_;
};

}  // namespace aabb
