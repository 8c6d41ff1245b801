module aabb.engines:mesh_engine;

import aabb.base;
import aabb.counters;
import aabb.geometry;
import aabb.local_detection;
import aabb.pipeline;
import aabb.std;

namespace aabb {

/// The vertices of B seen from A, by number. Those outside B's box, which no triangle uses, stay as they are.
/// @param bounds of B, in its own frame
[[nodiscard]] std::vector<vec3f> moved_vertices(const pose& pose_a, const pose& pose_b, const mesh& b,
                                                const box& bounds);

/// What every engine of meshes does alike, in terms of all pairs of two models. None counts its work or shows a tree.
class mesh_engine : public local_stage {
public:
    void all_pairs(std::uint32_t model_a, const pose& pose_a, std::uint32_t model_b, const pose& pose_b,
                   std::vector<index_pair>& pairs) final;
    [[nodiscard]] std::uint64_t count_pairs(std::uint32_t model_a, const pose& pose_a, std::uint32_t model_b,
                                            const pose& pose_b) final;
    void self_pairs(std::uint32_t model, std::vector<index_pair>& pairs) final;
    [[nodiscard]] std::optional<tree_survey> survey(std::uint32_t) const final { return std::nullopt; }
    [[nodiscard]] work_counters counters() const final { return {}; }
    [[nodiscard]] std::vector<omission> left_out() const final { return {}; }

protected:
    /// Appends the intersecting pairs.
    virtual void find(std::uint32_t model_a, const pose& pose_a, std::uint32_t model_b, const pose& pose_b,
                      std::vector<index_pair>& pairs) = 0;
};

/// What every model has.
struct engine_model {
    const mesh* source;
    std::size_t count;  ///< of triangles, which may not change
    box bounds;
    mesh_fit fit{};
};

/// An engine that holds a model of each mesh, and refuses what a composed stage refuses.
/// @tparam Model derived from engine_model
template <class Model>
class model_engine : public mesh_engine {
public:
    std::uint32_t add_model(const mesh& m) final {
        require_ieee_arithmetic();
        require_valid(m);
        models_.push_back(model_of({&m, m.triangles.size(), bounds_of(m)}));
        return static_cast<std::uint32_t>(models_.size() - 1);
    }

    void refit(std::uint32_t number) final {
        Model& changed = models_[number];
        changed.fit.renew([&] {
            require_ieee_arithmetic();
            require_still_valid(*changed.source, changed.count);
            changed.bounds = bounds_of(*changed.source);
            follow(changed);
        });
    }

    [[nodiscard]] std::optional<index_pair> first_pair(std::uint32_t model_a, const pose& pose_a, std::uint32_t model_b,
                                                       const pose& pose_b) final {
        return any_pair(asked_of(model_a, pose_a, model_b, pose_b));
    }

    [[nodiscard]] std::vector<part_bytes> bytes() const override {
        std::size_t all = 0;
        for (const Model& m : models_) all += m.bytes();
        return {{"engine", all}};
    }

protected:
    /// Two models that are as their meshes.
    struct asked {
        const Model& a;
        const pose& pose_a;
        Model& b;
        const pose& pose_b;
    };

    [[nodiscard]] virtual Model model_of(const engine_model& base) = 0;
    /// Goes where the vertices went.
    virtual void follow(Model& changed) = 0;
    /// Appends the intersecting pairs.
    virtual void append_pairs(const asked& q, std::vector<index_pair>& pairs) = 0;
    [[nodiscard]] virtual std::optional<index_pair> any_pair(const asked& q) = 0;

private:
    [[nodiscard]] asked asked_of(std::uint32_t model_a, const pose& pose_a, std::uint32_t model_b, const pose& pose_b) {
        require_ieee_arithmetic();
        models_[model_a].fit.require();
        models_[model_b].fit.require();
        return {models_[model_a], pose_a, models_[model_b], pose_b};
    }

    void find(std::uint32_t model_a, const pose& pose_a, std::uint32_t model_b, const pose& pose_b,
              std::vector<index_pair>& pairs) final {
        append_pairs(asked_of(model_a, pose_a, model_b, pose_b), pairs);
    }

    std::vector<Model> models_;
};

}  // namespace aabb
