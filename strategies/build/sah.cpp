module aabb.build.sah;

// Sums and products as they are written: see aabb.base:floating_point.
#pragma clang fp contract(off) reassociate(off) reciprocal(off)

namespace aabb {

namespace {

constexpr std::size_t sah_bins = 16;

/// Triangles whose centroids lie in one slice of the node.
struct sah_bin {
    box bounds = empty_box();
    std::size_t count = 0;
};

/// Maps centroids to bins, a monotone function along the axis.
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

/// Takes the best split along the axis if it is better than the best so far.
void try_sah_axis(std::span<const build_element> range, int axis, const box& centroids, double& least,
                  split_choice& best) noexcept {
    const sah_binning bin_of(centroids.min[axis], centroids.max[axis]);
    std::array<sah_bin, sah_bins> bins{};
    for (const build_element& e : range) {
        sah_bin& bin = bins[bin_of(e.centroid[axis])];
        bin.bounds = merged(bin.bounds, e.bounds);
        ++bin.count;
    }
    // Cost of all from a bin on.
    std::array<double, sah_bins> right{};
    sah_bin all;
    for (std::size_t i = sah_bins; i-- > 1;) {
        all.bounds = merged(all.bounds, bins[i].bounds);
        all.count += bins[i].count;
        right[i] = all.count == 0 ? 0 : surface_area(all.bounds) * static_cast<double>(all.count);
    }
    all = {};
    for (std::size_t i = 0; i + 1 < sah_bins; ++i) {
        all.bounds = merged(all.bounds, bins[i].bounds);
        all.count += bins[i].count;
        if (all.count == 0 || all.count == range.size()) continue;
        const double cost = surface_area(all.bounds) * static_cast<double>(all.count) + right[i + 1];
        if (cost < least) {
            least = cost;
            best = {axis, all.count};
        }
    }
}

}  // namespace

split_choice sah_split(std::span<const build_element> range, const box& bounds) {
    box centroids = empty_box();
    for (const build_element& e : range) centroids = merged(centroids, bounds_of(e.centroid));
    split_choice best = median_split(range, bounds);
    double least = std::numeric_limits<double>::infinity();
    for (int axis = 0; axis < 3; ++axis)
        if (centroids.min[axis] < centroids.max[axis]) try_sah_axis(range, axis, centroids, least, best);
    return best;
}

}  // namespace aabb
