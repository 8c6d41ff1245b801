/// Two meshes at poses that a study chooses, and where they begin to touch.
module aabblab.stiff:touching;

import aabb.pipeline;
import aabb.std;
import aabblab.trials;

namespace aabblab {

/// A scene of two meshes whose poses are set for each frame.
class posed_pair final : public aabb::mesh_scene {
public:
    posed_pair(aabb::mesh first, aabb::mesh second) {
        meshes = {std::move(first), std::move(second)};
        mesh_of = {0, 1};
    }

    void set(const aabb::pose& first, const aabb::pose& second) { poses_ = {first, second}; }

    [[nodiscard]] std::size_t frames() const override { return std::numeric_limits<std::size_t>::max(); }
    bool next(std::vector<aabb::pose>& poses) override {
        poses.assign(poses_.begin(), poses_.end());
        return true;
    }

private:
    std::array<aabb::pose, 2> poses_;
};

/// Tests two meshes for contact by both phases of a candidate.
class touch_test {
public:
    touch_test(const candidate& tested, aabb::mesh first, aabb::mesh second)
        : pair_(new posed_pair(std::move(first), std::move(second))),
          frames_(std::unique_ptr<aabb::mesh_scene>(pair_)),
          runner_(tested, frames_, aabb::instrumentation::none) {}

    [[nodiscard]] bool touch(const aabb::pose& first, const aabb::pose& second) {
        pair_->set(first, second);
        frames_.next();
        runner_.update();
        runner_.search();
        runner_.detect();
        return !runner_.sorted_contacts().empty();
    }

private:
    posed_pair* pair_;  // owned by frames_
    scene_frames frames_;
    stage_runner runner_;
};

/// Where meshes begin to touch on a way from `free` to `touching`, by bisection. It is `free` if they touch everywhere,
/// and `touching` if they touch nowhere.
template <class Touches>
[[nodiscard]] double touching_point(double free, double touching, double precision, Touches touches) {
    while (std::abs(touching - free) > precision) {
        const double middle = (free + touching) / 2;
        (touches(middle) ? touching : free) = middle;
    }
    return (free + touching) / 2;
}

/// A pose turned about the axis z, which passes through this point.
[[nodiscard]] aabb::pose turned(double angle, const aabb::vec3d& at) {
    const double cosine = std::cos(angle), sine = std::sin(angle);
    return {{cosine, -sine, 0, sine, cosine, 0, 0, 0, 1}, at};
}

/// A coordinate rounded to float is off by at most this part of itself, and a point by this part of its distance.
inline constexpr double float_rounding = 0x1p-24;

}  // namespace aabblab
