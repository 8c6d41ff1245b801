#pragma once

import aabb.std;
import aabb;

// Imports modules, so it is included after every other header.

/// A global search that calls a function before each frame, and changes its results.
class altered_search : public aabb::global_stage {
public:
    using change = std::function<void(std::vector<aabb::index_pair>&)>;

    altered_search(std::unique_ptr<aabb::global_stage> stage, std::function<void()> before, change after)
        : stage_(std::move(stage)), before_(std::move(before)), after_(std::move(after)) {}

    void insert(std::uint32_t id) override { stage_->insert(id); }
    void remove(std::uint32_t id) override { stage_->remove(id); }
    void update(std::span<const aabb::box> boxes) override {
        before_();
        stage_->update(boxes);
    }
    void search(std::vector<aabb::index_pair>& pairs) override {
        std::vector<aabb::index_pair> results;
        stage_->search(results);
        after_(results);
        pairs.insert(pairs.end(), results.begin(), results.end());
    }
    [[nodiscard]] aabb::work_counters counters() const override { return stage_->counters(); }
    [[nodiscard]] std::vector<aabb::part_bytes> bytes() const override { return stage_->bytes(); }
    [[nodiscard]] std::vector<aabb::omission> left_out() const override { return {}; }

private:
    std::unique_ptr<aabb::global_stage> stage_;
    std::function<void()> before_;
    change after_;
};
