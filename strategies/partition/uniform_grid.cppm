module;
#include <cassert>

export module aabb.partition.uniform_grid;

import aabb.global_search;
import aabb.std;

#pragma clang fp contract(off) reassociate(off) reciprocal(off)  // see aabb.base:floating_point

export namespace aabb {

/// A uniform grid of cubic cells over the bounds of the frame; each cell that a box overlaps gets a copy of it. The
/// paper's counterexample ("no best size for all situations", section 2): the number of cells, and with it memory and
/// time, grows with the space instead of the objects. When to use: objects of similar size, uniformly spread.
///
/// `std` + `uniform_grid` + `one_axis`, with two or three `axes`, is the grid with sweep and prune in its cells of
/// Broadmark (Serpa and Rodrigues 2019, Algorithms/Grid), but that cells there hold 200 objects on average and are
/// sorted one by one, each along the axis on which its boxes vary most.
class uniform_grid_partition {
public:
    static constexpr std::string_view name = "uniform_grid";
    static constexpr std::string_view summary = "cubic cells of one size over the whole world";

    struct config {
        /// Edge of a cell in world units. auto: twice the mean longest extent, more if cells exceed four per object.
        std::optional<double> cell_size;
        /// Number of axes that are cut. 2: those beside the first swept one, so that cells are columns.
        std::uint32_t axes = 3;
    };
    static constexpr std::tuple parameters{
        number_parameter{"cell_size", &config::cell_size, 0.0, std::numeric_limits<double>::max(),
                         "edge of a cell, in world units; auto: twice the mean longest extent, or more"},
        integer_parameter{"axes", &config::axes, 2U, 3U, "number of axes to cut; 2: those beside the swept one"}};

    uniform_grid_partition() = default;
    explicit uniform_grid_partition(const config& c) : config_(c) {}

    /// Needs no sorted lists: cells follow from the boxes alone.
    axis_set axes(std::span<const box>, const membership&, axis_set swept) noexcept {
        cut_ = every_axis;
        if (config_.axes < 3) cut_ &= ~(axis_set{1} << std::countr_zero(swept));
        return 0;
    }

    /// Sets the cells: of the configured size, or twice the mean longest extent, grown to at most four per object.
    /// @throws input_error if there would be more than 2^26 cells.
    void fit(const whole_subset& scene) {
        // Every list that is kept has all present objects; the others are empty.
        const std::span<const projection> present =
            *std::ranges::max_element(scene.lists, {}, [](const auto& list) { return list.size(); });
        box world = empty_box();
        double extents = 0;
        for (const projection& p : present) {
            const box& b = scene.boxes[p.id];
            world = merged(world, b);
            const int longest = longest_axis(b);
            extents += double{b.max[longest]} - double{b.min[longest]};
        }
        cells_ = {1, 1, 1};
        if (present.empty()) return;
        origin_ = world.min;
        const auto objects = static_cast<double>(present.size());
        if (config_.cell_size) {
            if (set_cells(world, *config_.cell_size) > most_cells)
                throw input_error("uniform_grid: a cell_size of " + std::get<0>(parameters).show(config_) +
                                  " cuts this world into more than 2^26 cells");
            return;
        }
        const int longest = longest_axis(world);
        const double span = double{world.max[longest]} - double{world.min[longest]};
        constexpr double most_per_axis = 0x1p20;  // bounds the number of enlargements if boxes are points
        double size = std::max(2 * extents / objects, span / most_per_axis);
        if (size == 0) return;  // all objects lie at one point
        while (set_cells(world, size) > std::min(4 * objects, most_cells)) size *= 1.25;
        assert(static_cast<double>(subset_count()) <= most_cells);
    }

    [[nodiscard]] std::uint32_t subset_count() const noexcept { return cells_[0] * cells_[1] * cells_[2]; }

    [[nodiscard]] std::uint64_t copies(std::uint32_t, const box& b) const noexcept {
        std::uint64_t count = 1;
        for (int k = 0; k < 3; ++k) count *= cell(b.max[k], k) - cell(b.min[k], k) + 1;
        return count;
    }

    /// Visits the cells that a box overlaps. Passes the number of the cell, and the axes on which the box begins in it.
    template <class Visit>
    void for_each_subset(std::uint32_t, const box& b, Visit visit) const {
        std::array<std::uint32_t, 3> first{}, last{};
        for (int k = 0; k < 3; ++k) {
            first[static_cast<std::size_t>(k)] = cell(b.min[k], k);
            last[static_cast<std::size_t>(k)] = cell(b.max[k], k);
        }
        for (std::uint32_t z = first[2]; z <= last[2]; ++z)
            for (std::uint32_t y = first[1]; y <= last[1]; ++y)
                for (std::uint32_t x = first[0]; x <= last[0]; ++x)
                    visit((z * cells_[1] + y) * cells_[0] + x,
                          axis_set{x == first[0]} | axis_set{y == first[1]} << 1 | axis_set{z == first[2]} << 2);
    }

private:
    static constexpr double most_cells = 1U << 26;

    /// Sets up the grid and returns its number of cells; the grid is usable only if these are at most `most_cells`.
    double set_cells(const box& world, double size) {
        double count = 1;
        const double per_unit = std::min(1 / size, std::numeric_limits<double>::max());  // infinity times 0 is NaN
        for (std::size_t k = 0; k < 3; ++k) {
            const auto axis = static_cast<int>(k);
            per_unit_[k] = has_axis(cut_, k) ? per_unit : 0;
            const double along = std::floor((double{world.max[axis]} - double{world.min[axis]}) * per_unit_[k]) + 1;
            count *= along;
            cells_[k] = static_cast<std::uint32_t>(std::min(along, most_cells));
        }
        return count;
    }

    /// Monotone in x, rounding included, so the cell of the greater lower end of two boxes lies in the range of both.
    [[nodiscard]] std::uint32_t cell(float x, int k) const noexcept {
        const double along = (double{x} - double{origin_[k]}) * per_unit_[static_cast<std::size_t>(k)];
        return std::min(static_cast<std::uint32_t>(along), cells_[static_cast<std::size_t>(k)] - 1);
    }

    config config_;
    vec3f origin_{};
    axis_set cut_ = every_axis;
    std::array<double, 3> per_unit_{};
    std::array<std::uint32_t, 3> cells_ = {1, 1, 1};
};

static_assert(CuttingPartition<uniform_grid_partition>);

}  // namespace aabb
