/// Pairs of triangles of two meshes that are nearer than a given distance, through their trees.
export module aabb.distance.within_detection;

export import aabb.distance.nearest_pairs;
export import aabb.pipeline;
import aabb.distance.box_gap;
import aabb.distance.near_batch;
import aabb.distance.triangle_distance;
import aabb.std;

export namespace aabb {

/// A narrow phase with its models, as `mesh_detection`, for pairs of triangles at a distance of at most `d` instead of
/// intersecting ones. Exact for vertices and poses in double (`are_within`), closed, and the same in the order of a and
/// b. In a `detector` of meshes, boxes must be grown by `grow_boxes`.
///
/// The distances within one mesh, whose neighbours all touch, are not searched.
template <TreeBuilder Build, TreePolicy Tree, CounterPolicy Counters = no_counters>
class within_detection {
public:
    /// @param d finite and not negative
    /// @param tree without nodes
    /// @throws input_error on another d
    explicit within_detection(double d, Build build = {}, Tree tree = {})
        : d_(d), build_(std::move(build)), tree_(std::move(tree)) {
        require_distance(d);
    }

    std::uint32_t add_model(const mesh& m) {
        models_.emplace_back(m, build_, tree_);
        return static_cast<std::uint32_t>(models_.size() - 1);
    }
    void all_pairs(std::uint32_t model_a, const pose& pose_a, std::uint32_t model_b, const pose& pose_b,
                   std::vector<index_pair>& pairs) {
        append_guard guard(pairs);
        each_pair(model_a, pose_a, model_b, pose_b, [&](index_pair pair) { pairs.push_back(pair); });
        guard.keep();
    }
    [[nodiscard]] std::optional<index_pair> first_pair(std::uint32_t model_a, const pose& pose_a, std::uint32_t model_b,
                                                       const pose& pose_b) {
        const model<Tree>&a = models_[model_a], &b = models_[model_b];
        const pose_pair poses{pose_a, pose_b};
        std::optional<index_pair> first;
        pairs_.find(
            a, pose_a, b, pose_b, /*nearest_first=*/true, [this] { return d_; },
            [&](std::uint32_t s, std::uint32_t t) {
                if (are_within(poses, a.triangles().given_triangle(s), b.triangles().given_triangle(t), d_))
                    first = index_pair{s, t};
                return first.has_value();
            });
        return first;
    }
    [[nodiscard]] std::uint64_t count_pairs(std::uint32_t model_a, const pose& pose_a, std::uint32_t model_b,
                                            const pose& pose_b) {
        std::uint64_t count = 0;
        each_pair(model_a, pose_a, model_b, pose_b, [&](index_pair) { ++count; });
        return count;
    }
    /// @throws input_error always
    void self_pairs(std::uint32_t /*model*/, std::vector<index_pair>& /*pairs*/) { reject_self(); }
    template <class Take>
    void each_self_pair(std::uint32_t /*model*/, const Take& /*take*/) {
        reject_self();
    }
    void refit(std::uint32_t model) { models_[model].refit(refitted_); }
    [[nodiscard]] tree_validation validate_tree(std::uint32_t model) const {
        return validate(models_[model].tree(), models_[model].triangles());
    }
    [[nodiscard]] Counters counters() const noexcept { return pairs_.counters(); }

    /// Heap bytes of the trees' nodes and indices, the traversal's stack, and the scratch memory of refits.
    [[nodiscard]] std::vector<part_bytes> bytes() const {
        tree_bytes trees{};
        for (const model<Tree>& m : models_) {
            trees.nodes += m.tree().bytes().nodes;
            trees.indices += m.tree().bytes().indices;
        }
        return {{"nodes", trees.nodes},
                {"indices", trees.indices},
                {"stack", pairs_.bytes()},
                {"refit", bytes_of(refitted_)}};
    }

    [[nodiscard]] static std::vector<omission> left_out() {
        std::vector<omission> absent;
        if constexpr (!Counters::enabled) absent.push_back({absence::counters});
        return absent;
    }

private:
    /// Passes each pair (a of A, b of B) to `take`.
    template <class Take>
    void each_pair(std::uint32_t model_a, const pose& pose_a, std::uint32_t model_b, const pose& pose_b,
                   const Take& take) {
        const model<Tree>&a = models_[model_a], &b = models_[model_b];
        const pose_pair poses{pose_a, pose_b};
        batch_.clear();
        const auto collect = [&](std::uint32_t s, std::uint32_t t) {
            batch_.add({s, t}, a.triangles().given_triangle(s), b.triangles().given_triangle(t));
            if (batch_.is_full()) batch_.decide(poses, d_, take);
            return false;  // continues
        };
        pairs_.find(a, pose_a, b, pose_b, /*nearest_first=*/false, [this] { return d_; }, collect);
        batch_.decide(poses, d_, take);
    }

    [[noreturn]] static void reject_self() {
        throw input_error("distances are searched between two meshes, not within one");
    }

    double d_;
    [[no_unique_address]] Build build_;
    Tree tree_;  // without nodes
    std::deque<model<Tree>> models_;
    nearest_pairs<Tree, Counters> pairs_;
    near_batch batch_;
    std::vector<box> refitted_;  // scratch memory for refits
};

}  // namespace aabb
