/// Broad phases for pairs of boxes that are nearer than a given distance.
export module aabb.distance.grown_stage;

export import aabb.distance.box_gap;
export import aabb.pipeline;
import aabb.std;

export namespace aabb {

/// Grows the boxes before any broad phase, so that it finds every two at a distance of at most `d`, and others that are
/// little farther: candidates for a narrow phase that decides (`within_detection`). Bounds may have been rounded to
/// float before (`grown`). Objects may be divided; their parts are grown.
class grown_stage : public global_stage {
public:
    /// @param d finite and not negative
    /// @throws input_error on another d
    grown_stage(std::unique_ptr<global_stage> search, double d) : search_(std::move(search)), d_(d) {
        require_distance(d);
    }

    [[nodiscard]] std::unique_ptr<scene_parts> divide(const mesh_scene& scene) override {
        return search_->divide(scene);
    }
    void expect(std::size_t frames) override { search_->expect(frames); }
    void insert(std::uint32_t id) override { search_->insert(id); }
    void remove(std::uint32_t id) override { search_->remove(id); }
    void update(std::span<const box> boxes) override {
        require_valid(boxes);  // an inverted box may be valid once it is grown
        grown_.clear();
        for (const box& b : boxes) grown_.push_back(grown(b, d_));
        search_->update(grown_);
    }
    void search(std::vector<index_pair>& pairs) override { search_->search(pairs); }

    [[nodiscard]] bool finds_overlaps_only() const override { return false; }
    [[nodiscard]] double share_of_update() const override { return search_->share_of_update(); }
    [[nodiscard]] work_counters counters() const override { return search_->counters(); }
    [[nodiscard]] std::vector<part_bytes> bytes() const override {
        std::vector<part_bytes> parts = search_->bytes();
        parts.push_back({"grown boxes", bytes_of(grown_)});
        return parts;
    }
    [[nodiscard]] std::vector<stage_plan> plans() const override { return search_->plans(); }
    [[nodiscard]] std::vector<omission> left_out() const override { return search_->left_out(); }

protected:
    /// The same for boxes in double.
    /// @throws input_error as `require_valid`
    void update_in_double(std::span<const boxd> boxes) {
        require_valid(boxes);
        grown_in_double_.clear();
        for (const boxd& b : boxes) grown_in_double_.push_back(grown(b, d_));
        search_->update(floats_.round(grown_in_double_));
    }
    [[nodiscard]] double distance() const noexcept { return d_; }

private:
    std::unique_ptr<global_stage> search_;
    double d_;
    std::vector<box> grown_;
    std::vector<boxd> grown_in_double_;
    float_boxes floats_;
};

/// The same, and decides: finds exactly the pairs of boxes at a distance of at most `d`.
class within_stage final : public grown_stage {
public:
    /// @param in_double a scene whose boxes in double decide, if it has some in the current frame; may be null
    within_stage(std::unique_ptr<global_stage> search, double d, box_metric metric = box_metric::euclidean,
                 const box_scene* in_double = nullptr)
        : grown_stage(std::move(search), d), metric_(metric), scene_(in_double) {}

    void update(std::span<const box> boxes) override {
        boxes_ = boxes;
        in_double_ = scene_ ? scene_->in_double() : std::span<const boxd>();
        if (in_double_.empty())
            grown_stage::update(boxes);
        else
            update_in_double(in_double_);
    }
    void search(std::vector<index_pair>& pairs) override {
        const auto before = static_cast<std::ptrdiff_t>(pairs.size());
        grown_stage::search(pairs);
        const auto is_farther = [&](index_pair p) {
            return in_double_.empty() ? !are_within(boxes_[p.a], boxes_[p.b], distance(), metric_)
                                      : !are_within(in_double_[p.a], in_double_[p.b], distance(), metric_);
        };
        pairs.erase(std::remove_if(pairs.begin() + before, pairs.end(), is_farther), pairs.end());
    }

private:
    box_metric metric_;
    const box_scene* scene_;
    std::span<const box> boxes_;
    std::span<const boxd> in_double_;
};

/// Prepares boxes for a broad phase composed at compile time, as in `prepared_search<grow_boxes, Search>`: as
/// `grown_stage` does, before meshes are compared by `within_detection`.
struct grow_boxes {
    static constexpr std::string_view name = "grow_boxes";
    static constexpr std::string_view summary = "boxes are grown, so that near ones overlap";

    double d = 0;

    [[nodiscard]] std::unique_ptr<global_stage> before(std::unique_ptr<global_stage> search, instrumentation) const {
        return std::make_unique<grown_stage>(std::move(search), d);
    }
};

/// The same as `within_stage` does: pairs are those of boxes at a distance of at most `d`. Of boxes of floats, since
/// `detector_in_double` drops pairs that do not overlap.
struct near_boxes {
    static constexpr std::string_view name = "near_boxes";
    static constexpr std::string_view summary = "pairs of boxes that are near each other";

    double d = 0;
    box_metric metric = box_metric::euclidean;

    [[nodiscard]] std::unique_ptr<global_stage> before(std::unique_ptr<global_stage> search, instrumentation) const {
        return std::make_unique<within_stage>(std::move(search), d, metric);
    }
};

static_assert(PreparePolicy<grow_boxes> && PreparePolicy<near_boxes>);

}  // namespace aabb
