module aabb.extreme;

import aabb.distance_stages;

namespace aabb {

namespace {

class stage_by_distance final : public local_stage {
public:
    explicit stage_by_distance(const composition& c)
        : composition_(c),
          plain_(compose_local_detection(c, instrumentation::none)),
          touching_(compose_within(c, 0)),
          distances_(compose_distance(c)) {}

    std::uint32_t add_model(const mesh& m) override {
        plain_->add_model(m);
        distances_->add_model(m);
        meshes_.push_back(&m);
        return touching_->add_model(m);
    }
    void all_pairs(std::uint32_t a, const pose& pose_a, std::uint32_t b, const pose& pose_b,
                   std::vector<index_pair>& pairs) override {
        reject_as_composition(a, pose_a, b, pose_b);
        touching_->all_pairs(a, pose_a, b, pose_b, pairs);
    }
    [[nodiscard]] std::optional<index_pair> first_pair(std::uint32_t a, const pose& pose_a, std::uint32_t b,
                                                       const pose& pose_b) override {
        reject_as_composition(a, pose_a, b, pose_b);
        const std::optional<index_pair> first = touching_->first_pair(a, pose_a, b, pose_b);
        const mesh_distance measured = distances_->distance(a, pose_a, b, pose_b);
        if (first.has_value() != (measured.distance == 0))
            throw std::logic_error("the distance of meshes is not 0 exactly where they intersect");
        if (first) return first;
        constexpr double infinity = std::numeric_limits<double>::infinity();
        const double most = std::nextafter(measured.distance + measured.error, infinity);
        const double below = std::nextafter(measured.distance - measured.error, -infinity);
        if (!any_within(most, a, pose_a, b, pose_b) || (below > 0 && any_within(below, a, pose_a, b, pose_b)))
            throw std::logic_error("the distance of meshes is off by more than its error");
        return std::nullopt;
    }
    [[nodiscard]] std::uint64_t count_pairs(std::uint32_t a, const pose& pose_a, std::uint32_t b,
                                            const pose& pose_b) override {
        reject_as_composition(a, pose_a, b, pose_b);
        return touching_->count_pairs(a, pose_a, b, pose_b);
    }
    /// Distances are not searched within one mesh.
    void self_pairs(std::uint32_t model, std::vector<index_pair>& pairs) override { plain_->self_pairs(model, pairs); }
    void refit(std::uint32_t model) override { touching_->refit(model); }
    [[nodiscard]] std::optional<tree_validation> validate_tree(std::uint32_t model) const override {
        return touching_->validate_tree(model);
    }
    [[nodiscard]] work_counters counters() const override { return touching_->counters(); }
    [[nodiscard]] std::vector<part_bytes> bytes() const override { return touching_->bytes(); }
    [[nodiscard]] std::vector<omission> left_out() const override { return touching_->left_out(); }

private:
    /// Distances are also known where one mesh lies beyond the range of float as seen from the other.
    void reject_as_composition(std::uint32_t a, const pose& pose_a, std::uint32_t b, const pose& pose_b) {
        static_cast<void>(plain_->first_pair(a, pose_a, b, pose_b));
    }
    [[nodiscard]] bool any_within(double d, std::uint32_t a, const pose& pose_a, std::uint32_t b,
                                  const pose& pose_b) const {
        const std::unique_ptr<local_stage> within = compose_within(composition_, d);
        const std::uint32_t of_a = within->add_model(*meshes_[a]), of_b = within->add_model(*meshes_[b]);
        return within->first_pair(of_a, pose_a, of_b, pose_b).has_value();
    }

    composition composition_;
    std::unique_ptr<local_stage> plain_;
    std::unique_ptr<local_stage> touching_;
    std::unique_ptr<distance_stage> distances_;
    std::vector<const mesh*> meshes_;
};

}  // namespace

std::unique_ptr<local_stage> compose_by_distance(const composition& c) {
    return std::make_unique<stage_by_distance>(c);
}

}  // namespace aabb
