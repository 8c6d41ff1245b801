module;
#include <cstddef>
#include <cstdint>
#include <deque>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

/// A local detection composed statically, behind the interface of a stage.
export module aabb.composed.local_detection;

import aabb.base;
import aabb.counters;
import aabb.geometry;
import aabb.local_detection;
import aabb.pipeline;
import aabb.policy;
import aabb.composed;

export namespace aabb::composed {

template <CounterPolicy Counters, TreePolicy Tree, TrianglePolicy Triangle>
class composed_local_stage final : public local_stage {
public:
    composed_local_stage(std::unique_ptr<tree_builder> builder, const Tree& tree, Triangle triangle)
        : builder_(std::move(builder)), tree_(tree), detection_(std::move(triangle)) {}

    std::uint32_t add_model(const mesh& m) override {
        models_.emplace_back(m, *builder_, tree_);
        return static_cast<std::uint32_t>(models_.size() - 1);
    }
    void all_pairs(std::uint32_t model_a, const pose& pose_a, std::uint32_t model_b, const pose& pose_b,
                   std::vector<index_pair>& pairs) override {
        detection_.all_pairs(models_[model_a], pose_a, models_[model_b], pose_b, pairs);
    }
    [[nodiscard]] std::optional<index_pair> first_pair(std::uint32_t model_a, const pose& pose_a, std::uint32_t model_b,
                                                       const pose& pose_b) override {
        return detection_.first_pair(models_[model_a], pose_a, models_[model_b], pose_b);
    }
    [[nodiscard]] std::uint64_t count_pairs(std::uint32_t model_a, const pose& pose_a, std::uint32_t model_b,
                                            const pose& pose_b) override {
        return detection_.count_pairs(models_[model_a], pose_a, models_[model_b], pose_b);
    }
    void self_pairs(std::uint32_t model, std::vector<index_pair>& pairs) override {
        detection_.self_pairs(models_[model], pairs);
    }
    void refit(std::uint32_t model) override { models_[model].refit(refitted_); }
    [[nodiscard]] std::optional<tree_survey> survey(std::uint32_t model) const override {
        return survey_of(models_[model].tree(), models_[model].triangles());
    }
    [[nodiscard]] work_counters counters() const override { return counted(detection_.counters()); }

    [[nodiscard]] std::vector<part_bytes> bytes() const override {
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

    [[nodiscard]] std::vector<std::string> left_out() const override {
        std::vector<std::string> absent;
        if constexpr (requires { Tree::leaves_out; }) absent.emplace_back(Tree::leaves_out);
        if constexpr (!Counters::enabled) absent.emplace_back("no work counters");
        return absent;
    }

private:
    std::unique_ptr<tree_builder> builder_;
    Tree tree_;  // without nodes
    std::deque<model<Tree>> models_;
    local_detection<Tree, Triangle, Counters> detection_;
    std::vector<box> refitted_;  // scratch of the largest tree
};

using make_local_detection = std::unique_ptr<local_stage> (*)(std::span<const strategy_choice> choices,
                                                              std::unique_ptr<tree_builder> builder,
                                                              instrumentation counted);
using local_detection_rows = std::vector<row<make_local_detection>>;

template <class... Parts>
[[nodiscard]] row<make_local_detection> local_detection_row() {
    constexpr std::string_view reason = refusal<Parts...>();
    row<make_local_detection> made{{Parts::name...}, reason, nullptr};
    if constexpr (reason.empty())
        made.make = [](std::span<const strategy_choice> choices, std::unique_ptr<tree_builder> builder,
                       instrumentation wanted) {
            return with_counters(wanted, [&]<class Counters>(Counters) -> std::unique_ptr<local_stage> {
                auto choice = choices.begin();
                // Braces are evaluated from left to right.
                return std::unique_ptr<local_stage>(new composed_local_stage<Counters, Parts...>{
                    std::move(builder), make_strategy<Parts>(configured<Parts>((choice++)->settings))...});
            });
        };
    return made;
}

/// Every combination of one strategy a list.
template <class... Lists>
[[nodiscard]] local_detection_rows rows_of_local_detection(Lists... lists) {
    local_detection_rows rows;
    const auto add = [&]<class... Parts>() { rows.push_back(local_detection_row<Parts...>()); };
    for_each_combination(add, lists...);
    return rows;
}

}  // namespace aabb::composed
