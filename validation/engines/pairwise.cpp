module aabb.engines;

import aabb.base;
import aabb.local_detection;
import :mesh_engine;
import :pairwise;

namespace aabb {

namespace {

struct boxed_model : engine_model {
    std::vector<box> boxes{};  ///< by triangle

    [[nodiscard]] std::size_t bytes() const { return bytes_of(boxes); }
};

class pairwise_engine final : public model_engine<boxed_model> {
public:
    pairwise_engine(candidate_search& search, triangle_decision& decide) : search_(search), decide_(decide) {}

private:
    [[nodiscard]] boxed_model model_of(const engine_model& base) override {
        boxed_model made{base};
        follow(made);
        return made;
    }

    void follow(boxed_model& changed) override {
        changed.boxes.clear();
        for (std::uint32_t t = 0; t < changed.count; ++t)
            changed.boxes.push_back(bounds_of(changed.source->triangle(t)));
    }

    void append_pairs(const asked& q, std::vector<index_pair>& pairs) override {
        decide(q, [&](index_pair found) {
            pairs.push_back(found);
            return false;
        });
    }

    [[nodiscard]] std::optional<index_pair> any_pair(const asked& q) override {
        std::optional<index_pair> first;
        decide(q, [&](index_pair found) {
            first = found;
            return true;
        });
        return first;
    }

    /// `emit` takes an intersecting pair and says whether to stop.
    template <class Emit>
    void decide(const asked& q, Emit emit) const {
        const mesh& b = *q.b.source;
        const relative_pose to_a(q.pose_a, q.pose_b, q.b.bounds);
        std::vector<box> boxes_b;
        for (std::uint32_t t = 0; t < b.triangle_count(); ++t) boxes_b.push_back(bounds_of(to_a(b.triangle(t))));
        for (const index_pair near : search_(q.a.boxes, boxes_b))
            if (decide_(q.a.source->triangle(near.a), to_a(b.triangle(near.b))) && emit(near)) return;
    }

    candidate_search& search_;
    triangle_decision& decide_;
};

}  // namespace

std::unique_ptr<local_stage> make_pairwise_engine(candidate_search& search, triangle_decision& decide) {
    return std::make_unique<pairwise_engine>(search, decide);
}

}  // namespace aabb
