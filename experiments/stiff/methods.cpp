module;
#include <cmath>

module aabblab.stiff;

import :method;
import aabb.base;
import aabb.pipeline;

namespace aabblab {

namespace {

/// Finds nothing in one of `every` queries of two meshes.
class losing_stage final : public aabb::local_stage {
public:
    losing_stage(std::unique_ptr<aabb::local_stage> stage, std::size_t every)
        : stage_(std::move(stage)), every_(every) {}

    std::uint32_t add_model(const aabb::mesh& m) override { return stage_->add_model(m); }
    void all_pairs(std::uint32_t a, const aabb::pose& pose_a, std::uint32_t b, const aabb::pose& pose_b,
                   std::vector<aabb::index_pair>& pairs) override {
        if (!is_lost()) stage_->all_pairs(a, pose_a, b, pose_b, pairs);
    }
    [[nodiscard]] std::optional<aabb::index_pair> first_pair(std::uint32_t a, const aabb::pose& pose_a, std::uint32_t b,
                                                             const aabb::pose& pose_b) override {
        return is_lost() ? std::nullopt : stage_->first_pair(a, pose_a, b, pose_b);
    }
    [[nodiscard]] std::uint64_t count_pairs(std::uint32_t a, const aabb::pose& pose_a, std::uint32_t b,
                                            const aabb::pose& pose_b) override {
        return is_lost() ? 0 : stage_->count_pairs(a, pose_a, b, pose_b);
    }
    void self_pairs(std::uint32_t model, std::vector<aabb::index_pair>& pairs) override {
        stage_->self_pairs(model, pairs);
    }
    void refit(std::uint32_t model) override { stage_->refit(model); }
    [[nodiscard]] std::optional<aabb::tree_validation> validate_tree(std::uint32_t model) const override {
        return stage_->validate_tree(model);
    }
    [[nodiscard]] aabb::work_counters counters() const override { return stage_->counters(); }
    [[nodiscard]] std::vector<aabb::part_bytes> bytes() const override { return stage_->bytes(); }
    [[nodiscard]] std::vector<aabb::omission> left_out() const override { return stage_->left_out(); }

private:
    [[nodiscard]] bool is_lost() { return ++queries_ % every_ == 0; }

    std::unique_ptr<aabb::local_stage> stage_;
    std::size_t every_;
    std::size_t queries_ = 0;
};

/// An inexact triangle test in two settings, a stale Verlet list, a coarse tree, and lost contacts.
std::vector<method> compared_methods() {
    std::vector<method> methods;
    for (const char* const replacement : {"triangle moller", "triangle moller:epsilon=none",
                                          "prepare neighbour_list:margin=0,every=16", "tree quantized:bits=4"})
        methods.push_back(composed_with(replacement));
    methods.push_back({"1 of 1000 lost", losing_contacts(default_candidate(), 1000)});
    return methods;
}

/// The result of a study; if a body leaves the range of valid poses, what it measured before that.
stiff_result run(const stiff_study& study, const stiff_setting& setting) {
    stiff_result result;
    try {
        study.run(setting, result);
    } catch (const aabb::input_error&) {
        return result;
    }
    return result;
}

}  // namespace

candidate losing_contacts(const candidate& tested, std::size_t every) {
    candidate losing = tested;
    losing.exact = false;
    losing.make_local = [every, make = tested.make_local](aabb::instrumentation counted) {
        return std::unique_ptr<aabb::local_stage>(new losing_stage(make(counted), every));
    };
    return losing;
}

method_effect effect_of(const stiff_result& exact, const stiff_result& with_method) {
    method_effect effect;
    for (const stiff_row& r : exact.rows) {
        if (r.verdict == stiff_verdict::reported) continue;
        ++effect.rules;
        const auto other = std::ranges::find_if(with_method.rows, [&](const stiff_row& with) {
            return with.subject == r.subject && with.quantity == r.quantity;
        });
        const bool is_missing = other == with_method.rows.end();
        if (is_missing || other->verdict != r.verdict) ++effect.turned;
        if (r.expected == 0) continue;
        const double change = is_missing ? std::numeric_limits<double>::infinity()
                                         : std::abs((other->measured - r.measured) / r.expected);
        effect.change = std::max(effect.change, std::isnan(change) ? std::numeric_limits<double>::infinity() : change);
    }
    return effect;
}

std::vector<method_effect> effects_of_methods(const stiff_study& study, const stiff_setting& exact) {
    const std::vector<method> methods = compared_methods();
    const double runs = static_cast<double>(methods.size()) + 1;
    double done = 0;
    const auto run_with = [&](const candidate& tested) {
        stiff_setting setting = exact;
        setting.tested = tested;
        setting.progress = [&](double share) { exact.progress((done + share) / runs); };
        stiff_result result = run(study, setting);
        ++done;
        return result;
    };
    const stiff_result reference = run_with(exact.tested);
    std::vector<method_effect> effects;
    for (const method& m : methods) {
        method_effect effect = effect_of(reference, run_with(m.tested));
        effect.study = study.name;
        effect.method = m.label;
        effects.push_back(std::move(effect));
    }
    return effects;
}

}  // namespace aabblab
