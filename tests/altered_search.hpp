#pragma once

import aabb.std;
import aabb;

// Imports modules, so it is included after every other header.

/// A global search that does something before each frame, and changes what it finds.
class altered_search : public aabb::global_stage {
public:
    using change = std::function<void(std::vector<aabb::index_pair>&)>;

    altered_search(std::unique_ptr<aabb::global_stage> whole, std::function<void()> before, change after)
        : whole_(std::move(whole)), before_(std::move(before)), after_(std::move(after)) {}

    void insert(std::uint32_t id) override { whole_->insert(id); }
    void remove(std::uint32_t id) override { whole_->remove(id); }
    void update(std::span<const aabb::box> boxes) override {
        before_();
        whole_->update(boxes);
    }
    void search(std::vector<aabb::index_pair>& pairs) override {
        std::vector<aabb::index_pair> found;
        whole_->search(found);
        after_(found);
        pairs.insert(pairs.end(), found.begin(), found.end());
    }
    [[nodiscard]] aabb::work_counters counters() const override { return whole_->counters(); }
    [[nodiscard]] std::vector<aabb::part_bytes> bytes() const override { return whole_->bytes(); }
    [[nodiscard]] std::vector<aabb::omission> left_out() const override { return {}; }

private:
    std::unique_ptr<aabb::global_stage> whole_;
    std::function<void()> before_;
    change after_;
};
