export module aabb.partition.columns;

import aabb.columns;
import aabb.costs;
import aabb.std;

// Sums and products as they are written: see aabb.base:floating_point.
#pragma clang fp contract(off) reassociate(off) reciprocal(off)

export namespace aabb {

/// Cuts first and sorts afterwards: columns of equal width along one axis, each with its own short list. When to use:
/// almost always; it sorts nothing that is not swept.
///
/// The axis along which columns run, and how many there are, are what a model of evenly spread boxes finds cheapest for
/// a sample of them.
class columns_partition {
public:
    static constexpr std::string_view name = "columns";
    static constexpr std::string_view summary = "cuts boxes into columns before anything is sorted";

    struct config {
        /// How many of the two axes across are cut into columns.
        std::uint32_t axes = 2;
        /// Up to so many boxes are tested each against each, a vector at a time. auto: as many as four vectors hold.
        std::optional<std::uint32_t> few{};
        /// Boxes that are put side by side first, about. auto: all, up to 40,000; more are put into groups of 9,000,
        /// which fill half a second-level cache with their entries, or into 300 groups, which is as many places as can
        /// be written in turn without much waiting. Any number of boxes is put into groups, and those into further
        /// ones, where they lie in clumps so far apart that columns over all of them leave each clump in one place.
        std::optional<std::uint32_t> group{};
        /// How many threads take groups.
        std::uint32_t threads = 1;
    };
    static constexpr std::tuple parameters{
        integer_parameter{"axes", &config::axes, 0U, 2U,
                          "how many axes are cut, beside the one that columns run along"},
        integer_parameter{"few", &config::few, 0U, 4096U, "boxes that are not cut, but tested each against each"},
        integer_parameter{"group", &config::group, 1U, 1'000'000'000U, "boxes that are cut into columns together"},
        integer_parameter{"threads", &config::threads, 1U, 256U, "how many threads take groups"}};

    static constexpr std::array contrasts{std::string_view("few=0")};

    template <class... All>
    static constexpr std::string_view refuses() {
        if (((SweepPolicy<All> && !ColumnSweep<All>) || ...))
            return "columns hands over boxes in whole vectors, bucket by bucket; it goes with simd only";
        return {};
    }

    /// A global search with this partition.
    template <class Sort, class Sweep, class Counters>
    using search_with = column_search<Sort, columns_partition, Sweep, Counters>;

    columns_partition() = default;
    explicit columns_partition(const config& c) : config_(c) {}

    /// For these boxes, of which only what lies within the bounds counts.
    [[nodiscard]] column_plan plan(std::span<const box> boxes, const box& within) const {
        if (boxes.empty()) return {};
        const sample seen = sample_of(boxes, within);
        column_plan best;
        double least = std::numeric_limits<double>::infinity();
        for (int axis = 0; axis < 3; ++axis) {
            column_plan one;
            one.axis = axis;
            const int u = one.axis_across(0);
            const int v = one.axis_across(1);
            if (!seen.varies(axis) && (seen.varies(u) || seen.varies(v))) continue;
            const double most_u = most(seen, u, config_.axes > 0);
            const double most_v = most(seen, v, config_.axes > 1);
            for (const std::uint32_t nu : numbers) {
                if (nu > most_u) break;
                for (const std::uint32_t nv : numbers) {
                    if (nv > most_v || nu * nv > most_columns) break;
                    if (nu * nv > 1 && std::size_t{nu} * nv * simd::width > boxes.size()) break;
                    one.across = {nu, nv};
                    const double cost = cost_of(seen, one, boxes.size());
                    if (cost >= least) continue;
                    least = cost;
                    best = one;
                }
            }
        }
        best.fit(seen.bounds);
        best.most_along =
            static_cast<std::uint32_t>(std::min(most(seen, best.axis, true) / columns_a_box, double{most_columns}));
        // A group of fewer boxes than a plan looks at is not worth one of its own.
        if (!config_.group && are_clumped(seen, best, boxes.size(), least))
            best.groups = std::clamp(static_cast<double>(boxes.size()) / samples, 4.0, double{most_groups});
        return best;
    }

    /// Of so many boxes, or fewer, none is cut.
    [[nodiscard]] std::size_t few() const noexcept { return config_.few.value_or(4 * simd::width); }
    /// How many of so many boxes are cut into columns together, about.
    [[nodiscard]] std::size_t group(std::size_t boxes) const noexcept {
        if (config_.group) return std::min(boxes, std::size_t{*config_.group});
        return boxes <= 40'000 ? boxes : std::max(std::size_t{9'000}, boxes / std::size_t{most_groups});
    }
    [[nodiscard]] unsigned threads() const noexcept { return config_.threads; }

private:
    static constexpr std::size_t samples = 256;
    static constexpr std::size_t kept_samples = samples / 2;
    /// One of so many is left out on either side; none of 0.
    static constexpr std::array<std::size_t, 3> shares{0, 64, 8};
    /// Of so many, one is asked which others it meets.
    static constexpr std::size_t boxes_an_asked = 32;
    static constexpr std::uint32_t most_columns = 16'384;
    static constexpr std::uint32_t most_groups = 300;
    static constexpr double columns_a_box = 4;
    static constexpr std::array<std::uint32_t, 24> numbers{1,  2,  3,  4,  5,  6,  7,  8,  10, 12, 14,  16,
                                                           20, 24, 28, 32, 40, 48, 56, 64, 80, 96, 112, 128};

    /// Some boxes, and the means of their extents, of products of two, and of all three.
    struct sample {
        box bounds = empty_box();
        vec3d extent{};
        vec3d product{};  ///< of the other two
        double volume = 0;
        vec3d per_width{};                                      ///< 1 / `width`; 0 without one
        std::array<std::array<float, kept_samples>, 6> ends{};  ///< of every second box: lower ones, then upper ones
        std::size_t kept = 0;                                   ///< how many those are

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
        void add_extents(const box& b) {
            vec3d e{};
            for (int k = 0; k < 3; ++k) e[k] = std::max(0.0, double{b.max[k]} - double{b.min[k]});
            for (int k = 0; k < 3; ++k) {
                extent[k] += e[k];
                product[k] += e[(k + 1) % 3] * e[(k + 2) % 3];
            }
            volume += e[0] * e[1] * e[2];
        }
        [[nodiscard]] double width(int k) const { return double{bounds.max[k]} - double{bounds.min[k]}; }
        [[nodiscard]] bool varies(int k) const {
            // By more than a few of the numbers that a float can hold there.
            return width(k) > 0x1p-21 * std::max(std::abs(double{bounds.min[k]}), std::abs(double{bounds.max[k]}));
        }
    };

    /// Every so many-th box, each time another one, so that no order of the boxes is met.
    [[nodiscard]] static sample sample_of(std::span<const box> boxes, const box& within) {
        sample seen;
        std::array<std::array<float, samples + 1>, 6> ends;
        const std::size_t step = std::max<std::size_t>(1, (boxes.size() + samples - 1) / samples);
        std::size_t count = 0;
        std::uint64_t random = 1;
        for (std::size_t begin = 0; begin < boxes.size(); begin += step) {
            random = random * 6364136223846793005U + 1442695040888963407U;
            const std::size_t i = begin + (random >> 33U) % step;
            if (i >= boxes.size()) break;
            const box b = common(boxes[i], within);
            for (int k = 0; k < 3; ++k) {
                ends[static_cast<std::size_t>(k)][count] = b.min[k];
                ends[static_cast<std::size_t>(3 + k)][count] = b.max[k];
            }
            if (count % 2 == 0) seen.keep(b);
            seen.add_extents(b);
            ++count;
        }
        bool has_outliers = false;
        for (int k = 0; k < 3; ++k) {
            has_outliers |= bound(seen.bounds, k, std::span(ends[static_cast<std::size_t>(k)]).first(count),
                                  std::span(ends[static_cast<std::size_t>(3 + k)]).first(count));
            seen.per_width[k] = seen.width(k) > 0 ? 1 / seen.width(k) : 0;
        }
        if (has_outliers) {
            // What lies outside, however large, is within a column at the border.
            seen.extent = seen.product = {};
            seen.volume = 0;
            for (std::size_t i = 0; i < seen.kept; ++i) seen.add_extents(common(seen.kept_box(i), seen.bounds));
            count = seen.kept;
        }
        const auto n = static_cast<double>(count);
        for (int k = 0; k < 3; ++k) {
            seen.extent[k] /= n;
            seen.product[k] /= n;
        }
        seen.volume /= n;
        return seen;
    }

    /// From the first lower end to the last upper one, without a few that lie far from all others: what lies outside is
    /// in the columns at the border. Of 64 the outermost on either side are left out, or of 8, where that makes the
    /// rest four times as short.
    /// @returns whether any are
    static bool bound(box& bounds, int k, std::span<float> lower, std::span<float> upper) {
        const std::array<float, shares.size()> first = outermost(lower, std::ranges::less());
        const std::array<float, shares.size()> last = outermost(upper, std::ranges::greater());
        const auto length = [&](std::size_t i) { return double{last[i]} - double{first[i]}; };
        std::size_t chosen = 0;
        for (std::size_t i = 1; i < shares.size(); ++i)
            if (4 * length(i) < length(chosen)) chosen = i;
        bounds.min[k] = first[chosen];
        bounds.max[k] = std::max(first[chosen], last[chosen]);
        return chosen > 0;
    }

    /// What is outermost without each of the shares.
    template <class Before>
    [[nodiscard]] static std::array<float, shares.size()> outermost(std::span<float> values, Before before) {
        std::array<float, shares.size()> found{};
        const std::size_t all = values.size();
        for (std::size_t i = shares.size(); i-- > 0;) {
            const std::size_t out = shares[i] == 0 ? 0 : all / shares[i];
            const auto place = values.begin() + static_cast<std::ptrdiff_t>(out);
            std::ranges::nth_element(values, place, before);
            found[i] = *place;
            values = values.first(out + 1);
        }
        return found;
    }

    /// Without NaN, which selects wrongly: that boxes are invalid is seen once they are put into columns.
    [[nodiscard]] static box common(const box& b, const box& within) {
        box c = b;
        for (int k = 0; k < 3; ++k) {
            c.min[k] = std::min(std::max(within.min[k], b.min[k]), within.max[k]);
            c.max[k] = std::min(std::max(within.min[k], b.max[k]), within.max[k]);
        }
        return c;
    }

    /// How many columns there may be; narrower ones gain nothing.
    [[nodiscard]] static double most(const sample& seen, int k, bool cut) {
        if (!cut || !seen.varies(k)) return 1;
        return seen.extent[k] > 0 ? std::max(1.0, columns_a_box * seen.width(k) / seen.extent[k]) : numbers.back();
    }

    /// For a box, in nanoseconds: to bring its entries to their places, and to test each, a vector at a time, against
    /// those that it meets along the column.
    [[nodiscard]] static double cost_of(const sample& seen, const column_plan& p, std::size_t boxes) {
        const cost_model& ns = machine_costs();
        const int u = p.axis_across(0);
        const int v = p.axis_across(1);
        const auto per = [&](int k, std::uint32_t n) { return n > 1 ? n * seen.per_width[k] : 0.0; };
        const double iu = per(u, p.across[0]);
        const double iv = per(v, p.across[1]);
        const double entries = 1 + seen.extent[u] * iu + seen.extent[v] * iv + seen.product[p.axis] * iu * iv;
        const double reach = seen.extent[p.axis] + seen.product[v] * iu + seen.product[u] * iv + seen.volume * iu * iv;
        const auto columns = static_cast<double>(p.columns());
        const auto n = static_cast<double>(boxes);
        const double per_length = seen.per_width[p.axis];
        const double met = n * (per_length > 0 ? reach * per_length : entries) / columns;
        return entries * (ns.column_entry + ns.column_test * (1 + met / simd::width)) + ns.column * columns / n;
    }

    /// Boxes of a sample as a sweep has them, a vector of them.
    struct sampled_entries {
        simd::floats ends[6];
        simd::words lower, upper;  ///< as in `column_entry`
        simd::words first, last;   ///< columns, as whole numbers stand in `lower`
        simd::words begin, end;    ///< buckets

        void fill(const sample& seen, std::size_t at, const column_plan& plan, std::uint32_t bucket_bits) {
            for (std::size_t k = 0; k < 6; ++k) std::memcpy(&ends[k], &seen.ends[k][at], sizeof ends[k]);
            const int u = plan.axis_across(0);
            const int v = plan.axis_across(1);
            const simd::words across = simd::all(plan.across[0] | plan.across[1] << 16);
            lower = plan.whole(ends[u], u) | plan.whole(ends[v], v) << 16;
            upper = plan.whole(ends[3 + u], u) | plan.whole(ends[3 + v], v) << 16;
            first = simd::upper_products(lower, across);
            last = simd::upper_products(upper, across);
            begin = plan.whole(ends[plan.axis], plan.axis) >> (16 - bucket_bits);
            end = plan.whole(ends[3 + plan.axis], plan.axis) >> (16 - bucket_bits);
        }

        /// Bit l is set where box l has a column, and a bucket in it, in common with another one.
        [[nodiscard]] std::uint32_t met_by(const sampled_entries& others, std::size_t other) const {
            return simd::bits(((simd::excess(first, simd::all(others.last[other])) |
                                simd::excess(simd::all(others.first[other]), last)) == 0U) &
                              (begin <= others.end[other]) & (end >= others.begin[other]));
        }
        /// Bit l is set where whole numbers across the columns do not tell, but box l does not overlap the other one.
        [[nodiscard]] std::uint32_t rejected_late(const sampled_entries& others, std::size_t other) const {
            simd::flags apart{};
            for (int k = 0; k < 3; ++k)
                apart |= (ends[k] > others.ends[3 + k][other]) | (ends[3 + k] < others.ends[k][other]);
            return simd::bits(((simd::excess(lower, simd::all(others.upper[other])) |
                                simd::excess(simd::all(others.lower[other]), upper)) == 0U) &
                              apart);
        }
    };

    /// Whether tests, of which pairs of a sample tell how many there are, cost more than all that is planned for evenly
    /// spread boxes and than what groups would cost beside it. Who waits for that takes at most about twice as long as
    /// who knows, whether groups serve or not.
    [[nodiscard]] static bool are_clumped(const sample& seen, const column_plan& plan, std::size_t boxes,
                                          double planned) {
        const cost_model& ns = machine_costs();
        // In nanoseconds for a box.
        const double most = planned + ns.column_entry;
        const auto cost = [&](double met, double rejected) { return ns.column_test * (met / simd::width + rejected); };
        const auto n = static_cast<double>(boxes);
        if (cost(n / 2, n / 2) <= most) return false;
        std::array<sampled_entries, kept_samples / simd::width> entries;
        for (std::size_t i = 0; i < seen.kept; i += simd::width)
            entries[i / simd::width].fill(seen, i, plan, plan.bucket_bits(boxes));
        // Some of them are asked, across the sample, so that looking at few boxes takes a small part of their search.
        const std::size_t asked = std::min(seen.kept, std::max<std::size_t>(boxes / boxes_an_asked, 1));
        int met = 0;
        int rejected = 0;
        for (std::size_t k = 0; k < asked; ++k) {
            const std::size_t i = k * seen.kept / asked;
            const sampled_entries& others = entries[i / simd::width];
            const std::size_t other = i % simd::width;
            for (std::size_t first = 0; first < seen.kept; first += simd::width) {
                std::uint32_t some = simd::lanes_below(seen.kept - first);
                if (first == i - other) some &= ~(std::uint32_t{1} << other);
                some &= entries[first / simd::width].met_by(others, other);
                if (some == 0) continue;
                met += std::popcount(some);
                rejected += std::popcount(some & entries[first / simd::width].rejected_late(others, other));
            }
        }
        // Each is met from either side. Chance makes counts differ by their square root; three times that is beyond it.
        const double pairs = 2 * static_cast<double>(asked) * (static_cast<double>(seen.kept) - 1);
        const auto at_least = [&](int count) {
            return std::max(0.0, count - 3 * std::sqrt(double(count))) * n / pairs;
        };
        return cost(at_least(met), at_least(rejected)) > most;
    }

    config config_;
};

static_assert(ColumnPartition<columns_partition> && SearchingPartition<columns_partition>);

}  // namespace aabb
