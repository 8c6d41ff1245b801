export module aabb.columns.groups;

export import aabb.columns.plan;
import aabb.std;

export namespace aabb {

/// The boxes of one region of a scene, contiguous in memory.
struct column_group {
    std::span<const box> boxes;
    std::span<const std::uint32_t> ids;  ///< by index, with bits of `begins_earlier`; empty if the index is the id

    [[nodiscard]] std::uint32_t marked_id(std::uint32_t index) const noexcept {
        return ids.empty() ? index : ids[index];
    }
};

/// Puts the boxes of a large scene into cache-sized groups of neighbours; each group is cut into columns separately.
/// Groups are themselves wide columns: each group that a box overlaps gets a copy of it, and copies in groups other
/// than the first are marked. A group has boxes that begin there first, in the order of the input, on any threads.
class column_groups {
public:
    /// Plans a grid whose cells are groups, to be cut into columns. It divides the columns' axes (`plan.across`) in the
    /// same proportion, into about `plan.groups` cells, no more than columns. If fewer than half as many result, as for
    /// boxes along a line, it divides the axis along the columns instead of the one with fewer cells, which becomes
    /// `plan.axis`.
    [[nodiscard]] static column_plan group_grid(column_plan plan) {
        const double groups = plan.groups;
        const std::size_t fewer = plan.across[0] < plan.across[1] ? 0 : 1;  // the axis with fewer columns
        const auto rounded = [](double number, std::uint32_t most) {
            return static_cast<std::uint32_t>(std::clamp(std::round(number), 1.0, static_cast<double>(most)));
        };
        const double ratio = std::sqrt(groups / plan.columns());
        std::array<std::uint32_t, 2> across{};
        across[fewer] = rounded(plan.across[fewer] * ratio, plan.across[fewer]);
        across[1 - fewer] = rounded(groups / across[fewer], plan.across[1 - fewer]);
        if (2 * across[0] * across[1] < groups && plan.most_along > across[fewer]) {
            const int axis_of_columns = plan.axis;
            const std::uint32_t across_other = across[1 - fewer];
            plan.axis = plan.axis_across(fewer);
            const std::size_t along = plan.axis_across(0) == axis_of_columns ? 0 : 1;  // its index in `across`
            across[along] = rounded(groups / across_other, std::min(plan.most_along, most_groups / across_other));
            across[1 - along] = across_other;
        }
        plan.across = across;
        return plan;
    }

    void clear() noexcept { starts_.resize(1); }

    /// Copies each box into all groups, cells of the grid `plan`, that it overlaps, by a parallel counting sort:
    /// threads count their boxes by group, prefix sums turn counts into start indices, and the threads copy.
    /// @param ids ids of the boxes; empty if the index is the id
    /// @param most_in_group limit on the boxes of a group, copies included
    /// @returns `complete`, or without groups `invalid`, if a box is, or `not_worthwhile` above a limit on copies
    [[nodiscard]] fill_result distribute(std::span<const box> boxes, std::span<const std::uint32_t> ids,
                                         const column_plan& plan, std::size_t most_in_group, worker_threads& threads) {
        clear();
        plan_ = plan;
        first_group_of_box_.resize(boxes.size() + simd::width);  // the last vector is stored whole
        // There are more parts than threads to balance the load.
        constexpr std::size_t least_boxes_per_part = 4096;
        const std::size_t most_parts = threads.count() > 1 ? std::size_t{4} * threads.count() : 1;
        parts_.resize(std::clamp(boxes.size() / least_boxes_per_part, std::size_t{1}, most_parts));
        spanning_boxes_.resize(boxes.size() + simd::width * parts_.size());
        first_cells_.resize(spanning_boxes_.size());
        last_cells_.resize(spanning_boxes_.size());
        threads.for_each_index(parts_.size(), [&](std::size_t p, std::size_t) { find_groups(boxes, p); });
        std::size_t copies = 0;
        for (const part& p : parts_) {
            if (p.result != fill_result::complete) return p.result;
            copies += p.copies;
        }
        if (copies > most_copies(boxes.size()) || !allocate_groups(most_in_group)) return fill_result::not_worthwhile;
        threads.for_each_index(parts_.size(), [&](std::size_t p, std::size_t) { copy_boxes(boxes, ids, parts_[p]); });
        return fill_result::complete;
    }

    [[nodiscard]] std::uint32_t size() const noexcept { return static_cast<std::uint32_t>(starts_.size() - 1); }
    [[nodiscard]] column_group group(std::uint32_t g) const noexcept {
        const std::size_t begin = starts_[g];
        const std::size_t n = starts_[g + 1] - begin;
        return {std::span(boxes_).subspan(begin, n), std::span(ids_).subspan(begin, n)};
    }

    /// Total number of boxes over all groups.
    [[nodiscard]] std::size_t copies() const noexcept { return starts_.back(); }
    /// Number of ordered pairs of boxes within groups, each box with itself included: n² without groups.
    [[nodiscard]] double pairs() const noexcept {
        double sum = 0;
        for (std::size_t g = 0; g + 1 < starts_.size(); ++g) {
            const auto n = static_cast<double>(starts_[g + 1] - starts_[g]);
            sum += n * n;
        }
        return sum;
    }
    [[nodiscard]] std::size_t fullest() const noexcept { return fullest_; }

    /// The region of a group, a cell of the grid, within the bounds of all groups. Groups at its edge extend to
    /// the bounds, since coordinates beyond the grid are clamped. Boxes may extend beyond it into other groups.
    [[nodiscard]] box region(std::uint32_t g, const box& within) const noexcept {
        box b = within;
        const std::uint32_t cell[2] = {g % plan_.across[0], g / plan_.across[0]};
        for (std::size_t i = 0; i < 2; ++i) {
            const int k = plan_.axis_across(i);
            if (plan_.scale[k] <= 0) continue;  // an axis without extent
            // The grid divides the 2^16 quantized coordinates.
            const float cell_width = 65'536.0F / static_cast<float>(plan_.across[i]) / plan_.scale[k];
            const auto border = [&](std::uint32_t c) {
                return std::clamp(plan_.origin[k] + static_cast<float>(c) * cell_width, within.min[k], within.max[k]);
            };
            if (cell[i] > 0) b.min[k] = border(cell[i]);
            if (cell[i] + 1 < plan_.across[i]) b.max[k] = border(cell[i] + 1);
        }
        return b;
    }

    [[nodiscard]] std::size_t bytes() const noexcept {
        std::size_t total =
            bytes_of(first_group_of_box_, spanning_boxes_, first_cells_, last_cells_, boxes_, ids_, starts_);
        for (const part& p : parts_) total += bytes_of(p.next, p.next_copy);
        return total;
    }

private:
    static constexpr std::uint32_t most_groups = 16'384;

    /// A range of boxes that one thread distributes.
    struct part {
        std::size_t begin;
        std::size_t end;
        std::size_t spanning_begin;  // the part's range in `spanning_boxes_`, the boxes that overlap several groups
        std::size_t spanning_end;
        std::vector<std::size_t> next;       // by group: number of boxes that begin there, then the next one's index
        std::vector<std::size_t> next_copy;  // the same for copies
        std::size_t copies;
        fill_result result;
    };

    /// The limit on copies above which groups are not worth their cost.
    [[nodiscard]] static constexpr std::size_t most_copies(std::size_t boxes) noexcept { return 65'536 + 4 * boxes; }

    /// The first pass over a part: finds by vectors the groups of each box's lower and upper corner, lists the boxes
    /// that span several groups, and counts the boxes by group.
    void find_groups(std::span<const box> boxes, std::size_t part_index) {
        part& p = parts_[part_index];
        const std::size_t length = (boxes.size() / parts_.size() + simd::width) / simd::width * simd::width;
        p.begin = std::min(boxes.size(), part_index * length);
        p.end = std::min(boxes.size(), p.begin + length);
        p.next.assign(plan_.columns(), 0);
        p.next_copy.assign(plan_.columns(), 0);
        p.spanning_begin = p.spanning_end = p.begin + part_index * simd::width;
        p.copies = 0;
        const int u = plan_.axis_across(0), v = plan_.axis_across(1);
        // Each u32 word holds two u16, that of axis u low and that of axis v high; c has three lower, three upper ends.
        // A quantized coordinate times the number of groups, >> 16, is its group.
        const simd::words across = simd::broadcast(plan_.across[0] | plan_.across[1] << 16);
        simd::flags invalid{};
        for_each_vector(boxes.subspan(p.begin, p.end - p.begin), [&](std::size_t i, const simd::floats(&c)[6],
                                                                     std::uint32_t present) {
            invalid |= are_invalid(c);
            const simd::words first =
                simd::high_products(plan_.quantized(c[u], u) | plan_.quantized(c[v], v) << 16, across);
            const simd::words last =
                simd::high_products(plan_.quantized(c[3 + u], u) | plan_.quantized(c[3 + v], v) << 16, across);
            simd::store_low_halves(&first_group_of_box_[p.begin + i],
                                   (first & 0xffffU) + (first >> 16) * plan_.across[0]);
            const std::uint32_t spanning = simd::bits(first != last) & present;
            simd::compress_store(&first_cells_[p.spanning_end], first, spanning);
            simd::compress_store(&last_cells_[p.spanning_end], last, spanning);
            p.spanning_end += simd::compress_store(&spanning_boxes_[p.spanning_end],
                                                   simd::places() + static_cast<std::uint32_t>(p.begin + i), spanning);
        });
        p.result = simd::bits(invalid) == 0 ? fill_result::complete : fill_result::invalid;
        if (p.result == fill_result::complete) count_boxes(p, boxes.size());
    }

    /// Counts by group the boxes of a part that begin there (`next`), and the copies of spanning boxes (`next_copy`).
    /// Too many copies make the part's result `not_worthwhile`.
    void count_boxes(part& p, std::size_t boxes) {
        std::size_t* const counts = p.next.data();
        for (const std::uint16_t group : std::span(first_group_of_box_).subspan(p.begin, p.end - p.begin))
            ++counts[group];
        for (std::size_t s = p.spanning_begin; s < p.spanning_end; ++s) {
            for_each_later_group(s, [&](std::uint32_t group, std::uint32_t) {
                ++p.next_copy[group];
                ++p.copies;
            });
            if (p.copies > most_copies(boxes)) {
                p.result = fill_result::not_worthwhile;
                return;
            }
        }
    }

    /// Turns the parts' counts into the indices where each writes; in a group, the boxes that begin in it come first.
    /// @returns whether no group exceeds the limit; if one does, all groups are discarded
    [[nodiscard]] bool allocate_groups(std::size_t most_in_group) {
        const std::uint32_t groups = plan_.columns();
        starts_.resize(groups + 1);
        fullest_ = 0;
        std::size_t total = 0;
        const auto turn_into_start = [&](std::size_t& count) { total += std::exchange(count, total); };
        for (std::uint32_t g = 0; g < groups; ++g) {
            starts_[g] = total;
            for (part& p : parts_) turn_into_start(p.next[g]);
            for (part& p : parts_) turn_into_start(p.next_copy[g]);
            fullest_ = std::max(fullest_, total - starts_[g]);
        }
        starts_[groups] = total;
        if (fullest_ > most_in_group) {
            clear();
            return false;
        }
        if (total > boxes_.capacity()) {
            // Growth by a 16th instead of doubling: the number of copies changes little between frames.
            release(boxes_);
            release(ids_);
            boxes_.reserve(total + total / 16);
            ids_.reserve(total + total / 16);
        }
        boxes_.resize(total);
        ids_.resize(total);
        return true;
    }

    /// The last pass over a part: writes each box, in ascending order, to all its groups. In groups after its first,
    /// bits in its id mark the axes on which it begins in an earlier one.
    void copy_boxes(std::span<const box> boxes, std::span<const std::uint32_t> ids, part& p) {
        std::size_t* const next = p.next.data();
        std::size_t* const next_copy = p.next_copy.data();
        const std::uint16_t* const first_group = first_group_of_box_.data();
        box* const to = boxes_.data();
        std::uint32_t* const to_ids = ids_.data();
        const auto write = [&](std::size_t at, std::size_t i, std::uint32_t begins_earlier) {
            // Prefetch the next cache lines of the group: there are too many write streams for hardware prefetchers.
            __builtin_prefetch(to + at + 8, 1);
            __builtin_prefetch(to_ids + at + 16, 1);
            to[at] = boxes[i];
            to_ids[at] = (ids.empty() ? static_cast<std::uint32_t>(i) : ids[i]) | begins_earlier;
        };
        const auto write_to_first_group = [&](std::size_t i) {
            write(next[first_group[i]]++, i, /*begins_earlier=*/0);
        };
        std::size_t i = p.begin;  // all boxes before i are written
        for (std::size_t s = p.spanning_begin; s < p.spanning_end; ++s) {
            const std::size_t spanning = spanning_boxes_[s];
            for (; i <= spanning; ++i) write_to_first_group(i);
            for_each_later_group(s, [&](std::uint32_t group, std::uint32_t begins_earlier) {
                write(next_copy[group]++, spanning, begins_earlier);
            });
        }
        for (; i < p.end; ++i) write_to_first_group(i);
    }

    /// Calls `visit(group, bits)` for the groups of spanning box `s` after its first. The bits mark the axes on which
    /// it begins in an earlier group: an earlier group reports two boxes with the same bit, so that only one does.
    template <class Visit>
    void for_each_later_group(std::size_t s, Visit visit) const {
        const std::uint32_t u0 = first_cells_[s] & 0xffffU;
        const std::uint32_t v0 = first_cells_[s] >> 16;
        const std::uint32_t u1 = last_cells_[s] & 0xffffU;
        const std::uint32_t v1 = last_cells_[s] >> 16;
        for (std::uint32_t v = v0; v <= v1; ++v)
            for (std::uint32_t u = u0; u <= u1; ++u)
                if (u != u0 || v != v0)
                    visit(u + v * plan_.across[0],
                          (u != u0 ? column_entry::begins_earlier(plan_.axis_across(0)) : 0) |
                              (v != v0 ? column_entry::begins_earlier(plan_.axis_across(1)) : 0));
    }

    column_plan plan_;
    large_vector<std::uint16_t> first_group_of_box_;  // by box: its first group
    large_vector<std::uint32_t> spanning_boxes_;      // boxes that overlap several groups, ascending
    large_vector<std::uint32_t> first_cells_;  // of these: u16 indices on the first axis across, low, and the second
    large_vector<std::uint32_t> last_cells_;   // the same for the last group
    std::vector<part> parts_;
    large_vector<box> boxes_;  // group after group
    large_vector<std::uint32_t> ids_;
    std::vector<std::size_t> starts_{0};
    std::size_t fullest_ = 0;
};

}  // namespace aabb
