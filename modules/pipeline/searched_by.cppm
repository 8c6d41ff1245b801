export module aabb.pipeline:searched_by;

import aabb.global_search;
import aabb.std;
import :stage;

export namespace aabb {

/// Heap bytes of a statically composed broad phase by part, only for parts that it has.
template <SortPolicy Sort, PartitionPolicy Partition, SweepPolicy Sweep, CounterPolicy Counters>
[[nodiscard]] std::vector<part_bytes> bytes_by_part(const global_search<Sort, Partition, Sweep, Counters>& search) {
    std::vector<part_bytes> parts{{"projections", search.projection_bytes()}, {"sort", search.sort_bytes()}};
    if constexpr (really_cuts<Partition>) parts.push_back({"partition", search.partition_bytes()});
    parts.push_back({"sweep", search.sweep_bytes()});
    return parts;
}

template <class Search>
class searched_by;

/// A statically composed broad phase behind the interface of a stage.
template <SortPolicy Sort, PartitionPolicy Partition, SweepPolicy Sweep, CounterPolicy Counters>
class searched_by<global_search<Sort, Partition, Sweep, Counters>> final : public global_stage {
public:
    explicit searched_by(global_search<Sort, Partition, Sweep, Counters> search) : search_(std::move(search)) {}

    void insert(std::uint32_t id) override { search_.insert(id); }
    void insert_all(std::span<const std::uint32_t> ids) override { search_.insert_all(ids); }
    void remove(std::uint32_t id) override { search_.remove(id); }
    void moved(std::span<const std::uint32_t> ids) override {
        if constexpr (requires { search_.moved(ids); }) search_.moved(ids);
    }
    void update(std::span<const box> boxes) override { search_.update(boxes); }
    void search(std::vector<index_pair>& pairs) override { search_.search(pairs); }
    [[nodiscard]] work_counters counters() const override { return work_of(search_.counters()); }
    [[nodiscard]] std::vector<part_bytes> bytes() const override { return bytes_by_part(search_); }

    [[nodiscard]] std::vector<stage_plan> plans() const override {
        if constexpr (SearchingPartition<Partition>)
            return search_.own().plans();
        else
            return {};
    }
    [[nodiscard]] double share_of_update() const override {
        if constexpr (SearchingPartition<Partition>)
            return search_.own().share_of_update();
        else
            return 0;
    }

    /// The features that this composition lacks, with reasons, for the command `explain`.
    [[nodiscard]] std::vector<omission> left_out() const override {
        std::vector<omission> absent;
        if constexpr (!really_cuts<Partition>) absent.push_back({absence::partition, "no cells, no copies of objects"});
        if constexpr (SearchingPartition<Partition>) absent = search_.own().left_out();
        if constexpr (CoherentSweep<Sweep>) absent.push_back({absence::other_lists});
        constexpr std::array lists{absence::x_list, absence::y_list, absence::z_list};
        for (std::size_t k = 0; k < 3; ++k)
            if (!has_axis(search_.sorted_axes(), k)) absent.push_back({lists[k]});
        if constexpr (!Counters::enabled) absent.push_back({absence::counters});
        return absent;
    }

private:
    global_search<Sort, Partition, Sweep, Counters> search_;
};

/// A preparation of boxes before the broad phase. `before(search, counted)` returns a stage that passes changed boxes
/// to the search and translates its pairs back, or the search itself if there is nothing to prepare. The stage may
/// divide objects (`global_stage::divide`), and then receives the boxes of parts.
template <class P>
concept PreparePolicy =
    Strategy<P> && requires(const P policy, std::unique_ptr<global_stage> search, instrumentation counted) {
        { policy.before(std::move(search), counted) } -> std::same_as<std::unique_ptr<global_stage>>;
    };

/// A broad phase whose strategies interact through the interface of a stage, by a few virtual calls per frame.
class stage_search {
public:
    explicit stage_search(std::unique_ptr<global_stage> stage) : stage_(std::move(stage)) {}

    [[nodiscard]] std::unique_ptr<scene_parts> divide(const mesh_scene& scene) { return stage_->divide(scene); }
    inline void insert(std::uint32_t id) { stage_->insert(id); }
    inline void remove(std::uint32_t id) { stage_->remove(id); }
    inline void moved(std::span<const std::uint32_t> ids) { stage_->moved(ids); }
    inline void update(std::span<const box> boxes) { stage_->update(boxes); }
    inline void search(std::vector<index_pair>& pairs) { stage_->search(pairs); }
    [[nodiscard]] work_counters counters() const { return stage_->counters(); }

    [[nodiscard]] friend std::vector<part_bytes> bytes_by_part(const stage_search& search) {
        return search.stage_->bytes();
    }
    [[nodiscard]] friend std::unique_ptr<global_stage> stage_of(stage_search&& search) {
        return std::move(search.stage_);
    }

private:
    std::unique_ptr<global_stage> stage_;
};

/// A broad phase composed at compile time as a stage.
template <SortPolicy Sort, PartitionPolicy Partition, SweepPolicy Sweep, CounterPolicy Counters>
[[nodiscard]] std::unique_ptr<global_stage> stage_of(global_search<Sort, Partition, Sweep, Counters>&& search) {
    return std::make_unique<searched_by<global_search<Sort, Partition, Sweep, Counters>>>(std::move(search));
}

/// A broad phase behind a strategy that prepares its boxes.
template <PreparePolicy Prepare, class Search>
class prepared_search : public stage_search {
public:
    explicit prepared_search(const Prepare& prepare = {}, Search search = Search())
        : stage_search(prepare.before(stage_of(std::move(search)), instrumentation::none)) {}
};

}  // namespace aabb
