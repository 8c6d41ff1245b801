export module aabb.pipeline:mesh_detection;

import aabb.base;
import aabb.counters;
import aabb.geometry;
import aabb.local_detection;
import aabb.std;
import :stage;

export namespace aabb {

/// Local detection with the models it is asked about, numbered from 0: what `local_stage` says of its functions holds
/// here.
template <TreeBuilder Build, TreePolicy Tree, TrianglePolicy Triangle, CounterPolicy Counters = no_counters>
class mesh_detection {
public:
    mesh_detection()
        requires(std::default_initializable<Build> && std::default_initializable<Triangle>)
        : mesh_detection(Build{}) {}
    /// @param tree without nodes
    explicit mesh_detection(Build build, Tree tree = {}, Triangle triangle = {})
        : build_(std::move(build)), tree_(std::move(tree)), detection_(std::move(triangle)) {}

    std::uint32_t add_model(const mesh& m) {
        models_.emplace_back(m, build_, tree_);
        return static_cast<std::uint32_t>(models_.size() - 1);
    }
    void all_pairs(std::uint32_t model_a, const pose& pose_a, std::uint32_t model_b, const pose& pose_b,
                   std::vector<index_pair>& pairs) {
        detection_.all_pairs(models_[model_a], pose_a, models_[model_b], pose_b, pairs);
    }
    [[nodiscard]] std::optional<index_pair> first_pair(std::uint32_t model_a, const pose& pose_a, std::uint32_t model_b,
                                                       const pose& pose_b) {
        return detection_.first_pair(models_[model_a], pose_a, models_[model_b], pose_b);
    }
    [[nodiscard]] std::uint64_t count_pairs(std::uint32_t model_a, const pose& pose_a, std::uint32_t model_b,
                                            const pose& pose_b) {
        return detection_.count_pairs(models_[model_a], pose_a, models_[model_b], pose_b);
    }
    void self_pairs(std::uint32_t model, std::vector<index_pair>& pairs) {
        detection_.self_pairs(models_[model], pairs);
    }
    template <class Take>
    void each_self_pair(std::uint32_t model, const Take& take) {
        detection_.each_self_pair(models_[model], take);
    }
    void refit(std::uint32_t model) { models_[model].refit(refitted_); }
    [[nodiscard]] tree_survey survey(std::uint32_t model) const {
        return survey_of(models_[model].tree(), models_[model].triangles());
    }
    [[nodiscard]] const Counters& counters() const noexcept { return detection_.counters(); }

    [[nodiscard]] std::vector<part_bytes> bytes() const {
        tree_bytes trees{};
        for (const model<Tree>& m : models_) {
            trees.nodes += m.tree().bytes().nodes;
            trees.indices += m.tree().bytes().indices;
        }
        return {{"nodes", trees.nodes},
                {"indices", trees.indices},
                {"stack", detection_.bytes()},
                {"refit", bytes_of(refitted_)}};
    }

private:
    [[no_unique_address]] Build build_;
    Tree tree_;  // without nodes
    std::deque<model<Tree>> models_;
    local_detection<Tree, Triangle, Counters> detection_;
    std::vector<box> refitted_;  // scratch of the largest tree
};

}  // namespace aabb
