module aabb.build.sah;

#pragma clang fp contract(off) reassociate(off) reciprocal(off)  // see aabb.base:floating_point

namespace aabb {

namespace {

constexpr std::size_t sah_bins = 16;

/// The triangles whose centroids lie in one slice of the node.
struct sah_bin {
    box bounds = empty_box();
    std::size_t count = 0;
};

/// Maps centroids to bins; the map is monotone along the axis.
class sah_binning {
public:
    sah_binning(double low, double high) noexcept : low_(low), scale_(double{sah_bins} / (high - low)) {}

    [[nodiscard]] std::size_t operator()(float centroid) const noexcept {
        return std::min(sah_bins - 1, static_cast<std::size_t>((double{centroid} - low_) * scale_));
    }

private:
    double low_;
    double scale_;
};

/// Tries the splits between adjacent bins of centroids along the axis. If one costs less than `least_cost`, updates
/// this and `best`. The cost is the sum over both sides of area times number of triangles (surface-area heuristic).
/// @param centroids the box of the centroids
void try_sah_axis(std::span<const build_element> range, int axis, const box& centroids, double& least_cost,
                  split_choice& best) noexcept {
    const sah_binning bin_of(centroids.min[axis], centroids.max[axis]);
    std::array<sah_bin, sah_bins> bins{};
    for (const build_element& e : range) {
        sah_bin& bin = bins[bin_of(e.centroid[axis])];
        bin.bounds = merged(bin.bounds, e.bounds);
        ++bin.count;
    }
    std::array<double, sah_bins> cost_from{};  // element i: the cost of a right side that consists of bins i and above
    sah_bin side;
    for (std::size_t i = sah_bins; i-- > 1;) {
        side.bounds = merged(side.bounds, bins[i].bounds);
        side.count += bins[i].count;
        cost_from[i] = side.count == 0 ? 0 : surface_area(side.bounds) * static_cast<double>(side.count);
    }
    side = {};  // the left side, bins 0 to i
    for (std::size_t i = 0; i + 1 < sah_bins; ++i) {
        side.bounds = merged(side.bounds, bins[i].bounds);
        side.count += bins[i].count;
        if (side.count == 0 || side.count == range.size()) continue;
        const double cost = surface_area(side.bounds) * static_cast<double>(side.count) + cost_from[i + 1];
        if (cost < least_cost) {
            least_cost = cost;
            best = {axis, side.count};
        }
    }
}

}  // namespace

/// Finds the cheapest split by the binned surface-area heuristic (Wald 2007): tries the planes between bins on each
/// axis along which centroids differ; the median split is the fallback.
split_choice sah_split(std::span<const build_element> range, const box& bounds) {
    box centroids = empty_box();
    for (const build_element& e : range) centroids = merged(centroids, bounds_of(e.centroid));
    split_choice best = median_split(range, bounds);
    double least_cost = std::numeric_limits<double>::infinity();
    for (int axis = 0; axis < 3; ++axis)
        if (centroids.min[axis] < centroids.max[axis]) try_sah_axis(range, axis, centroids, least_cost, best);
    return best;
}

}  // namespace aabb
