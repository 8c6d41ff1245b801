export module aabb.sweep.one_axis;

import aabb.global_search;
import aabb.std;

export namespace aabb {

/// Sweep and prune along one axis (Cohen, Lin, Manocha and Ponamgi, "I-COLLIDE", 1995, prune on three): each box is
/// tested on the other two axes against those that begin before it ends. When to use: almost always; linear memory.
///
/// `insertion` + `none` + `one_axis:axis=x` is the broad phase `SWEEP_AND_PRUNE` of Nape (L. Deltour,
/// zpp_nape/space/SweepPhase) and `SortAndSweep1D` of BEPUphysics 1 (R. Nordby): both keep a list sorted by lower ends
/// on x by insertion sort, and test the others. Nape is planar, so that it tests y alone; it sorts a linked list.
class one_axis_sweep {
public:
    static constexpr std::string_view name = "one_axis";
    static constexpr std::string_view summary = "sweeps along one axis and tests the other two";

    enum class axis_choice : std::uint8_t { automatic, x, y, z };
    struct config {
        /// auto: the axis with the greatest variance of the boxes' centres. It changes only if the variance on another
        /// is 50% greater, since a new list is sorted from scratch.
        axis_choice axis = axis_choice::automatic;
    };
    static constexpr std::tuple parameters{choice_parameter{
        "axis", &config::axis, std::array<std::string_view, 4>{"auto", "x", "y", "z"}, "the axis to sort along"}};

    one_axis_sweep() = default;
    explicit one_axis_sweep(const config& c) : config_(c) {}

    axis_set axes(std::span<const box> boxes, const membership& objects) {
        const bool is_automatic = config_.axis == axis_choice::automatic;
        axis_ = is_automatic ? longest_.choose(boxes, objects) : static_cast<int>(config_.axis) - 1;
        return axis_set{1} << axis_;
    }

    /// Copies the boxes of a sorted list with permuted axes, and tests those that overlap on the swept axis. Lower ends
    /// on the other axes are negated, so that one comparison of vectors, a <= b, tests both axes.
    template <class Subset, CounterPolicy Counters>
    void sweep(const Subset& subset, std::vector<index_pair>& pairs, Counters& counters) {
        const auto& list = subset.lists[static_cast<std::size_t>(axis_)];
        if (list.size() < 2) return;
        swept_.clear();
        const int u = (axis_ + 1) % 3, v = (axis_ + 2) % 3;
        for (const auto& e : list) {
            const box& b = subset.boxes[e.id];
            swept_.push_back(
                {{b.max[u], b.max[v], -b.min[u], -b.min[v]}, b.min[axis_], b.max[axis_], e.id, Subset::owned(e)});
        }
        test_pairs<Subset>(pairs, counters);
    }

    [[nodiscard]] std::size_t bytes() const noexcept { return bytes_of(swept_); }

private:
    using quad = float __attribute__((vector_size(16)));

    /// A box with permuted axes; aligned, so that none straddles two cache lines.
    struct alignas(32) swept_box {
        quad bounds;  ///< on the other axes u and v: u max, v max, -u min, -v min
        float begin;  ///< on the swept axis
        float end;
        std::uint32_t id;
        axis_set owned;
    };
    static_assert(sizeof(swept_box) == 32);

    /// Tests each box against the later ones that begin before it ends, and reports the pairs that this subset owns.
    template <class Subset, CounterPolicy Counters>
    void test_pairs(std::vector<index_pair>& pairs, Counters& counters) const {
        for (std::size_t i = 0; i < swept_.size(); ++i) {
            const swept_box a = swept_[i];
            const quad lower = {-a.bounds[2], -a.bounds[3], -a.bounds[0],
                                -a.bounds[1]};  // u min, v min, -u max, -v max
            for (std::size_t j = i + 1; j < swept_.size() && swept_[j].begin <= a.end; ++j) {
                const swept_box& b = swept_[j];
                counters.add(work::box_tests);
                // Four comparisons at once: branches would be more expensive, since the failing one is hard to predict.
                if (__builtin_reduce_and(lower <= b.bounds) != 0 && Subset::owns(a.owned, b.owned))
                    pairs.push_back(ordered_pair(a.id, b.id));
            }
        }
    }

    config config_;
    int axis_ = 0;
    chosen_axis longest_;
    std::vector<swept_box> swept_;  // the boxes of the current subset, sorted by `begin`
};

static_assert(ListSweep<one_axis_sweep>);

}  // namespace aabb
