module;
#include <cassert>
#include <ranges>

export module aabb.sweep.segmented_list;

import aabb.global_search;
import aabb.std;

export namespace aabb {

/// An end of an interval as a number that orders the ends on an axis: by key, lower ends before upper ones, and by
/// object, so that there are no ties and each end is found by comparisons.
struct ordered_end {
    std::uint64_t bits;

    constexpr ordered_end() noexcept : bits(0) {}
    constexpr ordered_end(float key, std::uint32_t id, bool is_upper) noexcept {
        const auto pattern = std::bit_cast<std::uint32_t>(key + 0.0F);  // -0 becomes 0
        const std::uint32_t sign = 0x80000000U;
        const std::uint32_t ascending = (pattern & sign) != 0 ? ~pattern : pattern | sign;
        bits = std::uint64_t{ascending} << 32 | std::uint64_t{is_upper} << 31 | id;
    }
    [[nodiscard]] constexpr std::uint32_t id() const noexcept { return static_cast<std::uint32_t>(bits) & 0x7fffffffU; }
    [[nodiscard]] constexpr bool is_upper() const noexcept { return (bits >> 31 & 1) != 0; }

    friend constexpr auto operator<=>(const ordered_end&, const ordered_end&) = default;
};
static_assert(ordered_end(-2, 9, true) < ordered_end(-1, 0, false) &&
              ordered_end(-1, 0, false) < ordered_end(0.5, 0, false));
static_assert(ordered_end(1, 9, false) < ordered_end(1, 0, true) &&
              ordered_end(-0.0F, 3, false) == ordered_end(0, 3, false));

/// A segmented interval list (Tracy, Buss and Woods 2009): the sorted ends of intervals on an axis, in segments of at
/// most 64, so that inserting or erasing one moves at most a segment. A full segment is split into halves; two
/// neighbours that would fill less than half of one are merged.
///
/// With `marks_spans`, each segment also lists the objects whose intervals go on beyond it, from which `for_each_near`
/// finds the intervals that overlap one without walking the list from its beginning. Ends are found by their order; the
/// authors' program keeps pointers to them, and walks the segments of an insertion.
///
/// Memory: 8 bytes per end, in segments that are half full at least on average, and 4 per object and segment beyond
/// which it goes on.
class segmented_list {
public:
    static constexpr std::size_t capacity = 64;  // as in the authors' program
    static constexpr std::size_t filled = 48;    // ends per segment of a new list

    explicit segmented_list(bool marks_spans = false) : marks_spans_(marks_spans) {}

    /// Replaces the list by sorted ends, both of each object.
    /// @param first_segment scratch memory by id
    void assign(std::span<const ordered_end> ends, bool marks_spans, std::vector<std::uint32_t>& first_segment) {
        marks_spans_ = marks_spans;
        order_.clear();
        heads_.clear();
        free_.clear();
        for (auto s = static_cast<std::uint32_t>(segments_.size()); s-- > 0;) free_.push_back(s);
        for (std::size_t begin = 0; begin < ends.size() || begin == 0; begin += filled) {
            segment& added = segments_[append_segment()];
            const auto part = ends.subspan(begin, std::min(filled, ends.size() - begin));
            std::ranges::copy(part, added.ends.begin());
            added.size = static_cast<std::uint32_t>(part.size());
            heads_.back() = added.ends[0];
        }
        if (!marks_spans_) return;
        for (std::uint32_t at = 0; at < order_.size(); ++at)
            for (const ordered_end& e : ends_of(at)) {
                if (!e.is_upper())
                    first_segment[e.id()] = at;
                else
                    for (std::uint32_t s = first_segment[e.id()]; s < at; ++s) add_span(s, e.id());
            }
    }

    /// Inserts both ends of an object's interval.
    /// @returns the number of entries that were moved
    std::size_t insert(const ordered_end& lower, const ordered_end& upper) {
        const std::size_t moved = insert(lower) + insert(upper);
        if (marks_spans_) for_each_segment_between(lower, upper, [&](std::uint32_t at) { add_span(at, lower.id()); });
        return moved;
    }

    /// Erases both ends of an object's interval.
    /// @returns the number of entries that were moved
    std::size_t erase(const ordered_end& lower, const ordered_end& upper) {
        if (marks_spans_)
            for_each_segment_between(lower, upper, [&](std::uint32_t at) { remove_span(at, lower.id()); });
        return erase(upper) + erase(lower);
    }

    /// Moves an end to another place by swaps with its neighbours, across segments.
    /// @param on_pass gets each end that is passed; returning false ends the move and leaves the list unusable
    /// @returns the number of comparisons with neighbours
    template <class OnPass>
    std::size_t move(const ordered_end& from, const ordered_end& to, OnPass on_pass) {
        const place p = find(from);
        return from < to ? move_up(p, to, on_pass) : move_down(p, to, on_pass);
    }

    /// Visits every other object whose interval overlaps one in the list, and some that do not, each once: those that
    /// end in its first segment behind its lower end, those that go on beyond this segment, and those that begin in
    /// later segments, up to its upper end. Requires `marks_spans`.
    void for_each_near(const ordered_end& lower, const ordered_end& upper, auto visit) const {
        assert(marks_spans_);
        const place first = find(lower);
        const place last = find(upper);
        for (const ordered_end& e : ends_of(first.at).subspan(first.slot + 1))
            if (e.is_upper() && e.id() != lower.id()) visit(e.id());
        for (const std::uint32_t id : spans_[order_[first.at]])
            if (id != lower.id()) visit(id);
        for (std::uint32_t at = first.at + 1; at <= last.at; ++at)
            for (const ordered_end& e : ends_of(at).first(at == last.at ? last.slot : segment_at(at).size))
                if (!e.is_upper()) visit(e.id());
    }

    [[nodiscard]] std::size_t bytes() const noexcept {
        std::size_t total = bytes_of(segments_, spans_, free_, order_, heads_);
        for (const auto& spanning : spans_) total += bytes_of(spanning);
        return total;
    }

private:
    struct segment {
        std::array<ordered_end, capacity> ends;
        std::uint32_t size = 0;
    };
    /// The place of an end: the segment, by its place in the list, and the index in it.
    struct place {
        std::uint32_t at;
        std::uint32_t slot;
    };

    [[nodiscard]] inline segment& segment_at(std::uint32_t at) noexcept { return segments_[order_[at]]; }
    [[nodiscard]] inline const segment& segment_at(std::uint32_t at) const noexcept { return segments_[order_[at]]; }
    [[nodiscard]] inline std::span<const ordered_end> ends_of(std::uint32_t at) const noexcept {
        return std::span(segment_at(at).ends).first(segment_at(at).size);
    }

    /// The number of ends before one in a sorted range. Whole blocks are skipped, and the last one is counted by
    /// vectors: the branches of a bisection would be hard to predict, and take most of the time.
    [[nodiscard]] static inline std::uint32_t count_before(std::span<const ordered_end> ends,
                                                           const ordered_end& e) noexcept {
        constexpr std::size_t block = 32;
        std::size_t skipped = 0;
        while (skipped + block <= ends.size() && ends[skipped + block - 1] < e) skipped += block;
        std::uint64_t before = skipped;
        for (const ordered_end& other : ends.subspan(skipped, std::min(block, ends.size() - skipped)))
            before += static_cast<std::uint64_t>(other < e);
        return static_cast<std::uint32_t>(before);
    }
    /// The last segment that begins at or before an end; the first one if none does.
    [[nodiscard]] std::uint32_t segment_of(const ordered_end& e) const noexcept {
        const std::uint32_t before = count_before(heads_, e);
        const bool begins_with_it = before < heads_.size() && heads_[before] == e;
        return begins_with_it || before == 0 ? before : before - 1;
    }
    [[nodiscard]] std::uint32_t slot_for(std::uint32_t at, const ordered_end& e) const noexcept {
        return count_before(ends_of(at), e);
    }
    [[nodiscard]] place find(const ordered_end& e) const noexcept {
        const std::uint32_t at = segment_of(e);
        const std::uint32_t slot = slot_for(at, e);
        assert(slot < segment_at(at).size && segment_at(at).ends[slot] == e);
        return {at, slot};
    }

    void for_each_segment_between(const ordered_end& lower, const ordered_end& upper, auto visit) const {
        const std::uint32_t last = segment_of(upper);
        for (std::uint32_t at = segment_of(lower); at < last; ++at) visit(at);
    }

    /// Takes a free segment, or a new one with as much room for spans as any has.
    [[nodiscard]] std::uint32_t take_segment() {
        if (free_.empty()) {
            if (free_.capacity() <= segments_.size()) free_.reserve(2 * segments_.size() + 1);
            segments_.emplace_back();
            spans_.resize(segments_.size());
            spans_.back().reserve(most_spans_);
            free_.push_back(static_cast<std::uint32_t>(segments_.size() - 1));
        }
        const std::uint32_t taken = free_.back();
        free_.pop_back();
        spans_[taken].clear();
        segments_[taken].size = 0;
        return taken;
    }
    std::uint32_t append_segment() {
        const std::uint32_t taken = take_segment();
        order_.push_back(taken);
        heads_.emplace_back();
        return taken;
    }

    /// All segments get room for the most spans so far at once, so that a list that goes to and fro stops allocating.
    void add_span(std::uint32_t at, std::uint32_t id) {
        std::vector<std::uint32_t>& spanning = spans_[order_[at]];
        if (spanning.size() == most_spans_) {
            most_spans_ = std::max<std::size_t>(8, 2 * most_spans_);
            for (auto& each : spans_) each.reserve(most_spans_);
        }
        spanning.push_back(id);
    }
    void remove_span(std::uint32_t at, std::uint32_t id) noexcept {
        std::vector<std::uint32_t>& spanning = spans_[order_[at]];
        const auto found = std::ranges::find(spanning, id);
        if (found == spanning.end()) return;
        *found = spanning.back();
        spanning.pop_back();
    }
    /// An end of another object, or of one whose spans are marked, crosses the border behind a segment.
    void mark_crossing(std::uint32_t at, const ordered_end& e, bool goes_up) {
        if (!marks_spans_) return;
        if (e.is_upper() == goes_up)
            add_span(at, e.id());
        else
            remove_span(at, e.id());
    }

    std::size_t insert(const ordered_end& e) {
        std::uint32_t at = segment_of(e);
        if (segment_at(at).size == capacity) {
            split(at);
            at += heads_[at + 1] < e;
        }
        segment& s = segment_at(at);
        const std::uint32_t slot = slot_for(at, e);
        std::copy_backward(s.ends.begin() + slot, s.ends.begin() + s.size, s.ends.begin() + s.size + 1);
        s.ends[slot] = e;
        ++s.size;
        heads_[at] = s.ends[0];
        return s.size - slot;
    }

    std::size_t erase(const ordered_end& e) {
        const place p = find(e);
        segment& s = segment_at(p.at);
        std::copy(s.ends.begin() + p.slot + 1, s.ends.begin() + s.size, s.ends.begin() + p.slot);
        --s.size;
        heads_[p.at] = s.ends[0];
        const std::size_t moved = s.size - p.slot;
        const auto is_small = [this](std::uint32_t at) {
            const std::uint32_t a = segment_at(at).size, b = segment_at(at + 1).size;
            return a == 0 || b == 0 || a + b < capacity / 2;
        };
        if (p.at + 1 < order_.size() && is_small(p.at))
            merge(p.at);
        else if (p.at > 0 && is_small(p.at - 1))
            merge(p.at - 1);
        return moved;
    }

    /// Moves the upper half of a full segment into a new one behind it. The objects that go on beyond the first half
    /// are those that went on beyond the whole, but for the ends in the second half.
    void split(std::uint32_t at) {
        const std::uint32_t taken = take_segment();
        order_.insert(order_.begin() + at + 1, taken);
        segment& low = segment_at(at);
        segment& high = segments_[taken];
        std::copy(low.ends.begin() + capacity / 2, low.ends.end(), high.ends.begin());
        low.size = high.size = capacity / 2;
        heads_.insert(heads_.begin() + at + 1, high.ends[0]);
        if (!marks_spans_) return;
        for (const std::uint32_t id : spans_[order_[at]]) add_span(at + 1, id);
        for (const ordered_end& e : std::views::reverse(ends_of(at + 1))) mark_crossing(at, e, /*goes_up=*/true);
    }

    /// Appends the next segment to one.
    void merge(std::uint32_t at) {
        segment& low = segment_at(at);
        const std::uint32_t emptied = order_[at + 1];
        std::ranges::copy(ends_of(at + 1), low.ends.begin() + low.size);
        low.size += segments_[emptied].size;
        spans_[order_[at]].swap(spans_[emptied]);
        order_.erase(order_.begin() + at + 1);
        heads_.erase(heads_.begin() + at + 1);
        heads_[at] = low.ends[0];
        free_.push_back(emptied);
    }

    template <class OnPass>
    std::size_t move_up(place p, const ordered_end& moving, OnPass on_pass) {
        std::size_t comparisons = 0;
        for (;;) {
            segment* const s = &segment_at(p.at);
            const bool is_last = p.slot + 1 == s->size;
            if (is_last && p.at + 1 == order_.size()) break;
            const ordered_end next = is_last ? segment_at(p.at + 1).ends[0] : s->ends[p.slot + 1];
            ++comparisons;
            if (moving < next || !on_pass(next)) break;
            s->ends[p.slot] = next;
            if (!is_last) {
                ++p.slot;
                continue;
            }
            heads_[p.at] = s->ends[0];
            mark_crossing(p.at, moving, /*goes_up=*/true);
            mark_crossing(p.at, s->ends[p.slot], /*goes_up=*/false);
            p = {p.at + 1, 0};
        }
        segment_at(p.at).ends[p.slot] = moving;
        heads_[p.at] = segment_at(p.at).ends[0];
        return comparisons;
    }

    template <class OnPass>
    std::size_t move_down(place p, const ordered_end& moving, OnPass on_pass) {
        std::size_t comparisons = 0;
        for (;;) {
            segment* const s = &segment_at(p.at);
            if (p.slot == 0 && p.at == 0) break;
            const ordered_end next =
                p.slot == 0 ? segment_at(p.at - 1).ends[segment_at(p.at - 1).size - 1] : s->ends[p.slot - 1];
            ++comparisons;
            if (next < moving || !on_pass(next)) break;
            s->ends[p.slot] = next;
            if (p.slot > 0) {
                --p.slot;
                continue;
            }
            heads_[p.at] = s->ends[0];
            mark_crossing(p.at - 1, moving, /*goes_up=*/false);
            mark_crossing(p.at - 1, s->ends[0], /*goes_up=*/true);
            p = {p.at - 1, segment_at(p.at - 1).size - 1};
        }
        segment_at(p.at).ends[p.slot] = moving;
        heads_[p.at] = segment_at(p.at).ends[0];
        return comparisons;
    }

    bool marks_spans_ = false;
    std::vector<segment> segments_;                  // in any order
    std::vector<std::vector<std::uint32_t>> spans_;  // by segment: the objects whose intervals go on beyond it
    std::vector<std::uint32_t> free_;                // segments that are not in the list
    std::vector<std::uint32_t> order_;               // the segments of the list; one at least
    std::vector<ordered_end> heads_;                 // the first ends of these
    std::size_t most_spans_ = 0;                     // room in each vector of spans_
};

}  // namespace aabb
