module;
#include <cassert>

export module aabb.prepare.pair_list;

export import aabb.geometry;
export import aabb.simd;
import aabb.std;

#pragma clang fp contract(off) reassociate(off) reciprocal(off)  // see aabb.base:floating_point

export namespace aabb {

/// The lower or upper corner of a box as a vector; the fourth lane is arbitrary and ignored.
using corner = float __attribute__((vector_size(16)));
[[nodiscard, gnu::always_inline]] inline corner lower_of(const box& b) noexcept {
    corner v;
    std::memcpy(&v, &b, sizeof v);
    return v;
}
[[nodiscard, gnu::always_inline]] inline corner upper_of(const box& b) noexcept {
    corner v;
    std::memcpy(&v, reinterpret_cast<const char*>(&b) + sizeof(box) - sizeof v, sizeof v);
    return __builtin_shufflevector(v, v, 1, 2, 3, 0);
}

/// Same result as `overlaps`, but tests the three axes at once.
[[nodiscard, gnu::always_inline]] inline bool overlap_at_once(const box& a, const box& b) noexcept {
    using bools = bool __attribute__((ext_vector_type(4)));
    const auto overlapping = (lower_of(a) <= upper_of(b)) & (lower_of(b) <= upper_of(a));
    return (std::bit_cast<std::uint8_t>(__builtin_convertvector(overlapping, bools)) & 7U) == 7U;
}

/// Stores the overlapping pairs of a list. Tests of a vector of pairs yield a mask for one compress-store, without
/// branches, since outcomes are hard to predict.
/// @param to may equal the list; writes up to one vector beyond the list's length
/// @return the number of overlapping pairs
inline std::size_t store_overlapping(std::span<const box> boxes, std::span<const index_pair> list, index_pair* to) {
    constexpr std::size_t at_a_time = simd::width / 2;  // pairs in a vector of words
    std::size_t end = 0;
    std::size_t i = 0;
    for (; i + at_a_time <= list.size(); i += at_a_time) {
        std::uint32_t both_words = 0;  // two bits per pair, one for each of its indices
#pragma clang loop unroll(full)
        for (std::size_t k = 0; k < at_a_time; ++k)
            both_words |= (overlap_at_once(boxes[list[i + k].a], boxes[list[i + k].b]) ? 3U : 0U) << 2 * k;
        simd::words block;
        std::memcpy(&block, &list[i], sizeof block);
        end += simd::compress_store(&to[end].a, block, both_words) / 2;
    }
    for (const index_pair pair : list.subspan(i)) {
        to[end] = pair;
        end += static_cast<std::size_t>(overlap_at_once(boxes[pair.a], boxes[pair.b]));
    }
    return end;
}

/// Appends the overlapping pairs of a list, through a cached buffer, so that the output grows only by these.
inline void append_overlapping(std::span<const box> boxes, std::span<const index_pair> list,
                               std::vector<index_pair>& pairs) {
    constexpr std::size_t at_a_time = 1024;
    std::array<index_pair, at_a_time + simd::width / 2> overlaps;  // a compress-store may write a vector too many
    for (std::size_t i = 0; i < list.size(); i += at_a_time) {
        const std::size_t count =
            store_overlapping(boxes, list.subspan(i, std::min(at_a_time, list.size() - i)), overlaps.data());
        pairs.insert(pairs.end(), overlaps.begin(), overlaps.begin() + static_cast<std::ptrdiff_t>(count));
    }
}

/// The pairs of a Verlet list. Some of them are certain: they overlap by so much that they keep overlapping whatever
/// the boxes do within the margin of the list, and are reported without a test.
class pair_list {
public:
    [[nodiscard]] std::size_t size() const noexcept { return certain_.size() + uncertain_.size(); }
    [[nodiscard]] std::size_t bytes() const { return bytes_of(certain_, uncertain_); }

    /// Empties the list and returns the vector to which a search appends its pairs.
    [[nodiscard]] std::vector<index_pair>& begin_search() noexcept {
        certain_.clear();
        uncertain_.clear();
        return uncertain_;
    }

    /// Moves pairs that overlap by more than two margins to `certain_`: they do so while no box has moved by more than
    /// the margin. Both lists are written by compress-stores, the uncertain one in place.
    /// @param kept the boxes from which the list was made
    void mark_certain_pairs(std::span<const box> kept, double margin) {
        const float depth = certain_depth(margin);
        if (std::isinf(depth)) return;
        constexpr std::size_t at_a_time = simd::width / 2;
        constexpr std::uint32_t all_words = (1U << simd::width) - 1;
        const std::size_t count = uncertain_.size();
        std::size_t end = certain_.size();  // of the certain pairs
        // A compress-store may write one vector beyond the last pair.
        certain_.resize(end + count + at_a_time);
        std::size_t uncertain = 0;  // number of pairs that stay uncertain
        std::size_t i = 0;
        for (; i + at_a_time <= count; i += at_a_time) {
            std::uint32_t both_words = 0;  // two bits per pair, one for each of its indices
#pragma clang loop unroll(full)
            for (std::size_t k = 0; k < at_a_time; ++k)
                both_words |=
                    (overlap_deeper_than(depth, kept[uncertain_[i + k].a], kept[uncertain_[i + k].b]) ? 3U : 0U)
                    << 2 * k;
            simd::words block;
            std::memcpy(&block, &uncertain_[i], sizeof block);
            end += simd::compress_store(&certain_[end].a, block, both_words) / 2;
            uncertain += simd::compress_store(&uncertain_[uncertain].a, block, ~both_words & all_words) / 2;
        }
        for (; i < count; ++i) {
            const index_pair pair = uncertain_[i];
            const bool certain = overlap_deeper_than(depth, kept[pair.a], kept[pair.b]);
            certain_[end] = pair;
            end += static_cast<std::size_t>(certain);
            uncertain_[uncertain] = pair;
            uncertain += static_cast<std::size_t>(!certain);
        }
        certain_.resize(end);
        uncertain_.resize(uncertain);
    }

    /// Removes the pairs whose boxes do not overlap; certain pairs stay.
    void keep_overlapping(std::span<const box> boxes) {
        uncertain_.resize(store_overlapping(boxes, uncertain_, uncertain_.data()));
    }

    /// Tests all pairs again, since boxes have left the margin.
    void forget_certain() {
        uncertain_.insert(uncertain_.end(), certain_.begin(), certain_.end());
        certain_.clear();
    }

    template <class Gone>
    void erase_if(Gone gone) {
        std::erase_if(certain_, gone);
        std::erase_if(uncertain_, gone);
    }

    /// The whole list, which must have no certain pairs.
    [[nodiscard]] std::span<const index_pair> pairs() const noexcept {
        assert(certain_.empty());
        return uncertain_;
    }

    /// Appends the pairs of the list that overlap in this frame.
    /// @param certain_hold whether boxes are still within the margin, so that certain pairs need no test
    /// @returns the number of tests
    std::size_t append_to(std::vector<index_pair>& pairs, std::span<const box> boxes, bool certain_hold) const {
        if (certain_hold)
            pairs.insert(pairs.end(), certain_.begin(), certain_.end());
        else
            append_overlapping(boxes, certain_, pairs);
        append_overlapping(boxes, uncertain_, pairs);
        return certain_hold ? uncertain_.size() : size();
    }

    [[nodiscard]] std::size_t tests_per_frame() const noexcept { return uncertain_.size(); }

    void release() {
        aabb::release(certain_);
        aabb::release(uncertain_);
    }

private:
    /// The least overlap in floats that proves one by two margins: a difference has a relative error of 2^-24 at most.
    [[nodiscard]] static float certain_depth(double margin) noexcept {
        constexpr float infinity = std::numeric_limits<float>::infinity();
        const double depth = 2 * margin * (1 + 0x1p-22);
        return depth < double{std::numeric_limits<float>::max()} ? std::nextafter(static_cast<float>(depth), infinity)
                                                                 : infinity;
    }

    [[nodiscard, gnu::always_inline]] static bool overlap_deeper_than(float depth, const box& a,
                                                                      const box& b) noexcept {
        using bools = bool __attribute__((ext_vector_type(4)));
        const auto deep = (upper_of(b) - lower_of(a) >= depth) & (upper_of(a) - lower_of(b) >= depth);
        return (std::bit_cast<std::uint8_t>(__builtin_convertvector(deep, bools)) & 7U) == 7U;
    }

    std::vector<index_pair> certain_;
    std::vector<index_pair> uncertain_;
};

}  // namespace aabb
