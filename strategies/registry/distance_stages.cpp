module aabb.distance_stages;

import aabb.composed;
import aabb.distance;
import aabb.strategies;

namespace aabb {

namespace {

template <class Detection>
class measured_by final : public distance_stage {
public:
    explicit measured_by(Detection detection) : detection_(std::move(detection)) {}

    std::uint32_t add_model(const mesh& m) override { return detection_.add_model(m); }
    [[nodiscard]] mesh_distance distance(std::uint32_t model_a, const pose& pose_a, std::uint32_t model_b,
                                         const pose& pose_b) override {
        return detection_.distance(model_a, pose_a, model_b, pose_b);
    }
    [[nodiscard]] std::optional<mesh_distance> distance_below(std::uint32_t model_a, const pose& pose_a,
                                                              std::uint32_t model_b, const pose& pose_b,
                                                              double most) override {
        return detection_.distance_below(model_a, pose_a, model_b, pose_b, most);
    }
    [[nodiscard]] work_counters counters() const override { return work_of(detection_.counters()); }

private:
    Detection detection_;
};

/// The stage that `make` returns for the composition's builder, tree, and counters.
template <class Stage, class Make>
std::unique_ptr<Stage> with_tree(const composition& c, instrumentation counted, const Make& make) {
    for (const strategy_kind kind : {strategy_kind::build, strategy_kind::tree}) require_known(kind, c[kind]);
    const auto builder = composed::make_named<tree_builder>(builds{}, c[strategy_kind::build],
                                                            [](const auto& build) { return as_tree_builder(build); });
    return composed::make_named<std::unique_ptr<Stage>>(trees{}, c[strategy_kind::tree], [&](const auto& tree) {
        return composed::with_counters(
            counted, [&](const auto& counters) -> std::unique_ptr<Stage> { return make(builder, tree, counters); });
    });
}

}  // namespace

std::unique_ptr<local_stage> compose_within(const composition& c, double d, instrumentation counted) {
    return with_tree<local_stage>(
        c, counted, [d]<class Tree, class Counters>(const tree_builder& builder, const Tree& tree, const Counters&) {
            using detection = within_detection<tree_builder, Tree, Counters>;
            return std::make_unique<detected_by<detection>>(detection(d, builder, tree));
        });
}

near_stages compose_near(const composition& c, double d, const collision_filter* filter, instrumentation counted) {
    std::unique_ptr<global_stage> search = compose_global_search(c, counted);
    // Grown boxes of objects at rest are at rest, too, so a filter inside keeps them from the search.
    if (filter != nullptr) search = filtered(std::move(search), *filter);
    return {std::make_unique<grown_stage>(std::move(search), d), compose_within(c, d, counted)};
}

std::unique_ptr<distance_stage> compose_distance(const composition& c, instrumentation counted) {
    return with_tree<distance_stage>(
        c, counted, []<class Tree, class Counters>(const tree_builder& builder, const Tree& tree, const Counters&) {
            using detection = distance_detection<tree_builder, Tree, Counters>;
            return std::make_unique<measured_by<detection>>(detection(builder, tree));
        });
}

}  // namespace aabb
