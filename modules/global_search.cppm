module;
#include <algorithm>
#include <array>
#include <bit>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

export module aabb:global_search;

import :counters;
import :error;
import :geometry;
import :policy;

export namespace aabb {

/// Entry of a projection list: the lower end of an object's interval on one axis.
struct projection {
    float key;
    std::uint32_t id;
};
static_assert(sizeof(projection) == 8);

/// Set of axes, bit k for axis k.
using axis_set = std::uint32_t;
inline constexpr axis_set every_axis = 0b111;

/// Sorts a projection list by key, ascending; the order of equal keys is free. Lists come almost sorted when objects
/// move little between frames.
template <class S>
concept SortPolicy =
    Strategy<S> && requires(S policy, std::span<projection> list, no_counters none, work_counters some) {
        policy.sort(list, none);
        policy.sort(list, some);
    };

/// All objects of a frame as one subset, or the part of them that a partition put together: per axis a list of entries
/// sorted by lower end (empty for an axis the sweep did not ask for), and the boxes by id.
struct whole_subset {
    using entry = projection;
    std::span<const box> boxes;
    std::array<std::span<const projection>, 3> lists;

    /// With one subset every pair is its own.
    static constexpr bool owns(axis_set, axis_set) noexcept { return true; }
    static constexpr axis_set owned(const projection&) noexcept { return every_axis; }
};

/// A copy of an object in one subset of a partition. Bit k of `owned` says that the object's lower end on axis k lies
/// in this subset's segment of that axis.
struct subset_entry {
    std::uint32_t id;
    axis_set owned;
};

struct partition_subset {
    using entry = subset_entry;
    std::span<const box> boxes;
    std::array<std::span<const subset_entry>, 3> lists;

    /// A subset owns a pair when the greater of the two lower ends lies in it on every axis. Both boxes reach into the
    /// subset, so that is so when either lower end does: no set of pairs is needed to find duplicates.
    static constexpr bool owns(axis_set a, axis_set b) noexcept { return (a | b) == every_axis; }
    static constexpr axis_set owned(const subset_entry& e) noexcept { return e.owned; }
};

/// Puts objects into subsets, such that two overlapping boxes share at least one and exactly one owns the pair. A
/// policy without `for_each_subset` keeps all objects together.
template <class P>
concept PartitionPolicy = Strategy<P>;

/// A partition that really cuts: `fit` decides the subsets of a frame; `for_each_subset(b, visit)` calls
/// `visit(subset, owned_axes)` for each subset that box b reaches into.
template <class P>
concept CuttingPartition = PartitionPolicy<P> && requires(P policy, const P fitted, std::span<const box> boxes,
                                                          std::span<const projection> present, const box& b,
                                                          void (*visit)(std::uint32_t, axis_set)) {
    policy.fit(boxes, present);
    { fitted.subset_count() } -> std::convertible_to<std::uint32_t>;
    fitted.for_each_subset(b, visit);
};

/// Finds the overlapping pairs of a subset. `axes(boxes, present, now)` says which projection lists it needs this
/// frame: `present` is any one list, `now` the axes that are sorted already.
template <class S>
concept SweepPolicy = Strategy<S> && requires(S policy, std::span<const box> boxes, std::span<const projection> present,
                                              axis_set now, const whole_subset& all, const partition_subset& part,
                                              std::vector<index_pair>& pairs, no_counters none, work_counters some) {
    { policy.axes(boxes, present, now) } -> std::same_as<axis_set>;
    policy.sweep(all, pairs, none);
    policy.sweep(part, pairs, some);
};

namespace detail {

/// The subsets of one frame: for each list the entries of all subsets, subset after subset. Filled from sorted lists in
/// order, so the sublists come sorted for free.
class subset_lists {
public:
    template <class Partition, class Counters>
    void distribute(const Partition& partition, std::span<const box> boxes,
                    const std::array<std::vector<projection>, 3>& lists, axis_set axes, Counters& counters) {
        const std::uint32_t subsets = partition.subset_count();
        starts_.assign(std::size_t{subsets} + 1, 0);
        const auto& any = lists[static_cast<std::size_t>(std::countr_zero(axes))];
        std::size_t copies = 0;
        for (const projection& p : any) {
            partition.for_each_subset(boxes[p.id], [&](std::uint32_t s, axis_set) {
                ++starts_[s + 1];
                ++copies;
            });
            // While they are counted: to count them all could take hours.
            if (copies > most_copies)
                throw input_error(std::string(Partition::name) + " makes more than " + std::to_string(most_copies) +
                                  " copies of " + std::to_string(any.size()) + " objects");
        }
        for (std::size_t s = 0; s < subsets; ++s) starts_[s + 1] += starts_[s];
        counters.add(work::subset_copies, starts_[subsets]);
        for (std::size_t k = 0; k < 3; ++k) {
            if (!(axes >> k & 1U)) {
                entries_[k].clear();
                continue;
            }
            entries_[k].resize(starts_[subsets]);
            next_.assign(starts_.begin(), starts_.end() - 1);
            for (const projection& p : lists[k])
                partition.for_each_subset(
                    boxes[p.id], [&](std::uint32_t s, axis_set owned) { entries_[k][next_[s]++] = {p.id, owned}; });
        }
    }

    [[nodiscard]] std::uint32_t size() const noexcept { return static_cast<std::uint32_t>(starts_.size() - 1); }

    [[nodiscard]] partition_subset subset(std::uint32_t s, std::span<const box> boxes) const noexcept {
        partition_subset part{boxes, {}};
        for (std::size_t k = 0; k < 3; ++k)
            if (!entries_[k].empty())
                part.lists[k] = std::span(entries_[k]).subspan(starts_[s], starts_[s + 1] - starts_[s]);
        return part;
    }

    [[nodiscard]] std::size_t bytes() const noexcept {
        return bytes_of(starts_) + bytes_of(next_) + bytes_of(entries_[0]) + bytes_of(entries_[1]) +
               bytes_of(entries_[2]);
    }

private:
    static constexpr std::size_t most_copies = std::size_t{1} << 29;  // 4 GiB a list

    std::vector<std::size_t> starts_{0};
    std::vector<std::size_t> next_;
    std::array<std::vector<subset_entry>, 3> entries_;
};

/// What stands in place of the subsets where nothing is cut.
struct no_subsets {};

}  // namespace detail

/// Global search (paper, section 2): sorted projection lists kept between frames, an optional partition, a sweep.
///
/// Objects have stable ids, which index the boxes of a frame. A list that a frame needs and the one before did not is
/// sorted by std::sort, since insertion sort is quadratic there; afterwards by the sort policy. Nothing is allocated
/// once the buffers have grown to the scene.
template <SortPolicy Sort, PartitionPolicy Partition, SweepPolicy Sweep, CounterPolicy Counters = no_counters>
class global_search {
    static constexpr bool cuts = CuttingPartition<Partition>;
    static_assert(detail::is_accepted<detail::sentence_of<Sort, Partition, Sweep>()>);

public:
    global_search()
        requires(std::default_initializable<Sort> && std::default_initializable<Partition> &&
                 std::default_initializable<Sweep>)
    = default;
    global_search(Sort sort, Partition partition, Sweep sweep)
        : sort_(std::move(sort)), partition_(std::move(partition)), sweep_(std::move(sweep)) {}

    /// @throws input_error when the object is present already.
    void insert(std::uint32_t id) {
        if (id >= state_.size()) state_.resize(std::size_t{id} + 1, absent);
        if (is_present(id)) throw input_error("object " + std::to_string(id) + " is inserted twice");
        // An object that leaves and comes back before the next frame never left the lists.
        state_[id] = state_[id] == leaving ? listed : coming;
        if (state_[id] == coming) arrivals_.push_back(id);
    }

    /// @throws input_error when the object is not present.
    void remove(std::uint32_t id) {
        if (!is_present(id)) throw input_error("object " + std::to_string(id) + " is removed but was never inserted");
        if (state_[id] == coming) {
            std::erase(arrivals_, id);
            state_[id] = absent;
        } else {
            state_[id] = leaving;
            departures_ = true;
        }
    }

    /// Sorts and partitions the boxes of a frame, indexed by id. They are looked at again by `search`.
    /// @throws input_error on a box that is not finite or inverted, or when ids reach beyond the boxes.
    void update(std::span<const box> boxes) {
        if (state_.size() > boxes.size()) require_boxes_for_all(boxes.size());
        require_valid(boxes);
        boxes_ = boxes;
        settle();
        const axis_set needed =
            sweep_.axes(boxes, lists_[static_cast<std::size_t>(std::countr_zero(sorted_))], sorted_);
        if (const axis_set fresh = needed & ~sorted_) copy_members_to(fresh);
        for (std::size_t k = 0; k < 3; ++k)
            if (needed >> k & 1U) sort_list(k);
        for (std::size_t k = 0; k < 3; ++k)
            if (!(needed >> k & 1U)) lists_[k].clear();
        sorted_ = needed;
        if constexpr (cuts) {
            partition_.fit(boxes, std::span<const projection>(members()));
            subsets_.distribute(partition_, boxes, lists_, sorted_, counters_);
        }
    }

    /// Appends every overlapping pair, each once, a < b, in no particular order.
    void search(std::vector<index_pair>& pairs) {
        if constexpr (cuts) {
            for (std::uint32_t s = 0; s < subsets_.size(); ++s)
                sweep_.sweep(subsets_.subset(s, boxes_), pairs, counters_);
        } else {
            sweep_.sweep(whole_subset{boxes_, {lists_[0], lists_[1], lists_[2]}}, pairs, counters_);
        }
    }

    [[nodiscard]] const Counters& counters() const noexcept { return counters_; }
    [[nodiscard]] axis_set sorted_axes() const noexcept { return sorted_; }

    /// Heap bytes of the projection lists and the record of which object is present.
    [[nodiscard]] std::size_t projection_bytes() const noexcept {
        return bytes_of(lists_[0]) + bytes_of(lists_[1]) + bytes_of(lists_[2]) + bytes_of(state_) + bytes_of(arrivals_);
    }
    [[nodiscard]] std::size_t sort_bytes() const noexcept { return bytes_of(sort_); }
    /// Heap bytes of the partition and its subsets; 0 without one.
    [[nodiscard]] std::size_t partition_bytes() const noexcept {
        if constexpr (cuts)
            return bytes_of(partition_) + subsets_.bytes();
        else
            return 0;
    }
    [[nodiscard]] std::size_t sweep_bytes() const noexcept { return bytes_of(sweep_); }

private:
    enum membership : std::uint8_t { absent, coming, listed, leaving };

    [[nodiscard]] bool is_present(std::uint32_t id) const noexcept {
        return id < state_.size() && (state_[id] == coming || state_[id] == listed);
    }

    [[nodiscard]] const std::vector<projection>& members() const noexcept {
        return lists_[static_cast<std::size_t>(std::countr_zero(sorted_))];
    }

    void require_boxes_for_all(std::size_t boxes) const {
        for (std::size_t id = boxes; id < state_.size(); ++id)
            if (is_present(static_cast<std::uint32_t>(id)))
                throw input_error("object " + std::to_string(id) + " is present, but the frame has only " +
                                  std::to_string(boxes) + " boxes");
    }

    /// Brings insertions and removals into the sorted lists, whose order stays.
    void settle() {
        for (std::size_t k = 0; k < 3; ++k) {
            if (!(sorted_ >> k & 1U)) continue;
            if (departures_) std::erase_if(lists_[k], [&](const projection& p) { return state_[p.id] == leaving; });
            first_sort_ |= static_cast<axis_set>(lists_[k].empty()) << k;
            for (const std::uint32_t id : arrivals_) lists_[k].push_back({0, id});
        }
        if (departures_) std::ranges::replace(state_, leaving, absent);
        for (const std::uint32_t id : arrivals_) state_[id] = listed;
        departures_ = false;
        arrivals_.clear();
    }

    void copy_members_to(axis_set fresh) {
        for (std::size_t k = 0; k < 3; ++k)
            if (fresh >> k & 1U) lists_[k] = members();
        first_sort_ |= fresh;
    }

    void sort_list(std::size_t axis) {
        for (projection& p : lists_[axis]) p.key = boxes_[p.id].min[static_cast<int>(axis)];
        if (first_sort_ >> axis & 1U)
            std::ranges::sort(lists_[axis], {}, &projection::key);
        else
            sort_.sort(std::span(lists_[axis]), counters_);
        first_sort_ &= ~(axis_set{1} << axis);
    }

    [[no_unique_address]] Sort sort_;
    [[no_unique_address]] Partition partition_;
    [[no_unique_address]] Sweep sweep_;
    [[no_unique_address]] Counters counters_;
    [[no_unique_address]] std::conditional_t<cuts, detail::subset_lists, detail::no_subsets> subsets_;
    std::span<const box> boxes_;
    std::array<std::vector<projection>, 3> lists_;  // only those of the axes in sorted_ have entries
    axis_set sorted_ = 0b001;
    axis_set first_sort_ = 0b001;
    std::vector<membership> state_;  // by id
    std::vector<std::uint32_t> arrivals_;
    bool departures_ = false;
};

}  // namespace aabb
