module aabb.engines:box_engine;

import aabb.base;
import aabb.counters;
import aabb.geometry;
import aabb.global_search;
import aabb.pipeline;
import aabb.std;

namespace aabb {

/// What every engine of boxes does alike: who is present, and refusing what a composed stage refuses. None counts its
/// work.
class box_engine : public global_stage {
public:
    void insert(std::uint32_t id) final { objects_.insert(id); }
    void remove(std::uint32_t id) final { objects_.remove(id); }
    void update(std::span<const box> boxes) final;
    void search(std::vector<index_pair>& pairs) final;
    [[nodiscard]] work_counters counters() const final { return {}; }
    [[nodiscard]] std::vector<omission> left_out() const final { return {}; }

protected:
    [[nodiscard]] inline bool is_present(std::uint32_t id) const { return objects_.contains(id); }

    /// Takes the boxes of the present objects, whose ids are ascending.
    virtual void take(std::span<const box> boxes, std::span<const std::uint32_t> ids) = 0;
    /// Appends the overlapping pairs of what was taken.
    virtual void find(std::vector<index_pair>& pairs) = 0;

private:
    membership objects_;
    std::vector<std::uint32_t> ids_;
    frame_state frame_;
};

}  // namespace aabb
