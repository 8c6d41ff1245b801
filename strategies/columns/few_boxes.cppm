export module aabb.columns.few_boxes;

import aabb.base;
import aabb.columns.groups;
import aabb.columns.plan;
import aabb.counters;
import aabb.geometry;
import aabb.simd;
import aabb.std;

export namespace aabb {

/// Boxes that are so few that each is tested against all others, a vector at a time: to sort or cut them would take
/// longer.
class few_boxes {
public:
    /// @param group in the order of ids
    /// @returns whether all are valid; if not, there is nothing to search.
    [[nodiscard]] bool fill(const column_group& group) {
        group_ = group;
        vectors_.resize((group.boxes.size() + width - 1) / width);
        simd::flags invalid{};
        for_each_vector(group.boxes, [&](std::size_t i, const simd::floats(&c)[6], std::uint32_t) {
            invalid |= are_invalid(c);
            std::ranges::copy(c, vectors_[i / width].coordinates);
        });
        return simd::bits(invalid) == 0;
    }

    template <CounterPolicy Counters>
    void search(std::vector<index_pair>& pairs, Counters& counters) {
        const std::size_t n = group_.boxes.size();
        met_.resize(n * vectors_.size());
        std::size_t found = 0;
        std::size_t tests = 0;
        for (std::size_t v = 0; v < vectors_.size(); ++v) {
            const vector_of_boxes vector = vectors_[v];
            const std::size_t first = v * width;
            const std::uint32_t present = simd::lanes_below(n - first);
            const auto test = [&](std::size_t i, std::uint32_t wanted) {
                const std::uint32_t lanes = vector.met_by(group_.boxes[i]) & wanted;
                // Kept without a branch, since whether there are any cannot be foreseen.
                met_[found] = {static_cast<std::uint32_t>(i), static_cast<std::uint32_t>(first), lanes};
                found += static_cast<std::size_t>(lanes != 0);
            };
            for (std::size_t i = 0; i < first; ++i) test(i, present);
            const std::size_t end = std::min(n, first + width);
            for (std::size_t i = first; i < end; ++i) test(i, present & ~simd::lanes_below(i - first + 1));
            tests += end;
        }
        counters.add(work::box_tests, width * tests);
        report(std::span(met_).first(found), pairs);
    }

    [[nodiscard]] std::size_t bytes() const noexcept { return bytes_of(vectors_) + bytes_of(met_); }

private:
    static constexpr std::size_t width = simd::width;

    struct vector_of_boxes {
        simd::floats coordinates[6];

        /// Bit l is set where box l overlaps this one.
        [[nodiscard, gnu::always_inline]] inline std::uint32_t met_by(const box& b) const noexcept {
            simd::flags met = (coordinates[0] <= b.max[0]) & (coordinates[3] >= b.min[0]);
            for (int k = 1; k < 3; ++k) met &= (coordinates[k] <= b.max[k]) & (coordinates[3 + k] >= b.min[k]);
            return simd::bits(met);
        }
    };
    /// A box, and those behind it in a vector that it overlaps.
    struct met_lanes {
        std::uint32_t box;
        std::uint32_t first;  ///< of the vector
        std::uint32_t lanes;
    };

    void report(std::span<const met_lanes> all, std::vector<index_pair>& pairs) const {
        std::size_t next = pairs.size();
        std::size_t end = next;
        for (const met_lanes& met : all) end += static_cast<std::size_t>(std::popcount(met.lanes));
        pairs.resize(end);
        for (const met_lanes& met : all)
            for (std::uint32_t lanes = met.lanes; lanes != 0; lanes &= lanes - 1)
                pairs[next++] = {id_of(met.box),
                                 id_of(met.first + static_cast<std::uint32_t>(std::countr_zero(lanes)))};
    }

    [[nodiscard]] std::uint32_t id_of(std::uint32_t place) const noexcept {
        return group_.ids.empty() ? place : group_.ids[place];
    }

    column_group group_{};
    std::vector<vector_of_boxes> vectors_;
    std::vector<met_lanes> met_;
};

}  // namespace aabb
