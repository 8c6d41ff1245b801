module aabb.engines:mesh_engine;

import aabb.pipeline;
import aabb.std;

namespace aabb {

/// The floats of B's vertices in A's frame, by index. Unused vertices outside B's box (`bounds`) stay unchanged.
[[nodiscard]] std::vector<vec3f> transformed_vertices(const mesh& a, const pose& pose_a, const mesh& b,
                                                      const pose& pose_b, const box& bounds) {
    const relative_pose to_a(pose_a, pose_b, bounds, a.frame, b.frame);
    std::vector<vec3f> transformed = b.vertices;
    for (vec3f& v : transformed)
        if (contains(bounds, bounds_of(v))) v = to_a(v);
    return transformed;
}

/// The bounds of a triangle of mesh B in A's frame, grown by the error bounds of the transform (`image_error`), so that
/// they overlap the boxes of all triangles of A that intersect it exactly.
[[nodiscard]] box box_around(const triangle3f& of_b, const relative_pose& to_a) {
    box around = bounds_of(to_a(of_b));
    // These sums need no further margin: rounding to nearest is monotone, so that a rounded bound is not above any
    // float that the exact bound is not above.
    for (int k = 0; k < 3; ++k) {
        around.min[k] -= to_a.image_error()[k];
        around.max[k] += to_a.image_error()[k];
    }
    return around;
}

/// A cache key: the poses of two models for which something was built.
class posed_pair {
public:
    void forget() { poses_.reset(); }
    /// Rebuilds if the poses changed or the previous build failed.
    void renew(const pose& a, const pose& b, auto build) {
        const std::array poses{a, b};
        if (poses_ == poses) return;
        forget();
        build();
        poses_ = poses;
    }

private:
    std::optional<std::array<pose, 2>> poses_;
};

/// The base of all mesh engines, in terms of all pairs of two models. Engines count no work and expose no tree.
class mesh_engine : public local_stage {
public:
    void all_pairs(std::uint32_t model_a, const pose& pose_a, std::uint32_t model_b, const pose& pose_b,
                   std::vector<index_pair>& pairs) final {
        append_guard guard(pairs);
        find_pairs(model_a, pose_a, model_b, pose_b, pairs);
        guard.keep();
    }
    [[nodiscard]] std::uint64_t count_pairs(std::uint32_t model_a, const pose& pose_a, std::uint32_t model_b,
                                            const pose& pose_b) final {
        std::vector<index_pair> pairs;
        all_pairs(model_a, pose_a, model_b, pose_b, pairs);
        return pairs.size();
    }
    /// Finds the pairs of the mesh with its copy, which contain each pair in both orders, and each triangle with
    /// itself; of these only pairs with a < b count.
    void self_pairs(std::uint32_t model, std::vector<index_pair>& pairs) final {
        std::vector<index_pair> both_ways;
        all_pairs(model, {}, model, {}, both_ways);
        append_guard guard(pairs);
        for (const index_pair pair : both_ways)
            if (pair.a < pair.b) pairs.push_back(pair);
        guard.keep();
    }
    [[nodiscard]] std::optional<tree_validation> validate_tree(std::uint32_t) const final { return std::nullopt; }
    [[nodiscard]] work_counters counters() const final { return {}; }
    [[nodiscard]] std::vector<omission> left_out() const final { return {}; }

protected:
    virtual void find_pairs(std::uint32_t model_a, const pose& pose_a, std::uint32_t model_b, const pose& pose_b,
                            std::vector<index_pair>& pairs) = 0;
};

/// The common part of all models.
struct engine_model {
    const mesh* source;
    std::size_t count;  ///< the number of triangles, which must not change
    box bounds;
    mesh_fit fit{};
};

/// An engine with a Model (derived from engine_model) of each mesh; it rejects the same input as a composed stage.
template <class Model>
class model_engine : public mesh_engine {
public:
    /// Makes the model of a mesh, which must outlive it and is rejected if it is invalid. @return the model's index
    std::uint32_t add_model(const mesh& m) final {
        require_ieee_arithmetic();
        require_valid(m);
        Model model{{&m, m.triangles.size(), bounds_of(m)}};
        update_model(model);
        models_.push_back(std::move(model));
        return static_cast<std::uint32_t>(models_.size() - 1);
    }

    /// Updates a deformed model. After a failure, `fit` rejects queries until a refit succeeds.
    void refit(std::uint32_t model) final {
        Model& changed = models_[model];
        changed.fit.renew([&] {
            require_ieee_arithmetic();
            require_still_valid(*changed.source, changed.count);
            changed.bounds = bounds_of(*changed.source);
            update_model(changed);
        });
    }

    [[nodiscard]] std::optional<index_pair> first_pair(std::uint32_t model_a, const pose& pose_a, std::uint32_t model_b,
                                                       const pose& pose_b) final {
        return any_pair(query_of(model_a, pose_a, model_b, pose_b));
    }

    [[nodiscard]] std::vector<part_bytes> bytes() const override {
        std::size_t total = 0;
        for (const Model& m : models_) total += m.bytes();
        return {{"engine", total}};
    }

protected:
    /// A query of two models that are up to date.
    struct model_query {
        const Model& a;
        const pose& pose_a;
        Model& b;
        const pose& pose_b;
    };

    /// Builds or updates the model, initially and after vertices moved.
    virtual void update_model(Model& changed) = 0;
    virtual void append_pairs(const model_query& q, std::vector<index_pair>& pairs) = 0;
    [[nodiscard]] virtual std::optional<index_pair> any_pair(const model_query& q) = 0;

private:
    [[nodiscard]] model_query query_of(std::uint32_t model_a, const pose& pose_a, std::uint32_t model_b,
                                       const pose& pose_b) {
        require_ieee_arithmetic();
        models_[model_a].fit.require();
        models_[model_b].fit.require();
        return {models_[model_a], pose_a, models_[model_b], pose_b};
    }

    void find_pairs(std::uint32_t model_a, const pose& pose_a, std::uint32_t model_b, const pose& pose_b,
                    std::vector<index_pair>& pairs) final {
        append_pairs(query_of(model_a, pose_a, model_b, pose_b), pairs);
    }

    std::vector<Model> models_;
};

}  // namespace aabb
