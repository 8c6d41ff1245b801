export module aabb.pipeline:mesh_detection;

import aabb.std;
import :stage;

export namespace aabb {

/// The narrow phase with its models, numbered from 0. The functions are those of `local_stage`.
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
    [[nodiscard]] tree_validation validate_tree(std::uint32_t model) const {
        return validate(models_[model].tree(), models_[model].triangles());
    }
    [[nodiscard]] const Counters& counters() const noexcept { return detection_.counters(); }

    /// Heap bytes of the trees' nodes and indices, the traversal's stack, and the scratch memory of refits.
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

    [[nodiscard]] static std::vector<omission> left_out() {
        std::vector<omission> absent;
        if constexpr (requires { Tree::leaves_out; })
            for (const absence feature : Tree::leaves_out) absent.push_back({feature});
        if constexpr (!Counters::enabled) absent.push_back({absence::counters});
        return absent;
    }

private:
    [[no_unique_address]] Build build_;
    Tree tree_;  // without nodes
    std::deque<model<Tree>> models_;
    local_detection<Tree, Triangle, Counters> detection_;
    std::vector<box> refitted_;  // scratch memory for refits
};

/// A statically composed narrow phase, a `mesh_detection`, behind the interface of a stage.
template <class Detection>
class detected_by final : public local_stage {
public:
    explicit detected_by(Detection detection) : detection_(std::move(detection)) {}

    std::uint32_t add_model(const mesh& m) override { return detection_.add_model(m); }
    void all_pairs(std::uint32_t model_a, const pose& pose_a, std::uint32_t model_b, const pose& pose_b,
                   std::vector<index_pair>& pairs) override {
        detection_.all_pairs(model_a, pose_a, model_b, pose_b, pairs);
    }
    [[nodiscard]] std::optional<index_pair> first_pair(std::uint32_t model_a, const pose& pose_a, std::uint32_t model_b,
                                                       const pose& pose_b) override {
        return detection_.first_pair(model_a, pose_a, model_b, pose_b);
    }
    [[nodiscard]] std::uint64_t count_pairs(std::uint32_t model_a, const pose& pose_a, std::uint32_t model_b,
                                            const pose& pose_b) override {
        return detection_.count_pairs(model_a, pose_a, model_b, pose_b);
    }
    void self_pairs(std::uint32_t model, std::vector<index_pair>& pairs) override {
        detection_.self_pairs(model, pairs);
    }
    void each_self_pair(std::uint32_t model, const std::function<bool(index_pair)>& take) override {
        detection_.each_self_pair(model, take);
    }
    void refit(std::uint32_t model) override { detection_.refit(model); }
    [[nodiscard]] std::optional<tree_validation> validate_tree(std::uint32_t model) const override {
        return detection_.validate_tree(model);
    }
    [[nodiscard]] work_counters counters() const override { return work_of(detection_.counters()); }
    [[nodiscard]] std::vector<part_bytes> bytes() const override { return detection_.bytes(); }
    [[nodiscard]] std::vector<omission> left_out() const override { return Detection::left_out(); }

private:
    Detection detection_;
};

}  // namespace aabb
