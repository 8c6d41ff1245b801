export module aabb.sweep.temporal_kd_tree;

import aabb.global_search;
import aabb.std;

export namespace aabb {

/// A kd-tree whose nodes hold each box once, kept between frames with its pairs: the algorithm of Serpa and Rodrigues,
/// "Flexible use of temporal and spatial reasoning for fast and scalable CPU broad-phase collision detection using
/// KD-trees" (Computer Graphics Forum 38, 2019), after the authors' program, Broadmark (Algorithms/KD). When to use:
/// scenes of which less than half moves at a time.
///
/// Boxes are grown by a margin, and one that stays within its grown box is static. A box lies at the lowest node whose
/// cell holds it: one that a plane cuts stays above the children, and is tested on the way down against all boxes that
/// it may meet. Each node sorts its boxes, and those from above, along the axis on which its own vary most, and sweeps
/// them. If more than half of the boxes are static, pairs of two static boxes are kept, and neither tested again nor
/// are subtrees visited that have no others; otherwise all pairs are searched again.
///
/// A box that has left its cell climbs until one holds it, and descends from there. Then, from the root down, a subtree
/// of too few boxes, or with none on one side, becomes a leaf; a plane for which the pairs to test exceed the balance
/// of its sides (`is_poor`) moves to the mean of the centres, and if that does not help, the larger child replaces its
/// node; and a leaf of too many boxes is split at the mean of the centres along their axis of greatest variance.
/// `kd_tree`, in contrast, copies boxes into all leaves that they meet, rebuilds subtrees, and sweeps leaves alone.
///
/// Results are those of the boxes themselves: the pairs of grown boxes are tested in each frame, one test each. Cells
/// are open, so that boxes that touch a plane from both sides meet at its node. Nodes that are 64 deep are not split.
///
/// Time: O(n) per frame to compare boxes, and per box that moves its climb, its descent, and tests; a frame at rest
/// takes a test per pair. Memory: 37 bytes per object, 64 per node, 16 per pair of grown boxes, and for sorting and
/// sweeping 40 per box of the largest node and per box above it.
class temporal_kd_tree_sweep {
public:
    static constexpr std::string_view name = "temporal_kd_tree";
    static constexpr std::string_view summary =
        "a kd-tree that holds each box once, kept with the pairs of boxes at rest";

    struct config {
        /// A leaf with more boxes is split; a subtree with fewer becomes a leaf. The default is Broadmark's.
        std::uint32_t leaf = 512;
        /// The distance by which boxes are grown on every side. Broadmark's default for its boxes of about one unit.
        double margin = 0.01;
    };
    static constexpr std::tuple parameters{
        integer_parameter{"leaf", &config::leaf, 1U, 65'535U, "greatest number of boxes per leaf"},
        number_parameter{"margin", &config::margin, 0.0, std::numeric_limits<double>::max(),
                         "by how much boxes are grown on every side, in mean extents", true}};

    /// It has subsets and lists of its own, which any sort can sort.
    template <class... All>
    static constexpr std::string_view rejects() {
        if (((CuttingPartition<All> || SearchingPartition<All>) || ...))
            return "temporal_kd_tree divides boxes by a tree of its own; it can be combined with none only";
        return {};
    }

    temporal_kd_tree_sweep() = default;
    explicit temporal_kd_tree_sweep(const config& c) : config_(c) {}

    /// Brings the tree and the pairs to a frame.
    template <class Sort, CounterPolicy Counters>
    void update(std::span<const box> boxes, const membership& objects, Sort& sort, Counters& counters) {
        const bool has_changed = grow_moved(boxes, objects);
        if (has_changed) {
            forget_pairs();
            update_tree();
            search_node(/*at=*/0, /*above=*/0, sort, counters);
        }
        pairs_.clear();
        for (const index_pair p : grown_pairs_)
            if (overlaps(boxes[p.a], boxes[p.b])) pairs_.push_back(p);
        counters.add(work::box_tests, grown_pairs_.size());
    }

    void search(std::vector<index_pair>& pairs) const { pairs.insert(pairs.end(), pairs_.begin(), pairs_.end()); }

    [[nodiscard]] static constexpr axis_set axes() noexcept { return every_axis; }
    /// Whether pairs of static boxes were kept in this frame.
    [[nodiscard]] bool keeps_pairs() const noexcept { return keeps_pairs_; }
    /// The number of nodes in the tree.
    [[nodiscard]] std::size_t nodes() const noexcept { return nodes_.size() - free_.size(); }
    [[nodiscard]] std::size_t bytes() const noexcept;

private:
    static constexpr std::uint32_t is_leaf = 3;
    static constexpr std::uint32_t none = ~std::uint32_t{0};
    static constexpr std::size_t most_depth = 64;
    using quad = float __attribute__((vector_size(16)));

    struct node {
        box cell;  ///< open
        float plane = 0;
        std::uint32_t axis = is_leaf;
        std::array<std::uint32_t, 2> children{none, none};  ///< left, right
        std::uint32_t parent = none;
        std::uint32_t first = 0;       ///< index in order_ of its boxes, which those of its subtree follow
        std::uint32_t own = 0;         ///< number of boxes at the node
        std::uint32_t population = 0;  ///< the same of its subtree
        std::uint32_t moving = 0;      ///< number of boxes of its subtree that are not static
        std::uint32_t own_moving = 0;
    };
    /// How a plane divides boxes: the numbers of those that it cuts, and of those strictly left and right of it.
    struct division {
        std::size_t cut, left, right;
    };

    /// The mean of boxes' centres, and the axis on which they vary most.
    struct centres {
        vec3d mean;
        std::uint32_t axis;
    };

    /// A grown box with permuted axes; aligned, so that none straddles two cache lines.
    struct alignas(32) swept_box {
        quad bounds;  ///< on the other axes u and v: u max, v max, -u min, -v min
        float begin;  ///< on the swept axis
        float end;
        std::uint32_t id;
        std::uint32_t is_static;  ///< and its pairs with other static boxes are kept
    };
    static_assert(sizeof(swept_box) == 32);

    [[nodiscard]] bool grow_moved(std::span<const box> boxes, const membership& objects);
    void forget_pairs();
    void update_tree();
    void list_nodes();
    void place_moved();
    void order_by_node();
    void mend(std::uint32_t at, std::size_t depth);
    void settle(std::uint32_t at, std::size_t first, std::size_t count, std::size_t depth);
    void make_leaf(std::uint32_t at);
    void replace_by_child(std::uint32_t at, std::size_t side);
    void free_subtree(std::uint32_t at);
    [[nodiscard]] std::uint32_t take_node();
    [[nodiscard]] division divide(std::size_t first, std::size_t count, std::uint32_t axis, float plane);
    [[nodiscard]] bool is_useless(const division& d) const noexcept;
    [[nodiscard]] static bool is_poor(const division& d) noexcept;
    [[nodiscard]] centres centres_of(std::span<const std::uint32_t> ids) const;

    /// Sorts and sweeps the boxes of a node, then its subtrees.
    /// @param above where the boxes from above begin in above_, which may overlap those of the node
    template <class Sort, CounterPolicy Counters>
    void search_node(std::uint32_t at, std::size_t above, Sort& sort, Counters& counters) {
        const node& n = nodes_[at];
        const bool any_moving_above = std::ranges::any_of(std::span(above_).subspan(above),
                                                          [this](std::uint32_t id) { return is_static_[id] == 0; });
        if (keeps_pairs_ && n.moving == 0 && !any_moving_above) return;
        if (n.own > 0 && !(keeps_pairs_ && n.own_moving == 0 && !any_moving_above)) {
            const std::span<std::uint32_t> ids = std::span(order_).subspan(n.first, n.own);
            const auto axis = static_cast<int>(centres_of(ids).axis);
            sort_boxes(ids, axis, own_, sort, counters);
            for (std::size_t i = 0; i < ids.size(); ++i) ids[i] = own_[i].id;  // so that the next frame finds it sorted
            test_within(counters);
            sort_boxes(std::span(above_).subspan(above), axis, from_above_, sort, counters);
            test_between(counters);
        }
        if (n.axis == is_leaf) return;
        for (std::size_t side = 0; side < 2; ++side) {
            const std::uint32_t child = n.children[side];
            if (nodes_[child].population == 0) continue;
            const std::size_t end = above_.size();
            const auto k = static_cast<int>(n.axis);
            const auto reaches = [&](std::uint32_t id) {
                return side == 0 ? grown_[id].min[k] < n.plane : grown_[id].max[k] > n.plane;
            };
            for (std::size_t i = above; i < end; ++i)
                if (reaches(above_[i])) above_.push_back(above_[i]);
            for (std::size_t i = n.first; i < n.first + n.own; ++i)
                if (reaches(order_[i])) above_.push_back(order_[i]);
            search_node(child, end, sort, counters);
            above_.resize(end);
        }
    }

    /// Copies boxes, sorted by their lower ends on an axis.
    template <class Sort, CounterPolicy Counters>
    void sort_boxes(std::span<const std::uint32_t> ids, int axis, std::vector<swept_box>& sorted, Sort& sort,
                    Counters& counters) {
        list_.clear();
        for (const std::uint32_t id : ids) list_.push_back({grown_[id].min[axis], id});
        sort.sort(std::span(list_), counters);
        const int u = (axis + 1) % 3, v = (axis + 2) % 3;
        sorted.clear();
        for (const projection& p : list_) {
            const box& b = grown_[p.id];
            sorted.push_back({{b.max[u], b.max[v], -b.min[u], -b.min[v]},
                              b.min[axis],
                              b.max[axis],
                              p.id,
                              static_cast<std::uint32_t>(keeps_pairs_ && is_static_[p.id] != 0)});
        }
    }

    /// Tests a box against those of a sorted list that begin before it ends, but not two static ones.
    template <CounterPolicy Counters>
    void test(const swept_box& a, std::span<const swept_box> list, Counters& counters) {
        const quad lower = {-a.bounds[2], -a.bounds[3], -a.bounds[0], -a.bounds[1]};  // u min, v min, -u max, -v max
        for (const swept_box& b : list) {
            if (b.begin > a.end) return;
            if ((a.is_static & b.is_static) != 0) continue;
            counters.add(work::box_tests);
            if (__builtin_reduce_and(lower <= b.bounds) != 0) grown_pairs_.push_back(ordered_pair(a.id, b.id));
        }
    }
    template <CounterPolicy Counters>
    void test_within(Counters& counters) {
        for (std::size_t i = 0; i < own_.size(); ++i) test(own_[i], std::span(own_).subspan(i + 1), counters);
    }
    /// Tests the boxes of a node against those from above: each against the others that begin later.
    template <CounterPolicy Counters>
    void test_between(Counters& counters) {
        std::size_t i = 0, j = 0;
        while (i < own_.size() && j < from_above_.size()) {
            if (own_[i].begin < from_above_[j].begin)
                test(own_[i++], std::span(from_above_).subspan(j), counters);
            else
                test(from_above_[j++], std::span(own_).subspan(i), counters);
        }
    }

    config config_;
    bool keeps_pairs_ = false;
    std::vector<box> grown_;               // by id
    std::vector<std::uint8_t> is_static_;  // by id
    std::vector<std::uint32_t> node_of_;   // by id; none of absent objects
    std::vector<std::uint32_t> order_;     // ids of present objects, by node in preorder
    std::vector<node> nodes_;              // the first is the root
    std::vector<std::uint32_t> free_;      // unused nodes
    std::vector<index_pair> grown_pairs_;  // pairs of grown boxes that overlap
    std::vector<index_pair> pairs_;        // those of them whose boxes overlap
    // Used within a frame:
    std::vector<std::uint32_t> listed_;  // nodes, parents first
    std::vector<std::uint32_t> placed_;  // ids in a new order
    std::vector<std::uint32_t> above_;   // a stack of boxes at the nodes above, those of children behind their parents
    std::vector<projection> list_;
    std::vector<swept_box> own_;
    std::vector<swept_box> from_above_;
};

static_assert(CoherentSweep<temporal_kd_tree_sweep>);

}  // namespace aabb
