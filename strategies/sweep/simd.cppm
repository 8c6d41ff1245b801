export module aabb.sweep.simd;

import aabb.columns;
import aabb.std;

export namespace aabb {

/// Sweep and prune along one sorted list by vectors: each active box, which began earlier and has not ended, is tested
/// against a whole vector of boxes. When to use: always on processors with wide vectors.
///
/// The two axes across the list are tested in quantized u16 coordinates packed in a u32, so that a vector of 512 bits
/// tests 16 boxes in five instructions. This conservative test leaves few candidates, which are then tested exactly.
class simd_sweep {
public:
    static constexpr std::string_view name = "simd";
    static constexpr std::string_view summary = "sweeps along one axis and tests a vector of boxes at a time";

    /// @throws input_error if there are more objects than the index bits of an entry can represent.
    axis_set axes(std::span<const box> boxes, const membership& objects) {
        if (boxes.size() > column_entry::index_mask)
            throw input_error("simd takes at most " + std::to_string(column_entry::index_mask) + " objects");
        return axis_set{1} << longest_.choose(boxes, objects);
    }

    /// Sweeps the sorted list as a single column.
    template <class Subset, CounterPolicy Counters>
    void sweep(const Subset& subset, std::vector<index_pair>& pairs, Counters& counters) {
        const auto& list = subset.lists[static_cast<std::size_t>(longest_.axis())];
        if (list.size() < 2) return;
        convert_to_entries(subset, list);
        const column_block block{
            .boxes = subset.boxes, .ids = {}, .entries = entries_, .ends = list_ends_, .axis = longest_.axis()};
        sweep(block, pairs, /*most_tests=*/std::numeric_limits<std::uint64_t>::max(), counters);
    }

    /// Sweeps columns, a vector of entries at a time: tests it against the active entries, which begin before it and
    /// have not ended, and against itself. Pairs whose quantized boxes overlap are candidates, which are tested exactly
    /// later. A candidate is an entry, and the number of a vector with a bit per lane that it may overlap; vectors are
    /// numbered from the entry `window` on, since few bits are left for the number.
    /// @param most_tests the sweep stops early after this many vector tests
    /// @returns the number of vector tests
    template <CounterPolicy Counters>
    std::uint64_t sweep(const column_block& block, std::vector<index_pair>& pairs, std::uint64_t most_tests,
                        Counters& counters) {
        const std::size_t n = block.entries.size();
        active_.resize(n + width);
        active_ends_.resize(n + width);
        std::uint64_t tests = 0;
        std::size_t active = 0;
        candidate_count_ = 0;
        std::size_t window = 0;
        for (std::size_t first = 0; first < n && tests <= most_tests; first += width) {
            if (candidate_count_ > most_waiting || first - window >= most_vectors * width) {
                append_overlapping(block, window, pairs);
                window = first;
            }
            // This vector may add every active entry and each of its own, and both are stored by whole vectors.
            make_room(candidate_count_ + active + 3 * width);
            const vector_of_entries vector(&block.entries[first], block.ends);
            const auto number = static_cast<std::uint32_t>((first - window) / width);
            tests += active + width - 1;  // all but the last entry of the vector are tested within it
            active = test_active(block, vector, number, first, active);
            test_within(block, vector, number, first);
        }
        append_overlapping(block, window, pairs);
        counters.add(work::box_tests, width * tests);
        return tests;
    }

    [[nodiscard]] std::size_t bytes() const noexcept {
        return bytes_of(entries_, list_ends_, active_, active_ends_, candidates_, met_);
    }

private:
    static constexpr std::size_t width = simd::width;
    static constexpr std::size_t most_waiting = 2048;  // candidates between two exact tests
    static constexpr std::size_t most_vectors = std::size_t{1} << (32 - width);

    /// A vector of entries as a structure of arrays.
    struct vector_of_entries {
        simd::words lower;
        simd::words upper;
        simd::words ends;
        simd::words begins_earlier;

        /// Transposes entries: their quantized bounds across the column, where their overlaps along it end (behind the
        /// bucket in which each box ends), and the axes on which each begins in an earlier column.
        vector_of_entries(const column_entry* from, std::span<const std::uint32_t> bucket_ends) noexcept {
            simd::words fields[4];
            simd::load_rows_of_four(&from->lower, fields);
            lower = fields[0];
            upper = fields[1];
            ends = simd::gather(bucket_ends.data(), fields[2]);
            begins_earlier = fields[3] & ~column_entry::index_mask;
        }

        /// Bit l is set if entry l may overlap `e` across the columns, and this column owns the pair.
        [[nodiscard]] inline std::uint32_t overlap_mask(const column_entry& e) const noexcept {
            return simd::bits(((begins_earlier & e.index) |
                               simd::saturated_difference(lower, simd::broadcast(e.upper)) |
                               simd::saturated_difference(simd::broadcast(e.lower), upper)) == 0U);
        }
    };

    /// The boxes of a vector of entries as a structure of arrays, and their ids.
    struct vector_of_boxes {
        simd::floats bounds[6];
        simd::words ids;

        // Inlined, so that the loop over candidates keeps the vector in registers.
        [[gnu::always_inline]] inline vector_of_boxes(const column_block& block, const column_entry* entries) noexcept {
            box boxes[width];
            std::uint32_t ids_of_boxes[width];
            for (std::size_t l = 0; l < width; ++l) {
                const std::uint32_t i = entries[l].index & column_entry::index_mask;
                boxes[l] = block.boxes[i];
                ids_of_boxes[l] = block.id_of(i);
            }
            simd::load_rows_of_six(boxes[0].min.at, bounds);
            ids = simd::load(ids_of_boxes);
        }

        /// Bit l is set if box l overlaps `b`.
        [[nodiscard]] inline std::uint32_t overlap_mask(const box& b) const noexcept {
            simd::flags overlapping = (bounds[0] <= b.max[0]) & (bounds[3] >= b.min[0]);
            for (int k = 1; k < 3; ++k) overlapping &= (bounds[k] <= b.max[k]) & (bounds[3 + k] >= b.min[k]);
            return simd::bits(overlapping);
        }
    };

    /// The lanes of a vector that each of a few entries may overlap.
    using lane_overlaps = std::array<std::uint16_t, width>;

    /// A function of its own: inlined, the growth of two buffers takes registers from the loop over vectors.
    void make_room(std::size_t candidates) {
        if (candidates <= met_.size()) return;
        candidates_.resize(candidates);
        met_.resize(candidates);
    }

    /// Stores as candidates the entries that may overlap any lane, branch-free since that is hard to predict.
    /// @param present the lanes of `entries` in use
    /// @param met,lanes by entry: the lanes that it may overlap, and those that it is to be tested against
    inline void keep_candidates(simd::words entries, std::uint32_t present, const lane_overlaps& met, simd::words lanes,
                                std::uint32_t vector) noexcept {
        const simd::words overlapped = simd::load_halves(met.data()) & lanes;
        const std::uint32_t any = simd::bits(overlapped != 0U) & present;
        simd::compress_store(&candidates_[candidate_count_], entries, any);
        candidate_count_ += simd::compress_store(&met_[candidate_count_], overlapped | vector << width, any);
    }

    /// Tests the active entries against the lanes of the vector before their ends, and updates the active entries.
    /// @param number,first the number of the vector, and the index of its first entry
    /// @returns the number of entries that stay active beyond the vector
    [[nodiscard]] std::size_t test_active(const column_block& block, const vector_of_entries& vector,
                                          std::uint32_t number, std::size_t first, std::size_t active) noexcept {
        const auto next = static_cast<std::uint32_t>(first + width);  // the first entry behind the vector
        std::size_t stay = 0;
        const auto keep_if_beyond = [&](simd::words entries, simd::words ends, std::uint32_t present) {
            const std::uint32_t beyond = simd::bits(ends > next) & present;
            simd::compress_store(&active_ends_[stay], ends, beyond);
            stay += simd::compress_store(&active_[stay], entries, beyond);
        };
        lane_overlaps met{};
        for (std::size_t q = 0; q < active; q += width) {
            const simd::words entries = simd::load(&active_[q]);
            const simd::words ends = simd::load(&active_ends_[q]);
            const std::size_t count = std::min(width, active - q);
            for (std::size_t l = 0; l < count; ++l)
                met[l] = static_cast<std::uint16_t>(vector.overlap_mask(block.entries[active_[q + l]]));
            const std::uint32_t present = simd::lanes_below(count);
            keep_candidates(entries, present, met, simd::lanes_below(ends - static_cast<std::uint32_t>(first)), number);
            keep_if_beyond(entries, ends, present);
        }
        keep_if_beyond(simd::places() + static_cast<std::uint32_t>(first), vector.ends, simd::every_lane);
        return stay;
    }

    /// Tests the entries of the vector against each other: each against the later ones that begin before it ends.
    void test_within(const column_block& block, const vector_of_entries& vector, std::uint32_t number,
                     std::size_t first) noexcept {
        // By lane: a mask of the lanes behind it.
        const simd::words later = simd::broadcast(~std::uint32_t{1}) << simd::places();
        const simd::words lanes = simd::lanes_below(vector.ends - static_cast<std::uint32_t>(first)) & later;
        lane_overlaps met{};
#pragma clang loop unroll(full)
        for (std::size_t l = 0; l + 1 < width; ++l)
            met[l] = static_cast<std::uint16_t>(vector.overlap_mask(block.entries[first + l]));
        keep_candidates(simd::places() + static_cast<std::uint32_t>(first), simd::every_lane, met, lanes, number);
    }

    /// Tests the candidates exactly, appends the overlapping pairs, and empties the list of candidates.
    /// @param window the entry from which the candidates number vectors
    void append_overlapping(const column_block& block, std::size_t window, std::vector<index_pair>& pairs) {
        if (candidate_count_ == 0) return;
        std::size_t lanes = 0;
        for (std::size_t c = 0; c < candidate_count_; ++c)
            lanes += static_cast<std::size_t>(std::popcount(met_[c] & simd::every_lane));
        const std::size_t before = pairs.size(), most = before + lanes + width;
        if (most > pairs.capacity()) pairs.reserve(std::max(most, 2 * pairs.capacity()));
        pairs.resize(most);
        // By vectors, all boxes of those in which there are candidates are loaded; else, one for each candidate.
        const std::size_t vectors = (met_[candidate_count_ - 1] >> width) - (met_[0] >> width) + 1;
        const bool by_vectors = vectors * width + candidate_count_ < lanes;
        const index_pair* const end = by_vectors ? store_by_vectors(block, window, &pairs[before])
                                                 : store_one_by_one(block, window, &pairs[before]);
        pairs.resize(static_cast<std::size_t>(end - pairs.data()));
        candidate_count_ = 0;
    }

    /// @returns the end of the stored pairs
    [[nodiscard]] index_pair* store_one_by_one(const column_block& block, std::size_t window,
                                               index_pair* next) const noexcept {
        for (std::size_t c = 0; c < candidate_count_; ++c) {
            const std::uint32_t met = met_[c];  // the number of a vector, then a bit per lane
            const std::uint32_t i = block.entries[candidates_[c]].index & column_entry::index_mask;
            const box a = block.boxes[i];
            const std::uint32_t id = block.id_of(i);
            const column_entry* const vector = &block.entries[window + (met >> width) * width];
            for (std::uint32_t lanes = met & simd::every_lane; lanes != 0; lanes &= lanes - 1) {
                const std::uint32_t j = vector[std::countr_zero(lanes)].index & column_entry::index_mask;
                // No branch: a pair that does not overlap is overwritten by the next one.
                *next = ordered_pair(id, block.id_of(j));
                next += overlaps(a, block.boxes[j]);
            }
        }
        return next;
    }

    /// Tests an entry against all lanes of a vector at once, whose boxes are loaded for all its candidates.
    /// @returns the end of the stored pairs, behind which `width` more may be overwritten
    [[nodiscard]] index_pair* store_by_vectors(const column_block& block, std::size_t window,
                                               index_pair* next) const noexcept {
        for (std::size_t c = 0; c < candidate_count_;) {
            const std::uint32_t number = met_[c] >> width;
            const vector_of_boxes vector(block, &block.entries[window + number * width]);
            for (; c < candidate_count_ && met_[c] >> width == number; ++c) {
                const std::uint32_t i = block.entries[candidates_[c]].index & column_entry::index_mask;
                next += simd::store_ordered_pairs(&next->a, block.id_of(i), vector.ids,
                                                  vector.overlap_mask(block.boxes[i]) & met_[c]);
            }
        }
        return next;
    }

    /// Converts a sorted list to entries of one column, quantized over its bounds. Each is a bucket of its own, whose
    /// end in `list_ends_` is the first entry that begins after its box ends.
    template <class Subset, class List>
    void convert_to_entries(const Subset& subset, const List& list) {
        column_plan plan;
        plan.axis = longest_.axis();
        box bounds = empty_box();
        for (const auto& e : list) bounds = merged(bounds, subset.boxes[e.id]);
        plan.fit(bounds);
        const std::size_t n = (list.size() + width - 1) / width * width;
        // Padding overlaps nothing.
        const column_entry padding{
            .lower = ~std::uint32_t{0}, .upper = 0, .end_bucket = static_cast<std::uint32_t>(list.size()), .index = 0};
        entries_.assign(n, padding);
        list_ends_.assign(list.size() + 1, 0);
        const int u = plan.axis_across(0), v = plan.axis_across(1);
        for (std::size_t i = 0; i < list.size(); ++i) {
            const box& b = subset.boxes[list[i].id];
            const axis_set begins_earlier = every_axis & ~Subset::owned(list[i]);
            entries_[i] = {plan.quantized(b.min[u], u) | plan.quantized(b.min[v], v) << 16,
                           plan.quantized(b.max[u], u) | plan.quantized(b.max[v], v) << 16,
                           static_cast<std::uint32_t>(i), list[i].id | begins_earlier << column_entry::index_bits};
            const auto past = std::ranges::upper_bound(list.subspan(i), b.max[plan.axis], {}, [&](const auto& e) {
                return subset.boxes[e.id].min[plan.axis];
            });
            list_ends_[i] = static_cast<std::uint32_t>(past - list.begin());
        }
    }

    chosen_axis longest_;
    std::vector<column_entry> entries_;     // of a swept list
    std::vector<std::uint32_t> list_ends_;  // of a swept list
    std::vector<std::uint32_t> active_;     // entries that began before the current vector and have not ended
    std::vector<std::uint32_t> active_ends_;
    std::vector<std::uint32_t> candidates_;  // entries that may overlap lanes of a vector
    std::vector<std::uint32_t> met_;         // by candidate: number of the vector in the window, and a bit per lane
    std::size_t candidate_count_ = 0;
};

static_assert(ListSweep<simd_sweep> && ColumnSweep<simd_sweep>);

}  // namespace aabb
