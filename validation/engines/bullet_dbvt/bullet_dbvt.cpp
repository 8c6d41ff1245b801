module;
#include <BulletCollision/BroadphaseCollision/btDbvt.h>

module aabb.engines;

import :box_engine;
import :engine;

namespace aabb {

namespace {

/// Used as in Bullet's own broad phase: a leaf is slightly larger than its box and stays while it contains it.
class bullet_dbvt final : public box_engine {
public:
    [[nodiscard]] std::vector<part_bytes> bytes() const override {
        const auto leaves = static_cast<std::size_t>(tree_.m_leaves);
        const std::size_t nodes = leaves ? 2 * leaves - 1 : 0;
        const auto stack = static_cast<std::size_t>(tree_.m_stkStack.capacity());
        return {{"engine", bytes_of(boxes_, leaves_) + nodes * sizeof(btDbvtNode) + stack * sizeof(btDbvt::sStkNN)}};
    }

private:
    [[nodiscard]] bool can_take_moved() const override { return true; }

    /// Updates the tree's leaves, one per present object. Bullet moves a leaf only if it no longer contains its
    /// object's box. The new leaf is enlarged by a margin, so that it stays valid for some frames, unless the box has
    /// jumped out of the old one. `optimizeIncremental` reinserts one leaf per frame, which keeps the tree balanced.
    void take_boxes(std::span<const box> boxes, std::span<const std::uint32_t> ids) override {
        drop_absent(leaves_, [&](btDbvtNode* leaf) { tree_.remove(leaf); });
        boxes_.resize(boxes.size());
        for (const std::uint32_t id : ids) boxes_[id] = boxes[id];
        if (leaves_.size() < boxes.size()) leaves_.resize(boxes.size());
        const btScalar margin = margin_for(ids);
        for (const std::uint32_t id : ids) {
            const box& b = boxes[id];
            btDbvtVolume volume = btDbvtVolume::FromMM({b.min[0], b.min[1], b.min[2]}, {b.max[0], b.max[1], b.max[2]});
            btDbvtNode*& leaf = leaves_[id];
            if (!leaf) {
                leaf = tree_.insert(volume, nullptr);
                leaf->dataAsInt = static_cast<int>(id);
            } else if (Intersect(leaf->volume, volume)) {
                tree_.update(leaf, volume, margin);
            } else {
                tree_.update(leaf, volume);
            }
        }
        tree_.optimizeIncremental(/*passes=*/1);
    }

    /// Bullet's margin of 0.05, which is meant for objects of about size 1, scaled to the mean extent.
    [[nodiscard]] btScalar margin_for(std::span<const std::uint32_t> ids) const {
        double extents = 0;
        for (const std::uint32_t id : ids)
            for (int k = 0; k < 3; ++k) extents += double{boxes_[id].max[k]} - double{boxes_[id].min[k]};
        const double margin = 0.05 * extents / (3 * std::max(1.0, static_cast<double>(ids.size())));
        return static_cast<btScalar>(std::min(margin, double{std::numeric_limits<float>::max()}));
    }

    /// Collides the tree with itself, and tests the exact boxes, since those of leaves are enlarged.
    void find_pairs(std::vector<index_pair>& pairs) override {
        struct collector final : btDbvt::ICollide {
            collector(const std::vector<box>& tested, std::vector<index_pair>& to) : boxes(tested), pairs(to) {}
            using btDbvt::ICollide::Process;
            void Process(const btDbvtNode* first, const btDbvtNode* second) override {
                const auto a = static_cast<std::uint32_t>(first->dataAsInt);
                const auto b = static_cast<std::uint32_t>(second->dataAsInt);
                if (overlaps(boxes[a], boxes[b])) pairs.push_back(ordered_pair(a, b));
            }
            const std::vector<box>& boxes;
            std::vector<index_pair>& pairs;
        };
        collector collect(boxes_, pairs);
        tree_.collideTTpersistentStack(tree_.m_root, tree_.m_root, collect);
    }

    std::vector<box> boxes_;
    std::vector<btDbvtNode*> leaves_;  // by id; null where absent
    btDbvt tree_;
};

}  // namespace

engine bullet_dbvt_engine() {
    return {.name = "bullet_dbvt",
            .summary = "Bullet's dynamic tree of boxes, collided with itself",
            .boxes = make_stage<global_stage, bullet_dbvt>};
}

}  // namespace aabb
