module;
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

module aabb.engines;

import aabb.base;
import aabb.geometry;
import aabb.local_detection;
import aabb.pipeline;
import :mesh_engine;
import :pairwise;

namespace aabb {

namespace {

class pairwise_engine final : public mesh_engine {
public:
    pairwise_engine(candidate_search& search, triangle_decision& decide) : search_(search), decide_(decide) {}

    std::uint32_t add_model(const mesh& m) override {
        models_.push_back(model_of(m));
        return static_cast<std::uint32_t>(models_.size() - 1);
    }

    void refit(std::uint32_t number) override {
        model& changed = models_[number];
        changed.fit.renew([&] {
            require_still_valid(*changed.triangles, changed.boxes.size());
            changed = model_of(*changed.triangles);
        });
    }

    [[nodiscard]] std::optional<index_pair> first_pair(std::uint32_t model_a, const pose& pose_a, std::uint32_t model_b,
                                                       const pose& pose_b) override {
        std::optional<index_pair> first;
        decide(model_a, pose_a, model_b, pose_b, [&](index_pair found) {
            first = found;
            return true;
        });
        return first;
    }

    [[nodiscard]] std::vector<part_bytes> bytes() const override {
        std::size_t all = 0;
        for (const model& m : models_) all += bytes_of(m.boxes);
        return {{"engine", all}};
    }

private:
    struct model {
        const mesh* triangles;
        box bounds;
        std::vector<box> boxes;  // by triangle
        mesh_fit fit;
    };

    [[nodiscard]] static model model_of(const mesh& m) {
        require_ieee_arithmetic();
        require_valid(m);
        model made{&m, bounds_of(m), {}, {}};
        for (std::uint32_t t = 0; t < m.triangle_count(); ++t) made.boxes.push_back(bounds_of(m.triangle(t)));
        return made;
    }

    void find(std::uint32_t model_a, const pose& pose_a, std::uint32_t model_b, const pose& pose_b,
              std::vector<index_pair>& pairs) override {
        decide(model_a, pose_a, model_b, pose_b, [&](index_pair found) {
            pairs.push_back(found);
            return false;
        });
    }

    /// `emit` takes an intersecting pair and says whether to stop.
    template <class Emit>
    void decide(std::uint32_t model_a, const pose& pose_a, std::uint32_t model_b, const pose& pose_b, Emit emit) const {
        require_ieee_arithmetic();
        models_[model_a].fit.require();
        models_[model_b].fit.require();
        const model& a = models_[model_a];
        const mesh& b = *models_[model_b].triangles;
        const relative_pose to_a(pose_a, pose_b, models_[model_b].bounds);
        std::vector<box> boxes_b;
        for (std::uint32_t t = 0; t < b.triangle_count(); ++t) boxes_b.push_back(bounds_of(to_a(b.triangle(t))));
        for (const index_pair near : search_(a.boxes, boxes_b))
            if (decide_(a.triangles->triangle(near.a), to_a(b.triangle(near.b))) && emit(near)) return;
    }

    candidate_search& search_;
    triangle_decision& decide_;
    std::vector<model> models_;
};

}  // namespace

std::unique_ptr<local_stage> make_pairwise_engine(candidate_search& search, triangle_decision& decide) {
    return std::make_unique<pairwise_engine>(search, decide);
}

}  // namespace aabb
