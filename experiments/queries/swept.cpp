module aabblab.queries;

namespace aabblab {

namespace {

/// A scene whose boxes in a frame contain those of the previous frame, too.
class swept_scene final : public aabb::box_scene {
public:
    explicit swept_scene(std::unique_ptr<aabb::box_scene> scene) : scene_(std::move(scene)) {}

    [[nodiscard]] std::size_t objects() const override { return scene_->objects(); }
    [[nodiscard]] std::size_t frames() const override { return scene_->frames(); }
    bool next(std::vector<aabb::box>& boxes) override {
        if (!scene_->next(current_)) return false;
        const std::span<const aabb::boxd> doubles = scene_->in_double();
        if (doubles.empty()) {
            boxes = current_;
            for (std::size_t i = 0; i < previous_.size(); ++i) boxes[i] = merged(boxes[i], previous_[i]);
            std::swap(previous_, current_);
            return true;
        }
        in_double_.assign(doubles.begin(), doubles.end());
        for (std::size_t i = 0; i < previous_in_double_.size(); ++i)
            for (int k = 0; k < 3; ++k) {
                in_double_[i].min[k] = std::min(in_double_[i].min[k], previous_in_double_[i].min[k]);
                in_double_[i].max[k] = std::max(in_double_[i].max[k], previous_in_double_[i].max[k]);
            }
        previous_in_double_.assign(doubles.begin(), doubles.end());
        const std::span<const aabb::box> rounded = floats_.round(in_double_);
        boxes.assign(rounded.begin(), rounded.end());
        return true;
    }
    [[nodiscard]] std::span<const aabb::boxd> in_double() const override { return in_double_; }

private:
    std::unique_ptr<aabb::box_scene> scene_;
    std::vector<aabb::box> current_, previous_;
    std::vector<aabb::boxd> in_double_, previous_in_double_;  // empty if boxes are floats
    aabb::float_boxes floats_;
};

}  // namespace

std::unique_ptr<aabb::box_scene> swept(std::unique_ptr<aabb::box_scene> scene) {
    return std::make_unique<swept_scene>(std::move(scene));
}

}  // namespace aabblab
