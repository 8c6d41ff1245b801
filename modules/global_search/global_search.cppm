module;
#include <cassert>

export module aabb.global_search;

export import :interval_ends;
export import :membership;
export import :pair_set;
export import :policies;
export import :projection;
export import :projection_lists;
export import :spread;
export import :subset_lists;

export import aabb.counters;
export import aabb.geometry;
export import aabb.policy;
import aabb.std;

export namespace aabb {

/// The broad phase (global search in the paper, section 2): sorted projection lists kept between frames, an optional
/// partition, and a sweep.
///
/// Objects have stable ids, which index the boxes of a frame; only inserted objects take part. Nothing is allocated
/// once the buffers have grown to the scene. std::bad_alloc in `insert` or `search` has no effect; in `update` it may
/// make the search unusable, which later calls then report.
template <SortPolicy Sort, PartitionPolicy Partition, SweepPolicy Sweep, CounterPolicy Counters = no_counters>
class global_search {
    static constexpr bool cuts = CuttingPartition<Partition>;
    static_assert(aabb::is_accepted<sentence_of<Sort, Partition, Sweep>()>);

public:
    global_search()
        requires(std::default_initializable<Sort> && std::default_initializable<Partition> &&
                 std::default_initializable<Sweep>)
    = default;
    global_search(Sort sort, Partition partition, Sweep sweep)
        : sort_(std::move(sort)), partition_(std::move(partition)), sweep_(std::move(sweep)) {}

    /// @throws input_error if the object is already present
    void insert(std::uint32_t id) { objects_.insert(id); }
    void insert_all(std::span<const std::uint32_t> ids) { objects_.insert_all(ids); }
    /// @throws input_error if the object is not present
    void remove(std::uint32_t id) { objects_.remove(id); }

    /// Takes the boxes of a frame, indexed by object id: updates the sorted lists that the sweep and the partition
    /// need, and distributes their entries over the subsets of the partition. `search` reads the boxes again.
    /// @throws input_error on a box that is not finite or inverted, if a present object has no box, if there are boxes
    /// but no object was ever inserted, or if the partition or `require_ieee_arithmetic` rejects the frame; then
    /// another update must succeed before the next search
    void update(std::span<const box> boxes) {
        frame_.begin();
        require_ieee_arithmetic();
        objects_.require_boxes_for_all(boxes.size());
        require_valid(boxes);
        boxes_ = boxes;
        axis_set swept = 0;  // the axes whose lists the sweep reads
        // An exception in here leaves lists half updated, so that the search takes no more frames.
        frame_.change([&] {
            lists_.settle(objects_);  // inserted and removed objects
            objects_.settle();
            swept = sweep_.axes(boxes, objects_);
            axis_set needed = swept;
            if constexpr (cuts) needed |= partition_.axes(boxes, objects_, swept);
            lists_.sort(boxes, needed, sort_, counters_);
        });
        if constexpr (cuts) {
            subsets_.clear();
            partition_.fit(lists_.all(boxes));
            assert(partition_.subset_count() > 0);
            if (partition_.subset_count() > 1)
                subsets_.distribute(partition_, lists_.all(boxes), swept, counters_);
            else
                counters_.add(work::subsets);  // a single subset is swept without copies
        }
        if constexpr (SegmentingPartition<Partition>) {
            assert(partition_.segments().got <= partition_.segments().wanted);
            counters_.add(work::segments_wanted, partition_.segments().wanted);
            counters_.add(work::segments_got, partition_.segments().got);
        }
        frame_.taken();
    }

    /// Appends every overlapping pair of the last update's boxes once, a < b, in unspecified order; none if it throws.
    /// @throws input_error if the last update failed or there was none, and as `require_ieee_arithmetic`
    void search(std::vector<index_pair>& pairs) {
        frame_.require_taken();
        require_ieee_arithmetic();
        append_guard guard(pairs);  // removes what was appended, unless it is kept
        if constexpr (cuts)
            for (std::uint32_t s = 0; s < subsets_.size(); ++s)
                sweep_.sweep(subsets_.subset(s, boxes_), pairs, counters_);
        // Without a partition, or if it made a single subset, the whole scene is swept.
        if (subsets_.size() == 0) sweep_.sweep(lists_.all(boxes_), pairs, counters_);
        guard.keep();
    }

    [[nodiscard]] const Counters& counters() const noexcept { return counters_; }
    [[nodiscard]] axis_set sorted_axes() const noexcept { return lists_.axes(); }

    /// Heap bytes of the projection lists and the set of present objects.
    [[nodiscard]] std::size_t projection_bytes() const noexcept { return lists_.bytes() + objects_.bytes(); }
    [[nodiscard]] std::size_t sort_bytes() const noexcept { return bytes_of(sort_); }
    /// Heap bytes of the partition and its subsets; 0 without a partition.
    [[nodiscard]] std::size_t partition_bytes() const noexcept {
        if constexpr (cuts)
            return bytes_of(partition_) + subsets_.bytes();
        else
            return 0;
    }
    [[nodiscard]] std::size_t sweep_bytes() const noexcept { return bytes_of(sweep_); }

private:
    [[no_unique_address]] Sort sort_;
    [[no_unique_address]] Partition partition_;
    [[no_unique_address]] Sweep sweep_;
    [[no_unique_address]] Counters counters_;
    [[no_unique_address]] std::conditional_t<cuts, subset_lists, no_subsets> subsets_;
    std::span<const box> boxes_;
    membership objects_;
    projection_lists<Counters> lists_;
    frame_state frame_;
};

/// The specialization for sweeps that keep pairs between frames, without projection lists and subsets: such a sweep has
/// lists of its own, and only requires that the sort reports its swaps.
template <SortPolicy Sort, PartitionPolicy Partition, CoherentSweep Sweep, CounterPolicy Counters>
class global_search<Sort, Partition, Sweep, Counters> {
    static_assert(aabb::is_accepted<sentence_of<Sort, Partition, Sweep>()>);

public:
    global_search() = default;
    global_search(Sort sort, Partition, Sweep sweep) : sort_(std::move(sort)), sweep_(std::move(sweep)) {}

    void insert(std::uint32_t id) { objects_.insert(id); }
    void insert_all(std::span<const std::uint32_t> ids) { objects_.insert_all(ids); }
    void remove(std::uint32_t id) { objects_.remove(id); }

    /// Updates the sweep's lists and pairs to the boxes of a frame, indexed by object id.
    /// @throws input_error on a box that is invalid or missing, and as `require_ieee_arithmetic`
    void update(std::span<const box> boxes) {
        frame_.begin();
        require_ieee_arithmetic();
        objects_.require_boxes_for_all(boxes.size());
        require_valid(boxes);
        // An exception in here leaves lists half updated, so that the search takes no more frames.
        frame_.change([&] {
            sweep_.update(boxes, objects_, sort_, counters_);
            objects_.settle();  // the insertions and removals are processed
        });
        frame_.taken();
    }

    void search(std::vector<index_pair>& pairs) {
        frame_.require_taken();
        require_ieee_arithmetic();
        append_guard guard(pairs);
        sweep_.search(pairs);
        guard.keep();
    }

    [[nodiscard]] const Counters& counters() const noexcept { return counters_; }
    [[nodiscard]] axis_set sorted_axes() const noexcept { return sweep_.axes(); }
    [[nodiscard]] std::size_t projection_bytes() const noexcept { return objects_.bytes(); }
    [[nodiscard]] std::size_t sort_bytes() const noexcept { return bytes_of(sort_); }
    [[nodiscard]] static std::size_t partition_bytes() noexcept { return 0; }
    [[nodiscard]] std::size_t sweep_bytes() const noexcept { return bytes_of(sweep_); }

private:
    [[no_unique_address]] Sort sort_;
    [[no_unique_address]] Sweep sweep_;
    [[no_unique_address]] Counters counters_;
    membership objects_;
    frame_state frame_;
};

/// The specialization for partitions with a search of their own, without projection lists.
template <SortPolicy Sort, SearchingPartition Partition, ListSweep Sweep, CounterPolicy Counters>
class global_search<Sort, Partition, Sweep, Counters> {
    static_assert(aabb::is_accepted<sentence_of<Sort, Partition, Sweep>()>);
    using own_search = typename Partition::template search_with<Sort, Sweep, Counters>;

public:
    global_search() : global_search(Sort{}, Partition{}, Sweep{}) {}
    global_search(Sort sort, Partition partition, Sweep sweep)
        : search_(std::move(sort), std::move(partition), std::move(sweep)) {}

    void insert(std::uint32_t id) { objects_.insert(id); }
    void insert_all(std::span<const std::uint32_t> ids) { objects_.insert_all(ids); }
    void remove(std::uint32_t id) { objects_.remove(id); }

    /// As `global_stage::moved`.
    void moved(std::span<const std::uint32_t> ids) noexcept { objects_.moved(ids); }

    /// Passes the boxes of a frame, indexed by object id, to the partition's own search, which also validates them.
    /// After an exception the frame does not count as taken, so that `search` rejects it.
    void update(std::span<const box> boxes) {
        if (!frame_.is_taken()) objects_.forget_moved();  // since a frame that the search has not taken
        frame_.begin();
        require_ieee_arithmetic();
        objects_.require_boxes_for_all(boxes.size());
        search_.update(boxes, objects_, counters_);
        objects_.settle();  // the insertions and removals are processed
        frame_.taken();
    }

    void search(std::vector<index_pair>& pairs) {
        frame_.require_taken();
        require_ieee_arithmetic();
        append_guard guard(pairs);
        search_.search(pairs, counters_);
        guard.keep();
    }

    [[nodiscard]] const Counters& counters() const noexcept { return counters_; }
    [[nodiscard]] static axis_set sorted_axes() noexcept { return 0; }
    [[nodiscard]] const own_search& own() const noexcept { return search_; }
    [[nodiscard]] std::size_t projection_bytes() const noexcept { return objects_.bytes(); }
    [[nodiscard]] std::size_t sort_bytes() const noexcept { return search_.sort_bytes(); }
    [[nodiscard]] std::size_t partition_bytes() const noexcept { return search_.partition_bytes(); }
    [[nodiscard]] std::size_t sweep_bytes() const noexcept { return search_.sweep_bytes(); }

private:
    own_search search_;
    [[no_unique_address]] Counters counters_;
    membership objects_;
    frame_state frame_;
};

}  // namespace aabb
