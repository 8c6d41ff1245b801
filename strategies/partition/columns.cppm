export module aabb.partition.columns;

import aabb.columns;
import aabb.costs;
import aabb.std;

#pragma clang fp contract(off) reassociate(off) reciprocal(off)  // see aabb.base:floating_point

export namespace aabb {

/// Cuts the scene into columns of equal width that run along one axis, and only then sorts, one short list per column.
/// When to use: almost always; it sorts nothing that is not swept. `sorted_grid` is the grid of BEPUphysics, which
/// keeps its columns' lists between frames instead.
///
/// The axis and the number of columns minimize the cost of a model of uniformly spread boxes, fitted to a sample.
class columns_partition {
public:
    static constexpr std::string_view name = "columns";
    static constexpr std::string_view summary = "distributes boxes over columns of space, and sorts within each";

    struct config {
        /// Number of the two perpendicular axes that are cut into columns.
        std::uint32_t axes = 2;
        /// Brute-force threshold: up to this many boxes are tested pairwise by vectors. auto: four vectors of boxes.
        std::optional<std::uint32_t> few{};
        /// Approximate number of boxes per group. auto: scenes of up to 40,000 boxes form a single group. Larger ones
        /// are put into groups of 9,000, whose entries fill half of the L2 cache, or into 300 groups, as many write
        /// streams as the processor sustains without stalls. Scenes of any size are put into nested groups if their
        /// boxes lie in clusters so far from each other that columns over the whole scene would not divide a cluster.
        std::optional<std::uint32_t> group{};
        /// Number of threads that search groups.
        std::uint32_t threads = 1;
    };
    static constexpr std::tuple parameters{
        integer_parameter{"axes", &config::axes, 0U, 2U,
                          "number of axes to cut, beside the one along which columns run"},
        integer_parameter{"few", &config::few, 0U, 4096U,
                          "brute-force threshold: up to this many boxes are tested pair by pair, without columns"},
        integer_parameter{"group", &config::group, 1U, 1'000'000'000U,
                          "approximate number of boxes per group; each group is cut into columns separately"},
        integer_parameter{"threads", &config::threads, 1U, 256U, "number of threads that search groups"}};

    static constexpr std::array contrasts{std::string_view("few=0")};

    template <class... All>
    static constexpr std::string_view rejects() {
        if (((SweepPolicy<All> && !ColumnSweep<All>) || ...))
            return "columns passes boxes in whole vectors, bucket by bucket; it can be combined with simd only";
        return {};
    }

    /// The broad phase that uses this partition.
    template <class Sort, class Sweep, class Counters>
    using search_with = column_search<Sort, columns_partition, Sweep, Counters>;

    columns_partition() = default;
    explicit columns_partition(const config& c) : config_(c) {}

    /// The cheapest plan: the axis of columns, and their numbers on the other two. Boxes are clipped to `within`.
    [[nodiscard]] column_plan plan(std::span<const box> boxes, const box& within) const {
        if (boxes.empty()) return {};
        const sample seen = sample_of(boxes, within);
        column_plan best;
        double least = std::numeric_limits<double>::infinity();
        for (int axis = 0; axis < 3; ++axis) {
            column_plan candidate;
            candidate.axis = axis;
            const int u = candidate.axis_across(0), v = candidate.axis_across(1);
            if (!seen.varies(axis) && (seen.varies(u) || seen.varies(v))) continue;  // sorting along it is useless
            const double most_u = most_columns_on(seen, u, config_.axes > 0);
            const double most_v = most_columns_on(seen, v, config_.axes > 1);
            for (const std::uint32_t nu : column_counts) {
                if (nu > most_u) break;
                for (const std::uint32_t nv : column_counts) {
                    if (nv > most_v || nu * nv > most_columns) break;
                    // Columns of less than one vector would be padding mostly.
                    if (nu * nv > 1 && std::size_t{nu} * nv * simd::width > boxes.size()) break;
                    candidate.across = {nu, nv};
                    const double cost = cost_of(seen, candidate, boxes.size());
                    if (cost >= least) continue;
                    least = cost;
                    best = candidate;
                }
            }
        }
        best.fit(seen.bounds);
        // Groups may also be cut along the columns, but only once per mean extent, not `columns_per_extent` times.
        best.most_along = static_cast<std::uint32_t>(
            std::min(most_columns_on(seen, best.axis, /*is_cut=*/true) / columns_per_extent, double{most_columns}));
        // A group of fewer boxes than a plan samples is not worth its own plan. Two by two groups are the fewest that
        // divide the scene on both axes.
        if (!config_.group && are_clustered(seen, best, boxes.size(), least))
            best.groups = std::clamp(static_cast<double>(boxes.size()) / samples, 4.0, double{most_groups});
        return best;
    }

    [[nodiscard]] std::size_t brute_force_threshold() const noexcept { return config_.few.value_or(4 * simd::width); }
    [[nodiscard]] std::size_t group_size(std::size_t boxes) const noexcept {
        if (config_.group) return std::min(boxes, std::size_t{*config_.group});
        return boxes <= 40'000 ? boxes : std::max(std::size_t{9'000}, boxes / std::size_t{most_groups});
    }
    [[nodiscard]] unsigned threads() const noexcept { return config_.threads; }

private:
    static constexpr std::size_t samples = 256;
    static constexpr std::size_t kept_samples = samples / 2;
    /// The shares of outliers that may be excluded on either side: none, 1/64 or 1/8.
    static constexpr std::array<std::size_t, 3> outlier_divisors{0, 64, 8};
    /// One in this many boxes is tested against the kept sample.
    static constexpr std::size_t boxes_per_tested = 32;
    static constexpr std::uint32_t most_columns = 16'384;
    static constexpr std::uint32_t most_groups = 300;
    static constexpr double columns_per_extent = 4;
    static constexpr std::array<std::uint32_t, 24> column_counts{1,  2,  3,  4,  5,  6,  7,  8,  10, 12, 14,  16,
                                                                 20, 24, 28, 32, 40, 48, 56, 64, 80, 96, 112, 128};

    /// A sample of boxes, and the means of their extents, face areas and volumes.
    struct sample {
        box bounds = empty_box();
        vec3d extent{};
        vec3d face_area{};  ///< on each axis, of the face perpendicular to it
        double volume = 0;
        vec3d per_width{};                                      ///< 1 / `width`, or 0 if the width is 0
        std::array<std::array<float, kept_samples>, 6> ends{};  ///< lower, then upper ends of every second box
        std::size_t kept = 0;                                   ///< number of kept boxes

        void keep(const box& b) {
            for (int k = 0; k < 3; ++k) {
                ends[static_cast<std::size_t>(k)][kept] = b.min[k];
                ends[static_cast<std::size_t>(3 + k)][kept] = b.max[k];
            }
            ++kept;
        }
        [[nodiscard]] box kept_box(std::size_t i) const {
            return {{ends[0][i], ends[1][i], ends[2][i]}, {ends[3][i], ends[4][i], ends[5][i]}};
        }
        /// Adds a box's extents, face areas and volume to the sums.
        void add_extents(const box& b) {
            vec3d e{};
            for (int k = 0; k < 3; ++k) e[k] = std::max(0.0, double{b.max[k]} - double{b.min[k]});
            for (int k = 0; k < 3; ++k) {
                extent[k] += e[k];
                face_area[k] += e[(k + 1) % 3] * e[(k + 2) % 3];
            }
            volume += e[0] * e[1] * e[2];
        }
        [[nodiscard]] double width(int k) const { return double{bounds.max[k]} - double{bounds.min[k]}; }
        [[nodiscard]] bool varies(int k) const {
            // A width of only a few floats does not count.
            return width(k) > 0x1p-21 * std::max(std::abs(double{bounds.min[k]}), std::abs(double{bounds.max[k]}));
        }
    };

    /// Measures a sample, one pseudorandom box per stride, so that it does not depend on periodic orders of the boxes.
    [[nodiscard]] static sample sample_of(std::span<const box> boxes, const box& within) {
        sample seen;
        std::array<std::array<float, samples + 1>, 6> ends;  // by axis: lower ends, then upper ends
        const std::size_t step = std::max<std::size_t>(1, (boxes.size() + samples - 1) / samples);
        std::size_t count = 0;
        std::uint64_t random = 1;
        for (std::size_t begin = 0; begin < boxes.size(); begin += step) {
            random = random * 6364136223846793005U + 1442695040888963407U;  // Knuth's generator for MMIX
            const std::size_t i = begin + (random >> 33U) % step;
            if (i >= boxes.size()) break;
            const box b = clipped(boxes[i], within);
            for (int k = 0; k < 3; ++k) {
                ends[static_cast<std::size_t>(k)][count] = b.min[k];
                ends[static_cast<std::size_t>(3 + k)][count] = b.max[k];
            }
            if (count % 2 == 0) seen.keep(b);  // half of them, for estimates from pairs of boxes
            seen.add_extents(b);
            ++count;
        }
        bool has_outliers = false;
        for (int k = 0; k < 3; ++k) {
            has_outliers |= set_bounds(seen.bounds, k, std::span(ends[static_cast<std::size_t>(k)]).first(count),
                                       std::span(ends[static_cast<std::size_t>(3 + k)]).first(count));
            seen.per_width[k] = seen.width(k) > 0 ? 1 / seen.width(k) : 0;
        }
        if (has_outliers) {
            // Parts of boxes outside the bounds belong to the columns at the border, however large they are.
            seen.extent = seen.face_area = {};
            seen.volume = 0;
            for (std::size_t i = 0; i < seen.kept; ++i) seen.add_extents(clipped(seen.kept_box(i), seen.bounds));
            count = seen.kept;
        }
        const auto n = static_cast<double>(count);
        for (int k = 0; k < 3; ++k) {
            seen.extent[k] /= n;
            seen.face_area[k] /= n;
        }
        seen.volume /= n;
        return seen;
    }

    /// Sets the bounds on axis k without outliers, which will belong to the columns at the border: the outermost 64th
    /// or 8th on either side, if the bounds are less than a quarter as long without it.
    /// @returns whether outliers were excluded
    static bool set_bounds(box& bounds, int k, std::span<float> lower, std::span<float> upper) {
        const std::array<float, outlier_divisors.size()> first = bounds_without_outliers(lower, std::ranges::less());
        const std::array<float, outlier_divisors.size()> last = bounds_without_outliers(upper, std::ranges::greater());
        const auto length = [&](std::size_t i) { return double{last[i]} - double{first[i]}; };
        std::size_t chosen = 0;
        for (std::size_t i = 1; i < outlier_divisors.size(); ++i)
            if (4 * length(i) < length(chosen)) chosen = i;
        bounds.min[k] = first[chosen];
        bounds.max[k] = std::max(first[chosen], last[chosen]);
        return chosen > 0;
    }

    /// The outermost values if no outliers, one value in 64, or one in 8 is excluded. The values are reordered.
    /// @param before orders values from the outermost one inward
    template <class Before>
    [[nodiscard]] static std::array<float, outlier_divisors.size()> bounds_without_outliers(std::span<float> values,
                                                                                            Before before) {
        std::array<float, outlier_divisors.size()> bounds{};
        const std::size_t count = values.size();
        // The most are excluded first: the fewer outermost ones are among them, which leaves less to partition.
        for (std::size_t i = outlier_divisors.size(); i-- > 0;) {
            const std::size_t excluded = outlier_divisors[i] == 0 ? 0 : count / outlier_divisors[i];
            const auto outermost = values.begin() + static_cast<std::ptrdiff_t>(excluded);
            std::ranges::nth_element(values, outermost, before);
            bounds[i] = *outermost;
            values = values.first(excluded + 1);
        }
        return bounds;
    }

    /// Clips a box. NaN, which would break `nth_element`, becomes a bound; invalid boxes are detected later.
    [[nodiscard]] static box clipped(const box& b, const box& within) {
        box c = b;
        for (int k = 0; k < 3; ++k) {
            c.min[k] = std::min(std::max(within.min[k], b.min[k]), within.max[k]);
            c.max[k] = std::min(std::max(within.min[k], b.max[k]), within.max[k]);
        }
        return c;
    }

    /// The greatest useful number of columns on an axis; narrower ones gain nothing.
    [[nodiscard]] static double most_columns_on(const sample& seen, int k, bool is_cut) {
        if (!is_cut || !seen.varies(k)) return 1;
        return seen.extent[k] > 0 ? std::max(1.0, columns_per_extent * seen.width(k) / seen.extent[k])
                                  : column_counts.back();
    }

    /// The cost per box in nanoseconds of a plan, for uniformly spread boxes like the sample: an entry in each column
    /// that it overlaps, and tests by vectors against the entries that it overlaps along the column.
    [[nodiscard]] static double cost_of(const sample& seen, const column_plan& p, std::size_t boxes) {
        const cost_model& ns = machine_costs();
        const int u = p.axis_across(0), v = p.axis_across(1);
        const auto cuts_per_length = [&](int k, std::uint32_t n) { return n > 1 ? n * seen.per_width[k] : 0.0; };
        const double cuts_u = cuts_per_length(u, p.across[0]);
        const double cuts_v = cuts_per_length(v, p.across[1]);
        // A box of extents eu and ev across the columns is expected to overlap (1 + eu cuts_u) (1 + ev cuts_v) of them.
        // Here are the means over the sample of this number, and of its product with the extent along the columns.
        const double entries =
            1 + seen.extent[u] * cuts_u + seen.extent[v] * cuts_v + seen.face_area[p.axis] * cuts_u * cuts_v;
        const double length = seen.extent[p.axis] + seen.face_area[v] * cuts_u + seen.face_area[u] * cuts_v +
                              seen.volume * cuts_u * cuts_v;
        const auto columns = static_cast<double>(p.columns());
        const auto n = static_cast<double>(boxes);
        // Each pair is tested once, so the tests per entry are the number of entries that cover a point of the column.
        // If the bounds have no width along the columns, all entries of a column overlap.
        const double per_width = seen.per_width[p.axis];
        const double tests = n * (per_width > 0 ? length * per_width : entries) / columns;
        return entries * (ns.column_entry + ns.column_test * (1 + tests / simd::width)) + ns.column * columns / n;
    }

    /// A vector of sampled boxes in the representation of the sweep.
    struct sampled_entries {
        simd::floats ends[6];
        simd::words lower, upper;  ///< as in `column_entry`
        simd::words first, last;   ///< column numbers, packed like the coordinates in `lower`
        simd::words begin, end;    ///< bucket numbers

        /// Quantizes a vector of sampled boxes from index `first_box` on, and finds the columns that each overlaps and
        /// its range of buckets, which divide a column along its axis.
        void fill(const sample& seen, std::size_t first_box, const column_plan& plan, std::uint32_t bucket_bits) {
            for (std::size_t k = 0; k < 6; ++k) std::memcpy(&ends[k], &seen.ends[k][first_box], sizeof ends[k]);
            const int u = plan.axis_across(0), v = plan.axis_across(1);
            const simd::words across = simd::broadcast(plan.across[0] | plan.across[1] << 16);
            lower = plan.quantized(ends[u], u) | plan.quantized(ends[v], v) << 16;
            upper = plan.quantized(ends[3 + u], u) | plan.quantized(ends[3 + v], v) << 16;
            // A column's number is the coordinate, a fraction of 2^16, times the number of columns across.
            first = simd::high_products(lower, across);
            last = simd::high_products(upper, across);
            begin = plan.quantized(ends[plan.axis], plan.axis) >> (16 - bucket_bits);
            end = plan.quantized(ends[3 + plan.axis], plan.axis) >> (16 - bucket_bits);
        }

        /// Bit l is set if box l shares a column, and a range of buckets in it, with the other box.
        [[nodiscard]] std::uint32_t overlap_mask(const sampled_entries& others, std::size_t other) const {
            return simd::bits(((simd::saturated_difference(first, simd::broadcast(others.last[other])) |
                                simd::saturated_difference(simd::broadcast(others.first[other]), last)) == 0U) &
                              (begin <= others.end[other]) & (end >= others.begin[other]));
        }
        /// Bit l is set if box l and the other box are disjoint, but the quantized test does not reject the pair.
        [[nodiscard]] std::uint32_t rejected_by_exact_test(const sampled_entries& others, std::size_t other) const {
            simd::flags disjoint{};
            for (int k = 0; k < 3; ++k)
                disjoint |= (ends[k] > others.ends[3 + k][other]) | (ends[3 + k] < others.ends[k][other]);
            return simd::bits(((simd::saturated_difference(lower, simd::broadcast(others.upper[other])) |
                                simd::saturated_difference(simd::broadcast(others.lower[other]), upper)) == 0U) &
                              disjoint);
        }
    };

    /// Pairs of sampled boxes that share a column and a range of buckets, and those that only the exact test rejects.
    struct pair_counts {
        int met = 0;
        int rejected = 0;
    };

    /// Tests some of the kept boxes, at a regular stride, against all others; each pair counts from both sides.
    /// @param tested the number of these boxes: few, so that the estimate takes a small share of the search
    [[nodiscard]] static pair_counts count_pairs(const sample& seen, const column_plan& plan, std::uint32_t bucket_bits,
                                                 std::size_t tested) {
        std::array<sampled_entries, kept_samples / simd::width> entries;
        for (std::size_t i = 0; i < seen.kept; i += simd::width)
            entries[i / simd::width].fill(seen, i, plan, bucket_bits);
        pair_counts counts;
        for (std::size_t k = 0; k < tested; ++k) {
            const std::size_t i = k * seen.kept / tested;
            const sampled_entries& others = entries[i / simd::width];
            const std::size_t other = i % simd::width;
            for (std::size_t first = 0; first < seen.kept; first += simd::width) {
                std::uint32_t lanes = simd::lanes_below(seen.kept - first);
                if (first == i - other) lanes &= ~(std::uint32_t{1} << other);  // not against itself
                lanes &= entries[first / simd::width].overlap_mask(others, other);
                if (lanes == 0) continue;
                counts.met += std::popcount(lanes);
                counts.rejected +=
                    std::popcount(lanes & entries[first / simd::width].rejected_by_exact_test(others, other));
            }
        }
        return counts;
    }

    /// Whether the boxes are clustered, so that groups get plans of their own: their tests, extrapolated from the
    /// sample, cost more than the plan for uniformly spread boxes plus the grouping. Switching only then is
    /// 2-competitive: it takes at most about twice the time of the better choice.
    /// @param planned the cost per box of the plan
    [[nodiscard]] static bool are_clustered(const sample& seen, const column_plan& plan, std::size_t boxes,
                                            double planned) {
        const cost_model& ns = machine_costs();
        // Costs are in nanoseconds per box. A vector tests `width` pairs that share a column and buckets at once; each
        // pair that only the exact test rejects costs another test.
        const double most = planned + ns.column_entry;
        const auto cost = [&](double met, double rejected) { return ns.column_test * (met / simd::width + rejected); };
        const auto n = static_cast<double>(boxes);
        if (cost(n / 2, n / 2) <= most) return false;  // not even if every box met every other
        const std::size_t tested = std::min(seen.kept, std::max<std::size_t>(boxes / boxes_per_tested, 1));
        const auto [met, rejected] = count_pairs(seen, plan, plan.bucket_bits(boxes), tested);
        // Each pair is counted from both sides. The deviation of a Poisson-like count is its square root, so that a
        // count less three deviations hardly overestimates.
        const double pairs = 2 * static_cast<double>(tested) * (static_cast<double>(seen.kept) - 1);
        const auto at_least = [&](int count) {
            return std::max(0.0, count - 3 * std::sqrt(double(count))) * n / pairs;
        };
        return cost(at_least(met), at_least(rejected)) > most;
    }

    config config_;
};

static_assert(ColumnPartition<columns_partition> && SearchingPartition<columns_partition>);

}  // namespace aabb
