module;
#include <cassert>

export module aabb.partition.axial_cut;

import aabb.costs;
import aabb.global_search;
import aabb.std;

#pragma clang fp contract(off) reassociate(off) reciprocal(off)  // see aabb.base:floating_point

export namespace aabb {

/// The paper's axial cut (section 2): axes are cut into segments that contain the same number of projection intervals,
/// and overlap tests stay within a subset. When to use: almost always instead of a grid; cuts adapt to the objects, so
/// neither the size of the scene nor clusters matter.
///
/// A cut is the lower end of a box, and a box overlaps a segment if its lower end < the next cut and its upper end >=
/// the segment's cut. With the limit, no box is cut more than once per axis, so it has at most two copies per cut axis:
/// each cut lies beyond all upper ends of the boxes that begin before the previous cut. A desired cut that violates
/// this moves to the first lower end that satisfies it, and desired cuts before that end are dropped. This takes
/// comparisons only, and a wide box only loses the cuts within it.
class axial_cut_partition {
public:
    static constexpr std::string_view name = "axial_cut";
    static constexpr std::string_view summary =
        "cuts axes into segments with the same number of projections; no box is cut more than once per axis";

    enum class limit_choice : std::uint8_t { on, off };
    struct config {
        /// Number of cut axes: those with the greatest variance of centres come first, a swept axis last. auto: the
        /// cheapest number in a model of uniformly spread boxes, or none if cutting is not worth its cost.
        std::optional<std::uint32_t> axes;
        /// Desired number of segments on each of these axes. auto: the cheapest number in the same model.
        std::optional<std::uint32_t> segments;
        /// off: a box may be cut any number of times; frames with more than 2^24 + 64 n copies of n boxes are rejected.
        limit_choice limit = limit_choice::on;
    };
    static constexpr std::tuple parameters{
        integer_parameter{"axes", &config::axes, 1U, 3U, "number of axes to cut; auto: the cheapest number, or none"},
        integer_parameter{"segments", &config::segments, 1U, 65'535U,
                          "desired number on each of these axes; auto: the cheapest"},
        choice_parameter{"limit", &config::limit, std::array<std::string_view, 2>{"on", "off"},
                         "cut no box more than once per axis"}};

    static constexpr std::array contrasts{std::string_view("axes=3,segments=2")};

    axial_cut_partition() = default;
    explicit axial_cut_partition(const config& c) : config_(c) {}

    /// Chooses the axes to cut: the n of greatest variance, for the n that costs least; none without variance. Similar
    /// axes would alternate, each time with a new list to sort: so an axis is replaced only if the variance on another
    /// is 50% greater, and n changes only if that costs 10% less.
    /// @param swept the axes along which the sweep needs sorted lists
    /// @returns the axes along which `fit` needs sorted lists
    axis_set axes(std::span<const box> boxes, const membership& objects, axis_set swept) {
        const spread along = spread_of(boxes, objects);
        const std::array<int, 3> order = axes_by_variance(along, swept);
        const bool may_cut_none = !config_.axes && !config_.segments;
        candidate_cut best{.cut = 0, .segments = 1, .cost = may_cut_none ? cost_without_cuts(along, swept) : never};
        if (cut_ == 0) best.cost *= cost_bonus;  // `cut_` is still that of the last frame
        axis_set cut = 0;
        for (std::uint32_t n = 1; n <= config_.axes.value_or(3); ++n) {
            const int k = order[n - 1];
            if (along.variance[k] > 0) cut |= axis_set{1} << k;
            if (n < config_.axes.value_or(1) || cut == 0) continue;
            candidate_cut candidate = cheapest_cut(along, cut, swept);
            if (cut == cut_) candidate.cost *= cost_bonus;
            if (candidate.cost < best.cost) best = candidate;
        }
        wanted_ = best.segments;
        cut_ = wanted_ > 1 ? best.cut : 0;
        return cut_;
    }

    /// Chooses the cuts of each axis, and finds the segments that each box overlaps.
    /// @throws input_error if there would be more than 2^26 subsets.
    void fit(const whole_subset& scene) {
        if (cut_) ranges_.resize(scene.boxes.size());
        std::uint64_t subsets = 1;
        for (std::size_t k = 0; k < 3; ++k) {
            cuts_[k].clear();
            if (has_axis(cut_, k)) {
                choose_cuts(scene.boxes, scene.lists[k], k);
                find_ranges(scene.boxes, scene.lists[k], k);
            }
            subsets *= cuts_[k].size() + 1;
        }
        if (subsets > most_subsets)
            throw input_error("axial_cut: " + std::to_string(wanted_) + " segments per axis make " +
                              std::to_string(subsets) + " subsets, more than 2^26");
        assert(subsets == subset_count());
    }

    [[nodiscard]] inline std::uint32_t subset_count() const noexcept {
        return segments_on(0) * segments_on(1) * segments_on(2);
    }

    /// The numbers of segments, summed over all cut axes: `wanted`, and `got`, as equal lower ends and the limit (no
    /// box is cut twice on an axis) make fewer.
    [[nodiscard]] segment_counts segments() const noexcept {
        segment_counts counts{0, 0};
        for (std::size_t k = 0; k < 3; ++k)
            if (has_axis(cut_, k)) {
                counts.wanted += wanted_;
                counts.got += segments_on(k);
            }
        return counts;
    }

    [[nodiscard]] std::uint64_t copies(std::uint32_t id, const box&) const noexcept {
        std::uint64_t count = 1;
        for (const range& r : ranges_of(id)) count *= std::uint64_t{r.last} - r.first + 1;
        return count;
    }

    /// Visits the subsets that a box overlaps, a product of its segments, with the axes on which it begins there.
    template <class Visit>
    void for_each_subset(std::uint32_t id, const box&, Visit visit) const {
        const std::array<range, 3> ranges = ranges_of(id);
        const std::uint32_t along_y = segments_on(1);
        const std::uint32_t along_z = segments_on(2);
        for (std::uint32_t x = ranges[0].first; x <= ranges[0].last; ++x)
            for (std::uint32_t y = ranges[1].first; y <= ranges[1].last; ++y)
                for (std::uint32_t z = ranges[2].first; z <= ranges[2].last; ++z)
                    visit((x * along_y + y) * along_z + z, axis_set{x == ranges[0].first} |
                                                               axis_set{y == ranges[1].first} << 1 |
                                                               axis_set{z == ranges[2].first} << 2);
    }

    [[nodiscard]] std::size_t bytes() const noexcept { return bytes_of(ranges_, cuts_); }

private:
    static constexpr std::uint64_t most_subsets = std::uint64_t{1} << 26;

    /// The first and last segment that a box overlaps on an axis.
    struct range {
        std::uint16_t first;
        std::uint16_t last;
    };

    static constexpr std::size_t index(int k) noexcept { return static_cast<std::size_t>(k); }
    [[nodiscard]] inline std::uint32_t segments_on(std::size_t k) const noexcept {
        return static_cast<std::uint32_t>(cuts_[k].size()) + 1;
    }

    [[nodiscard]] inline std::array<range, 3> ranges_of(std::uint32_t id) const noexcept {
        std::array<range, 3> ranges{};
        for (std::size_t k = 0; k < 3; ++k)
            if (has_axis(cut_, k)) ranges[k] = ranges_[id][k];
        return ranges;
    }

    /// Places cuts at quantiles of the lower ends. With the limit (no box is cut twice on an axis), a cut that would
    /// break it moves up to the first lower end beyond all boxes that begin before the previous cut, or is dropped.
    void choose_cuts(std::span<const box> boxes, std::span<const projection> list, std::size_t k) {
        std::vector<float>& cuts = cuts_[k];
        // The greatest upper end of the boxes that begin before the last cut, which are the first `begun` of the list.
        float reached = -std::numeric_limits<float>::infinity();
        std::size_t begun = 0;
        for (std::uint64_t i = 1; i < wanted_ && !list.empty(); ++i) {
            std::size_t at = i * list.size() / wanted_;  // the quantile
            // Cuts ascend from the first lower end: equal ends drop this one, or an earlier cut that moved beyond it.
            if (!(list[at].key > (cuts.empty() ? list[0].key : cuts.back()))) continue;
            if (config_.limit == limit_choice::on && !cuts.empty()) {
                for (; list[begun].key < cuts.back(); ++begun)
                    reached = std::max(reached, boxes[list[begun].id].max[static_cast<int>(k)]);
                const auto beyond = std::ranges::upper_bound(list, reached, {}, &projection::key);
                at = std::max(at, static_cast<std::size_t>(beyond - list.begin()));
                if (at == list.size()) return;
            }
            cuts.push_back(list[at].key);
        }
        assert(std::ranges::adjacent_find(cuts, std::ranges::greater_equal{}) == cuts.end());
    }

    /// Finds each box's first and last segment on axis k: the numbers of cuts up to its lower and its upper end.
    void find_ranges(std::span<const box> boxes, std::span<const projection> list, std::size_t k) {
        const std::vector<float>& cuts = cuts_[k];
        std::size_t first = 0;
        for (const projection& p : list) {
            while (first < cuts.size() && cuts[first] <= p.key) ++first;
            const float upper = boxes[p.id].max[static_cast<int>(k)];
            std::size_t last = first;
            if (config_.limit == limit_choice::on)  // which leaves at most one cut in a box
                last += first < cuts.size() && cuts[first] <= upper;
            else
                last = static_cast<std::size_t>(std::ranges::upper_bound(cuts, upper) - cuts.begin());
            ranges_[p.id][k] = {static_cast<std::uint16_t>(first), static_cast<std::uint16_t>(last)};
        }
    }

    /// Axes in descending variance of centres, with a bonus for axes that are cut already, so that nearly equal ones do
    /// not alternate from frame to frame. If only one axis is swept, it comes last but for axes without variance: the
    /// sweep separates boxes along it anyway.
    [[nodiscard]] std::array<int, 3> axes_by_variance(const spread& along, axis_set swept) const {
        std::array<int, 3> order{0, 1, 2};
        const auto varies = [&](int k) { return along.variance[k] > 0; };
        const auto is_last = [&](int k) { return swept == axis_set{1} << k; };
        const auto weight = [&](int k) { return along.variance[k] * (has_axis(cut_, index(k)) ? variance_bonus : 1); };
        std::ranges::sort(order, [&](int k, int l) {
            if (varies(k) != varies(l)) return varies(k);
            if (is_last(k) != is_last(l)) return is_last(l);
            return weight(k) > weight(l) || (weight(k) == weight(l) && k < l);
        });
        return order;
    }

    struct candidate_cut {
        axis_set cut;
        std::uint32_t segments;  // per axis
        double cost;             // per frame, in nanoseconds
    };
    static constexpr double never = std::numeric_limits<double>::infinity();
    static constexpr double cost_bonus = 0.9, variance_bonus = 1.5;  // factors for what is cut already

    /// The extent of a mean box relative to that of the scene, by axis. For uniformly distributed centres, the scene is
    /// sqrt(12) standard deviations and an extent wide. (`variance` is that of doubled centres, times their number.)
    [[nodiscard]] static vec3d shares_of(const spread& along) {
        vec3d share{};
        for (int k = 0; k < 3; ++k) {
            const double width =
                std::sqrt(12 * along.variance[k] / static_cast<double>(along.objects)) / 2 + along.extent[k];
            share[k] = width > 0 ? along.extent[k] / width : 1;
        }
        return share;
    }

    /// Each cut or swept axis needs a sorted list.
    [[nodiscard]] static double cost_of_lists(const spread& along, axis_set needed) {
        return machine_costs().list_entry * static_cast<double>(along.objects) * std::popcount(needed);
    }

    /// The cost of the whole scene as one subset: its lists, and a test for each pair of boxes that overlap on the best
    /// swept axis. That is a share of about 2 e / w of all pairs, for boxes of extent e in a scene of width w.
    [[nodiscard]] static double cost_without_cuts(const spread& along, axis_set swept) {
        const vec3d share = shares_of(along);
        const auto objects = static_cast<double>(along.objects);
        double swept_share = 1;
        for (int k = 0; k < 3; ++k)
            if (has_axis(swept, index(k))) swept_share = std::min(swept_share, 2 * share[k]);
        return cost_of_lists(along, swept) + machine_costs().cut_test * objects * objects / 2 * swept_share;
    }

    /// The cheapest number of segments per axis, if not configured, for n uniformly spread boxes of the mean size. S
    /// segments make 1 + S · extent / width copies of a box, at most 2 with the limit; in a subset, a box is tested
    /// against those that overlap it on the swept axis. There are never more subsets than boxes, so that no cost model
    /// gets a frame rejected.
    [[nodiscard]] candidate_cut cheapest_cut(const spread& along, axis_set cut, axis_set swept) const {
        const auto objects = static_cast<double>(along.objects);
        const vec3d share = shares_of(along);
        candidate_cut best{.cut = cut, .segments = 1, .cost = never};
        const cost_model& ns = machine_costs();
        const double most = config_.segments.value_or(65'535);  // the most that a `range` can number
        for (double s = config_.segments.value_or(1); s <= most; s = std::ceil(s * 1.1)) {
            double subsets = 1, copies = objects, swept_share = 1;
            for (int k = 0; k < 3; ++k) {
                const bool is_cut = has_axis(cut, index(k));
                if (is_cut) {
                    subsets *= s;
                    copies *= 1 + s * share[k];
                }
                if (has_axis(swept, index(k))) swept_share = std::min(swept_share, 2 * share[k] * (is_cut ? s : 1));
            }
            if (!config_.segments && s > 1 && subsets > objects) break;
            // In a subset of c copies, c^2 / 2 pairs, times the share of those that overlap on the swept axis.
            const double tests = copies / subsets * copies / 2 * std::min(1.0, swept_share);
            const double cost = ns.cut_entry * copies + ns.cut_subset * subsets + ns.cut_test * tests;
            if (cost <= best.cost) best = {.cut = cut, .segments = static_cast<std::uint32_t>(s), .cost = cost};
        }
        best.cost += cost_of_lists(along, cut | swept);
        return best;
    }

    config config_;
    axis_set cut_ = 0;
    std::uint32_t wanted_ = 1;                  // segments per axis
    std::array<std::vector<float>, 3> cuts_;    // ascending
    std::vector<std::array<range, 3>> ranges_;  // by id
};

static_assert(SegmentingPartition<axial_cut_partition>);

}  // namespace aabb
