module aabblab.stiff;

import :rules;
import :shapes;
import aabb.pipeline;

namespace aabblab {

namespace {

constexpr float thickness = 0.01F;                                 // of the plate, m
constexpr float radius = 0.05F;                                    // of the body
constexpr double extent = double{thickness} + 2 * double{radius};  // over which the body touches the plate
constexpr auto tunnelled_share = "1 - extent / displacement";      // of shots, if steps are longer than that

/// A body that flies down through a plate with a constant displacement per frame.
class shot {
public:
    shot(const candidate& tested, double step) : step_(step) {
        global_ = tested.make_global(aabb::instrumentation::none);
        local_ = tested.make_local(aabb::instrumentation::none);
        for (const std::uint32_t id : {0U, 1U}) global_->insert(id);
        local_->add_model(plate_);
        local_->add_model(body_);
    }

    /// Shoots the body down through the plate once. @returns whether a frame detects that they intersect
    /// @param phase offset of the start, in steps
    /// @param swept whether a box covers the motion from a frame to the next; if the boxes overlap, positions between
    /// the frames are tested too
    [[nodiscard]] bool is_detected(double phase, bool swept) {
        const double above = double{thickness} + step_;
        for (double z = above - phase * step_; z > -above - 2 * double{radius}; z -= step_) {
            if (!swept) {
                if (boxes_meet(z, z) && meshes_meet(z)) return true;
                continue;
            }
            if (!boxes_meet(z, z - step_)) continue;
            // Substeps are so short that the body cannot tunnel through the plate.
            const auto parts = static_cast<int>(std::ceil(2 * step_ / extent));
            for (int i = 0; i < parts; ++i)
                if (meshes_meet(z - step_ * i / parts)) return true;
        }
        return false;
    }

private:
    [[nodiscard]] aabb::box box_at(double z) const {
        aabb::box b = aabb::bounds_of(body_);
        b.min[2] = std::nextafter(static_cast<float>(b.min[2] + z), -1e9F);
        b.max[2] = std::nextafter(static_cast<float>(b.max[2] + z), 1e9F);
        return b;
    }

    [[nodiscard]] bool boxes_meet(double from, double to) {
        const std::vector<aabb::box> boxes = {aabb::bounds_of(plate_), merged(box_at(from), box_at(to))};
        std::vector<aabb::index_pair> pairs;
        global_->update(boxes);
        global_->search(pairs);
        return !pairs.empty();
    }

    [[nodiscard]] bool meshes_meet(double z) {
        aabb::pose pose;
        pose.translation[2] = z;
        return local_->first_pair(0, {}, 1, pose).has_value();
    }

    aabb::mesh plate_ = slab(/*side=*/2, thickness);
    aabb::mesh body_ = octahedron(radius);
    double step_;
    std::unique_ptr<aabb::global_stage> global_;
    std::unique_ptr<aabb::local_stage> local_;
};

}  // namespace

/// Shoots the body at start times spread evenly over a step, with several lengths of a step and both kinds of boxes,
/// and compares the share of shots that pass the plate undetected with the closed form.
void run_plate(const stiff_setting& setting, stiff_result& result) {
    const std::size_t shots = setting.quick ? 200 : 2000;
    for (const double ratio : {0.5, 1.0, 1.25, 2.0, 4.0, 8.0, 16.0}) {
        shot moving_body(setting.tested, ratio * extent);
        const double expected = std::max(0.0, 1 - 1 / ratio);  // the starts without a frame in contact
        result.plot("tunnelled", tunnelled_share, ratio, expected);
        for (const bool swept : {false, true}) {
            std::size_t missed = 0;
            for (std::size_t s = 0; s < shots; ++s)
                if (!moving_body.is_detected((static_cast<double>(s) + 0.5) / static_cast<double>(shots), swept))
                    ++missed;
            const double share = static_cast<double>(missed) / static_cast<double>(shots);
            result.plot("tunnelled", swept ? "swept boxes" : "plain boxes", ratio, share);
            const std::string subject = "a step of " + short_number(ratio) + " extents, " + (swept ? "swept" : "plain");
            result.add({subject, "share of " + std::to_string(shots) + " shots that tunnel", share,
                        swept ? "0" : short_number(expected) + " ± one shot",
                        verdict_if(std::abs(share - (swept ? 0 : expected)) <=
                                   (swept ? 0 : 1.01 / static_cast<double>(shots)))});  // one shot, up to rounding
        }
    }
}

stiff_study plate_study() {
    return {
        "plate",
        "A body 100 mm long is shot at a mesh plate 10 mm thick many times, at phases spread evenly over a time step; "
        "a shot tunnels if no step detects it. Plain boxes bound the body at the end of a step. Swept boxes bound it "
        "from step to step; if they overlap, the step is tested in parts that are too short for the body to tunnel",
        "1 - extent/displacement if the displacement per step exceeds the extent of body and plate together; none with "
        "swept boxes",
        &run_plate,
        {figure{.name = "tunnelled",
                .caption = "Share of shots that tunnel through a plate undetected, over the displacement per step.",
                .x = {"displacement per step (extents of body and plate)", /*logarithmic=*/true},
                .y = {"share of shots that tunnel"},
                .lines = {
                    {"plain boxes", series_style::points}, {"swept boxes", series_style::points}, {tunnelled_share}}}}};
}

}  // namespace aabblab
