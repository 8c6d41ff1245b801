module;
#include <array>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

export module aabb:subset_lists;

import :counters;
import :error;
import :geometry;
import :membership;
import :policy;
import :projection;

export namespace aabb {

/// Puts objects into subsets, such that two overlapping boxes share at least one and exactly one owns the pair. A
/// policy without `for_each_subset` keeps all objects together.
template <class P>
concept PartitionPolicy = Strategy<P>;

/// A partition that really cuts. `axes(boxes, objects, swept)` says which sorted lists it needs beside those of the
/// sweep; `fit(all)` decides the subsets of a frame; `for_each_subset(id, b, visit)` calls
/// `visit(subset, owned_axes)` for each subset that box b of object `id` reaches into, and `copies(id, b)` says how
/// many those are without a walk over them.
template <class P>
concept CuttingPartition =
    PartitionPolicy<P> &&
    requires(P policy, const P fitted, std::span<const box> boxes, const membership& objects, axis_set swept,
             const whole_subset& all, std::uint32_t id, const box& b, void (*visit)(std::uint32_t, axis_set)) {
        { policy.axes(boxes, objects, swept) } -> std::same_as<axis_set>;
        policy.fit(all);
        { fitted.subset_count() } -> std::convertible_to<std::uint32_t>;
        fitted.for_each_subset(id, b, visit);
        { fitted.copies(id, b) } -> std::convertible_to<std::uint64_t>;
    };

/// Into how many segments axes were to be cut, and were; summed over the axes.
struct segment_counts {
    std::uint64_t wanted;
    std::uint64_t got;
};

/// A partition whose subsets come from segments of axes.
template <class P>
concept SegmentingPartition = CuttingPartition<P> && requires(const P fitted) {
    { fitted.segments() } -> std::same_as<segment_counts>;
};

/// The subsets of one frame: for each list the entries of all subsets, subset after subset. Filled from sorted lists in
/// order, so the sublists come sorted for free.
class subset_lists {
public:
    /// Nothing is partitioned: one subset of all, without a list of its own.
    void clear() noexcept { starts_.resize(1); }

    /// @param axes whose lists are to be distributed; at least one
    /// @throws input_error when the partition makes more than 2^24 + 64 n copies of n objects.
    template <CuttingPartition Partition, CounterPolicy Counters>
    void distribute(const Partition& partition, const whole_subset& all, axis_set axes, Counters& counters) {
        bool counted = false;
        for (std::size_t k = 0; k < 3; ++k) {
            if (!has_axis(axes, k)) {
                entries_[k].clear();
                continue;
            }
            if (!counted) count(partition, all.boxes, all.lists[k]);
            counted = true;
            entries_[k].resize(starts_.back());
            next_.assign(starts_.begin(), starts_.end() - 1);
            for (const projection& p : all.lists[k])
                partition.for_each_subset(p.id, all.boxes[p.id], [&](std::uint32_t s, axis_set owned) {
                    entries_[k][next_[s]++] = {p.id, owned};
                });
        }
        counters.add(work::subsets, size());
        counters.add(work::subset_copies, starts_.back());
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
    /// Room for a scene of few objects, some of them huge, and far more than a search of many gains by: 128 MiB and 512
    /// bytes an object a list.
    [[nodiscard]] static constexpr std::uint64_t most_copies(std::size_t objects) noexcept {
        return (std::uint64_t{1} << 24) + 64 * std::uint64_t{objects};
    }

    /// Sets starts_: of each subset the number of entries before it.
    template <class Partition>
    void count(const Partition& partition, std::span<const box> boxes, std::span<const projection> any) {
        const std::uint32_t subsets = partition.subset_count();
        starts_.assign(std::size_t{subsets} + 1, 0);
        std::size_t copies = 0;
        for (const projection& p : any) {
            partition.for_each_subset(p.id, boxes[p.id], [&](std::uint32_t s, axis_set) {
                ++starts_[s + 1];
                ++copies;
            });
            // While they are counted: to walk over them all could take hours.
            if (copies > most_copies(any.size())) refuse(partition, boxes, any);
        }
        for (std::size_t s = 0; s < subsets; ++s) starts_[s + 1] += starts_[s];
    }

    template <class Partition>
    [[noreturn]] static void refuse(const Partition& partition, std::span<const box> boxes,
                                    std::span<const projection> any) {
        std::uint64_t copies = 0;
        for (const projection& p : any) copies += partition.copies(p.id, boxes[p.id]);
        throw input_error(std::string(Partition::name) + " makes " + std::to_string(copies) + " copies of " +
                          std::to_string(any.size()) + " objects, but at most " +
                          std::to_string(most_copies(any.size())) +
                          " (2^24 + 64 an object) are allowed; fewer cuts make fewer");
    }

    std::vector<std::size_t> starts_{0};
    std::vector<std::size_t> next_;
    std::array<std::vector<subset_entry>, 3> entries_;
};

/// What stands in place of the subsets where nothing is cut.
struct no_subsets {};

}  // namespace aabb
