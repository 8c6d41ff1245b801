module;
#include <cassert>

export module aabb.prepare.pair_list;

export import aabb.geometry;
export import aabb.simd;
import aabb.std;

// Sums and products as they are written: see aabb.base:floating_point.
#pragma clang fp contract(off) reassociate(off) reciprocal(off)

export namespace aabb {

/// The least and the greatest numbers of a box on all three axes, each with a fourth one of no account.
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

/// As `overlaps`, on three axes at a time.
[[nodiscard, gnu::always_inline]] inline bool meet(const box& a, const box& b) noexcept {
    using bools = bool __attribute__((ext_vector_type(4)));
    const auto held = (lower_of(a) <= upper_of(b)) & (lower_of(b) <= upper_of(a));
    return (std::bit_cast<std::uint8_t>(__builtin_convertvector(held, bools)) & 7U) == 7U;
}

/// Stores those that overlap: a vector of pairs at a time, without a branch, since which cannot be foreseen.
/// @param to may be where the list is; written are some beyond the last, at most as many as the list has and a vector
/// @return how many
inline std::size_t store_meeting(std::span<const box> boxes, std::span<const index_pair> list, index_pair* to) {
    constexpr std::size_t at_a_time = simd::width / 2;
    std::size_t end = 0;
    std::size_t i = 0;
    for (; i + at_a_time <= list.size(); i += at_a_time) {
        std::uint32_t both_words = 0;
#pragma clang loop unroll(full)
        for (std::size_t k = 0; k < at_a_time; ++k)
            both_words |= (meet(boxes[list[i + k].a], boxes[list[i + k].b]) ? 3U : 0U) << 2 * k;
        simd::words some;
        std::memcpy(&some, &list[i], sizeof some);
        end += simd::store_where(&to[end].a, some, both_words) / 2;
    }
    for (const index_pair pair : list.subspan(i)) {
        to[end] = pair;
        end += static_cast<std::size_t>(meet(boxes[pair.a], boxes[pair.b]));
    }
    return end;
}

/// Appends those that overlap. A part at a time, so that what they are stored in stays in the cache, and room that they
/// turn out not to need is not made.
inline void append_meeting(std::span<const box> boxes, std::span<const index_pair> list,
                           std::vector<index_pair>& pairs) {
    constexpr std::size_t at_a_time = 1024;
    std::array<index_pair, at_a_time + simd::width / 2> met;
    for (std::size_t i = 0; i < list.size(); i += at_a_time) {
        const std::size_t found =
            store_meeting(boxes, list.subspan(i, std::min(at_a_time, list.size() - i)), met.data());
        pairs.insert(pairs.end(), met.begin(), met.begin() + static_cast<std::ptrdiff_t>(found));
    }
}

/// Pairs of neighbours, of which some are sure: they overlap by so much that they meet whatever all boxes do within the
/// margin of the list, and are handed out without a test.
class pair_list {
public:
    [[nodiscard]] std::size_t size() const noexcept { return sure_.size() + open_.size(); }
    [[nodiscard]] std::size_t bytes() const { return bytes_of(sure_, open_); }

    /// Where a search appends what it finds; nothing is listed before, and nothing is sure.
    [[nodiscard]] std::vector<index_pair>& begin() noexcept {
        sure_.clear();
        open_.clear();
        return open_;
    }

    /// Finds those that are sure.
    /// @param kept boxes that the list is about
    void tell_sure(std::span<const box> kept, double margin) {
        const float depth = depth_beyond(margin);
        if (std::isinf(depth)) return;
        constexpr std::size_t at_a_time = simd::width / 2;
        constexpr std::uint32_t all_words = (1U << simd::width) - 1;
        const std::size_t count = open_.size();
        std::size_t end = sure_.size();
        // Room for a vector more than there may be.
        sure_.resize(end + count + at_a_time);
        std::size_t left = 0;
        std::size_t i = 0;
        for (; i + at_a_time <= count; i += at_a_time) {
            std::uint32_t both_words = 0;
#pragma clang loop unroll(full)
            for (std::size_t k = 0; k < at_a_time; ++k)
                both_words |= (overlap_by(depth, kept[open_[i + k].a], kept[open_[i + k].b]) ? 3U : 0U) << 2 * k;
            simd::words some;
            std::memcpy(&some, &open_[i], sizeof some);
            end += simd::store_where(&sure_[end].a, some, both_words) / 2;
            left += simd::store_where(&open_[left].a, some, ~both_words & all_words) / 2;
        }
        for (; i < count; ++i) {
            const index_pair pair = open_[i];
            const bool sure = overlap_by(depth, kept[pair.a], kept[pair.b]);
            sure_[end] = pair;
            end += static_cast<std::size_t>(sure);
            open_[left] = pair;
            left += static_cast<std::size_t>(!sure);
        }
        sure_.resize(end);
        open_.resize(left);
    }

    /// Those whose boxes do not meet are no longer listed; the sure ones stay.
    void keep_meeting(std::span<const box> boxes) { open_.resize(store_meeting(boxes, open_, open_.data())); }

    void forget_sure() {
        open_.insert(open_.end(), sure_.begin(), sure_.end());
        sure_.clear();
    }

    template <class Gone>
    void erase_if(Gone gone) {
        std::erase_if(sure_, gone);
        std::erase_if(open_, gone);
    }

    /// Of a list without sure ones.
    [[nodiscard]] std::span<const index_pair> whole() const noexcept {
        assert(sure_.empty());
        return open_;
    }

    /// Appends those that meet.
    /// @param within whether boxes are within the margin, so that the sure ones do
    /// @returns how many were tested
    std::size_t append_to(std::vector<index_pair>& pairs, std::span<const box> boxes, bool within) const {
        if (within)
            pairs.insert(pairs.end(), sure_.begin(), sure_.end());
        else
            append_meeting(boxes, sure_, pairs);
        append_meeting(boxes, open_, pairs);
        return within ? open_.size() : size();
    }

    /// How many are tested in each frame.
    [[nodiscard]] std::size_t tested() const noexcept { return open_.size(); }

    void release() {
        aabb::release(sure_);
        aabb::release(open_);
    }

private:
    /// By how much two boxes overlap at least, as floats tell it, if they do by two margins: a difference is off by
    /// 2^-24 of itself at most.
    [[nodiscard]] static float depth_beyond(double margin) noexcept {
        constexpr float without_end = std::numeric_limits<float>::infinity();
        const double depth = 2 * margin * (1 + 0x1p-22);
        return depth < double{std::numeric_limits<float>::max()}
                   ? std::nextafter(static_cast<float>(depth), without_end)
                   : without_end;
    }

    [[nodiscard, gnu::always_inline]] static bool overlap_by(float depth, const box& a, const box& b) noexcept {
        using bools = bool __attribute__((ext_vector_type(4)));
        const auto held = (upper_of(b) - lower_of(a) >= depth) & (upper_of(a) - lower_of(b) >= depth);
        return (std::bit_cast<std::uint8_t>(__builtin_convertvector(held, bools)) & 7U) == 7U;
    }

    std::vector<index_pair> sure_;
    std::vector<index_pair> open_;
};

}  // namespace aabb
