export module aabb.sweep.region_grid;

import aabb.global_search;
import aabb.std;

#pragma clang fp contract(off) reassociate(off) reciprocal(off)  // see aabb.base:floating_point

export namespace aabb {

/// A grid of regions over the bounds of a frame, with the same number of cuts per axis everywhere, for sweeps that keep
/// sorted lists per region. Boxes beyond the bounds belong to the outermost regions.
/// @tparam Axes the number of axes that may be cut
template <std::size_t Axes>
class region_grid {
public:
    using coordinates = std::array<std::uint32_t, Axes>;

    /// The regions that a box overlaps; none by default.
    struct range {
        std::array<std::uint16_t, Axes> first;
        std::array<std::uint16_t, Axes> last{};

        range() { first.fill(1); }
        [[nodiscard]] bool holds(const coordinates& at) const noexcept {
            bool is_within = true;
            for (std::size_t k = 0; k < Axes; ++k) is_within &= first[k] <= at[k] && at[k] <= last[k];
            return is_within;
        }
        /// The regions of both ranges.
        [[nodiscard]] range common(const range& other) const noexcept {
            range both;
            for (std::size_t k = 0; k < Axes; ++k) {
                both.first[k] = std::max(first[k], other.first[k]);
                both.last[k] = std::min(last[k], other.last[k]);
            }
            return both;
        }
        [[nodiscard]] std::uint64_t regions() const noexcept {
            std::uint64_t product = 1;
            for (std::size_t k = 0; k < Axes; ++k) product *= std::uint64_t{last[k]} - first[k] + 1;
            return product;
        }
        friend bool operator==(const range&, const range&) = default;
    };

    static constexpr double most_regions = 256;  // per axis

    /// @param world the bounds of the present objects
    /// @param wanted number of regions along each cut axis, rounded down; an axis without width is not cut
    void plan(const box& world, const std::array<int, Axes>& cut, const std::array<double, Axes>& wanted) {
        cut_ = cut;
        for (std::size_t k = 0; k < Axes; ++k) {
            const double side = double{world.max[cut[k]]} - double{world.min[cut[k]]};
            const double count = std::min(wanted[k], most_regions);
            count_[k] = side > 0 && count > 1 ? static_cast<std::uint32_t>(count) : 1;
            origin_[k] = world.min[cut[k]];
            per_unit_[k] = count_[k] > 1 ? count_[k] / side : 0;
        }
    }

    [[nodiscard]] std::size_t regions() const noexcept {
        std::size_t product = 1;
        for (const std::uint32_t count : count_) product *= count;
        return product;
    }

    [[nodiscard]] range range_of(const box& b) const noexcept {
        range r;
        for (std::size_t k = 0; k < Axes; ++k) {
            r.first[k] = cell(b.min[cut_[k]], k);
            r.last[k] = cell(b.max[cut_[k]], k);
        }
        return r;
    }

    /// @param visit gets the number of each region of a range that is not in the range `except`
    void for_each(const range& within, const range& except, auto visit) const {
        for (std::size_t k = 0; k < Axes; ++k)
            if (within.first[k] > within.last[k]) return;
        coordinates at{};
        std::ranges::copy(within.first, at.begin());
        for (;;) {
            std::uint32_t number = 0;
            for (std::size_t k = 0; k < Axes; ++k) number = number * count_[k] + at[k];
            if (!except.holds(at)) visit(number);
            std::size_t k = Axes;
            while (k > 0 && at[k - 1] == within.last[k - 1]) --k, at[k] = within.first[k];
            if (k == 0) return;
            ++at[k - 1];
        }
    }

private:
    /// Monotone in x, rounding included, so that overlapping boxes share a region.
    [[nodiscard]] std::uint16_t cell(float x, std::size_t k) const noexcept {
        const double along = (double{x} - origin_[k]) * per_unit_[k];
        return static_cast<std::uint16_t>(std::clamp(along, 0.0, static_cast<double>(count_[k] - 1)));
    }

    std::array<int, Axes> cut_{};
    coordinates count_{};
    std::array<double, Axes> origin_{};
    std::array<double, Axes> per_unit_{};
};

/// The bounds of the present objects' boxes.
[[nodiscard]] inline box bounds_of_present(std::span<const box> boxes, const membership& objects) {
    box world = empty_box();
    for (std::uint32_t id = 0; id < boxes.size(); ++id)
        if (objects.contains(id)) world = merged(world, boxes[id]);
    return world;
}

}  // namespace aabb
