export module aabb.pipeline:detected_by;

import aabb.counters;
import aabb.geometry;
import aabb.local_detection;
import aabb.std;
import :mesh_detection;
import :stage;

export namespace aabb {

template <class Detection>
class detected_by;

/// Local detection whose type is known, as a stage.
template <TreeBuilder Build, TreePolicy Tree, TrianglePolicy Triangle, CounterPolicy Counters>
class detected_by<mesh_detection<Build, Tree, Triangle, Counters>> final : public local_stage {
public:
    explicit detected_by(mesh_detection<Build, Tree, Triangle, Counters> detection)
        : detection_(std::move(detection)) {}

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
    void each_self_pair(std::uint32_t model, const std::function<void(index_pair)>& take) override {
        detection_.each_self_pair(model, take);
    }
    void refit(std::uint32_t model) override { detection_.refit(model); }
    [[nodiscard]] std::optional<tree_survey> survey(std::uint32_t model) const override {
        return detection_.survey(model);
    }
    [[nodiscard]] work_counters counters() const override { return work_of(detection_.counters()); }
    [[nodiscard]] std::vector<part_bytes> bytes() const override { return detection_.bytes(); }

    [[nodiscard]] std::vector<omission> left_out() const override {
        std::vector<omission> absent;
        if constexpr (requires { Tree::leaves_out; })
            for (const std::string_view what : Tree::leaves_out) absent.push_back({std::string(what), {}});
        if constexpr (!Counters::enabled) absent.push_back({"no work counters", {}});
        return absent;
    }

private:
    mesh_detection<Build, Tree, Triangle, Counters> detection_;
};

}  // namespace aabb
