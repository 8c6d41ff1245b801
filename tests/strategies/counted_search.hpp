#pragma once

#include <algorithm>
#include <cstdint>
#include <memory>
#include <vector>

#include "../compositions.hpp"

struct work_of_frame {
    std::uint64_t comparisons, moves, swaps, restarts, box_tests, pairs;
};

/// A counted search that says what a frame took.
class counted_search {
public:
    explicit counted_search(const aabb::composition& c, std::uint32_t objects)
        : stage_(compose_global_search(c, aabb::instrumentation::counters)) {
        for (std::uint32_t id = 0; id < objects; ++id) stage_->insert(id);
    }

    work_of_frame play(const std::vector<aabb::box>& boxes) {
        const aabb::work_counters before = stage_->counters();
        pairs_.clear();
        stage_->update(boxes);
        stage_->search(pairs_);
        const aabb::work_counters after = stage_->counters();
        const auto spent = [&](aabb::work what) { return after[what] - before[what]; };
        return {spent(aabb::work::comparisons), spent(aabb::work::moves),     spent(aabb::work::inversions),
                spent(aabb::work::restarts),    spent(aabb::work::box_tests), pairs_.size()};
    }

    [[nodiscard]] std::vector<aabb::index_pair> pairs() const {
        std::vector<aabb::index_pair> sorted = pairs_;
        std::ranges::sort(sorted);
        return sorted;
    }

    [[nodiscard]] aabb::global_stage& stage() { return *stage_; }

private:
    std::unique_ptr<aabb::global_stage> stage_;
    std::vector<aabb::index_pair> pairs_;
};
