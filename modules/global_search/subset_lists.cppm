module;
#include <cassert>

export module aabb.global_search:subset_lists;

import aabb.std;
import :policies;

export namespace aabb {

/// The subsets of one frame: per list the entries of all subsets, subset after subset. Since they are filled from
/// sorted lists in order, the sublists are sorted.
class subset_lists {
public:
    /// Removes all subsets: the frame is not partitioned.
    void clear() noexcept { starts_.resize(1); }

    /// Copies each entry of the sorted lists to all subsets of the partition that its box overlaps, by a counting sort,
    /// which keeps the order. A copy also states the axes on which the box begins in the subset: a subset reports a
    /// pair only if on every axis one of the two boxes begins there, so that no pair is reported twice.
    /// @param axes axes whose lists are distributed; at least one
    /// @throws input_error if the partition makes more than 2^24 + 64 n copies of n objects
    template <CuttingPartition Partition, CounterPolicy Counters>
    void distribute(const Partition& partition, const whole_subset& scene, axis_set axes, Counters& counters) {
        assert((axes & every_axis) != 0);
        count(partition, scene.boxes, scene.lists[static_cast<std::size_t>(std::countr_zero(axes))]);
        for (std::size_t k = 0; k < 3; ++k) {
            if (!has_axis(axes, k)) {
                entries_[k].clear();
                continue;
            }
            entries_[k].resize(starts_.back());
            next_.assign(starts_.begin(), starts_.end() - 1);  // by subset: where its next entry goes
            for (const projection& p : scene.lists[k])
                partition.for_each_subset(p.id, scene.boxes[p.id], [&](std::uint32_t s, axis_set begins_here) {
                    entries_[k][next_[s]++] = {.id = p.id, .owned = begins_here};
                });
            // The partition must return the same subsets of every box as when they were counted.
            assert(std::ranges::equal(next_, std::span(starts_).subspan(1)));
        }
        counters.add(work::subsets, size());
        counters.add(work::subset_copies, starts_.back());
    }

    [[nodiscard]] std::uint32_t size() const noexcept { return static_cast<std::uint32_t>(starts_.size() - 1); }

    /// Subset s: the boxes of the frame, and on each swept axis the entries of its objects, sorted.
    [[nodiscard]] partition_subset subset(std::uint32_t s, std::span<const box> boxes) const noexcept {
        assert(s < size());
        partition_subset part{boxes, {}};
        for (std::size_t k = 0; k < 3; ++k)
            if (!entries_[k].empty())
                part.lists[k] = std::span(entries_[k]).subspan(starts_[s], starts_[s + 1] - starts_[s]);
        return part;
    }

    [[nodiscard]] std::size_t bytes() const noexcept { return bytes_of(starts_, next_, entries_); }

private:
    /// Enough for a scene of few objects, some of them huge, and far more than a search of many objects gains from: 128
    /// MiB and 512 bytes per object and list.
    [[nodiscard]] static constexpr std::uint64_t most_copies(std::size_t objects) noexcept {
        return (std::uint64_t{1} << 24) + 64 * std::uint64_t{objects};
    }

    /// Counts the copies in each subset, and sets `starts_`: subset s gets the places `starts_[s]` to `starts_[s + 1]`.
    /// @throws input_error if there are too many copies
    template <class Partition>
    void count(const Partition& partition, std::span<const box> boxes, std::span<const projection> list) {
        const std::uint32_t subsets = partition.subset_count();
        starts_.assign(std::size_t{subsets} + 1, 0);
        std::size_t copies = 0;
        for (const projection& p : list) {
            partition.for_each_subset(p.id, boxes[p.id], [&](std::uint32_t s, axis_set) {
                ++starts_[s + 1];
                ++copies;
            });
            // Checked while counting, since visiting all copies could take hours.
            if (copies > most_copies(list.size())) reject_copies(partition, boxes, list);
        }
        for (std::size_t s = 0; s < subsets; ++s) starts_[s + 1] += starts_[s];
    }

    /// Reports how many copies the partition would make; `Partition::copies` counts without visiting them.
    template <class Partition>
    [[noreturn]] static void reject_copies(const Partition& partition, std::span<const box> boxes,
                                           std::span<const projection> list) {
        std::uint64_t copies = 0;
        for (const projection& p : list) copies += partition.copies(p.id, boxes[p.id]);
        throw input_error(std::string(Partition::name) + " makes " + std::to_string(copies) + " copies of " +
                          std::to_string(list.size()) + " objects, but at most " +
                          std::to_string(most_copies(list.size())) +
                          " (2^24 + 64 per object) are allowed; fewer cuts make fewer copies");
    }

    std::vector<std::size_t> starts_{0};
    std::vector<std::size_t> next_;
    std::array<std::vector<subset_entry>, 3> entries_;
};

/// Replaces `subset_lists` in a search without partition.
struct no_subsets {
    [[nodiscard]] static constexpr std::size_t size() noexcept { return 0; }
};

}  // namespace aabb
