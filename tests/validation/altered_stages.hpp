#pragma once

#include "../altered_search.hpp"

import aabb.validation;

// Imports modules, so it is included after every other header.

namespace aabb {

using pair_list = std::vector<index_pair>;

/// Brute force with changed results.
class altered_boxes final : public altered_search {
public:
    explicit altered_boxes(change after) : altered_search(make_box_engine("brute_force"), [] {}, std::move(after)) {}
    [[nodiscard]] std::vector<part_bytes> bytes() const override { return {{"a", 40}, {"b", 2}}; }
};

/// Changes to the results of mesh queries; an empty function changes nothing.
struct alterations {
    std::function<void(pair_list&)> all_pairs = {};
    std::function<void(std::optional<index_pair>&)> first_pair = {};
    std::uint64_t more_counted = 0;
    std::function<void(pair_list&)> self_pairs = {};
};

class altered_meshes final : public local_stage {
public:
    explicit altered_meshes(alterations changes, std::unique_ptr<local_stage> stage = make_mesh_engine("brute_force"))
        : stage_(std::move(stage)), changes_(std::move(changes)) {}
    std::uint32_t add_model(const mesh& m) override { return stage_->add_model(m); }
    void all_pairs(std::uint32_t a, const pose& pose_a, std::uint32_t b, const pose& pose_b,
                   pair_list& pairs) override {
        stage_->all_pairs(a, pose_a, b, pose_b, pairs);
        if (changes_.all_pairs) changes_.all_pairs(pairs);
    }
    [[nodiscard]] std::optional<index_pair> first_pair(std::uint32_t a, const pose& pose_a, std::uint32_t b,
                                                       const pose& pose_b) override {
        auto first = stage_->first_pair(a, pose_a, b, pose_b);
        if (changes_.first_pair) changes_.first_pair(first);
        return first;
    }
    [[nodiscard]] std::uint64_t count_pairs(std::uint32_t a, const pose& pose_a, std::uint32_t b,
                                            const pose& pose_b) override {
        return stage_->count_pairs(a, pose_a, b, pose_b) + changes_.more_counted;
    }
    void self_pairs(std::uint32_t model, pair_list& pairs) override {
        stage_->self_pairs(model, pairs);
        if (changes_.self_pairs) changes_.self_pairs(pairs);
    }
    void refit(std::uint32_t model) override { stage_->refit(model); }
    [[nodiscard]] std::optional<tree_validation> validate_tree(std::uint32_t) const override { return std::nullopt; }
    [[nodiscard]] work_counters counters() const override { return {}; }
    [[nodiscard]] std::vector<part_bytes> bytes() const override { return {}; }
    [[nodiscard]] std::vector<omission> left_out() const override { return {}; }

private:
    std::unique_ptr<local_stage> stage_;
    alterations changes_;
};

}  // namespace aabb
