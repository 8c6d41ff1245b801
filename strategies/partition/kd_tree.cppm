export module aabb.partition.kd_tree;

import aabb.global_search;
import aabb.std;

export namespace aabb {

/// A kd-tree over the frame: planes at medians of the boxes' centres divide space into leaves, and each leaf that a box
/// overlaps gets a copy of it. Planes are kept between frames; only subtrees whose boxes have moved elsewhere are
/// rebuilt. It takes from Serpa and Rodrigues, "Flexible use of temporal and spatial reasoning for fast and scalable
/// CPU broad-phase collision detection using KD-trees" (Computer Graphics Forum 38, 2019), that planes outlive frames;
/// theirs, which holds each box once and keeps pairs too, is `temporal_kd_tree`. Here the descent of a box starts at
/// the last node whose cell contained it, if it still does, and any sweep can run in the leaves. When to use: clusters
/// and varying densities, which cells of one size do not fit.
///
/// A box lies left of a plane if its lower end does, and right if its upper end does not. Cells are half-open, and a
/// pair is owned by the leaf that contains its greater lower ends.
///
/// A node is split at the median of the axis that is cheapest in a model of uniformly spread boxes, if splitting is
/// cheaper than not splitting. Swept axes are therefore hardly ever split, nor are nodes in which most boxes would be
/// copied. A frame has at most eight copies per box on average when planes are new, and a full rebuild follows at 16.
class kd_tree_partition {
public:
    static constexpr std::string_view name = "kd_tree";
    static constexpr std::string_view summary =
        "planes at medians, kept between frames and rebuilt where boxes have moved elsewhere";

    struct config {
        /// A leaf with more boxes is split if that copies at most half of them. auto: if splitting costs less.
        std::optional<std::uint32_t> leaf;
    };
    static constexpr std::tuple parameters{
        integer_parameter{"leaf", &config::leaf, 2U, 65'535U, "greatest number of boxes per leaf; auto: the cheapest"}};

    kd_tree_partition() = default;
    explicit kd_tree_partition(const config& c) : config_(c) {}

    /// Needs no sorted lists: planes follow from the boxes alone.
    axis_set axes(std::span<const box> boxes, const membership& objects, axis_set swept);
    void fit(const whole_subset& scene);

    [[nodiscard]] std::uint32_t subset_count() const noexcept { return leaves_; }
    /// Number of nodes built in this frame, including leaves.
    [[nodiscard]] std::size_t built_nodes() const noexcept { return built_nodes_; }

    [[nodiscard]] inline std::uint64_t copies(std::uint32_t id, const box&) const noexcept {
        return starts_[id + 1] - starts_[id];
    }

    template <class Visit>
    void for_each_subset(std::uint32_t id, const box&, Visit visit) const {
        for (std::uint32_t i = starts_[id]; i < starts_[id + 1]; ++i) visit(entries_[i] >> 3, entries_[i] & every_axis);
    }

    [[nodiscard]] std::size_t bytes() const noexcept;

private:
    static constexpr std::uint32_t is_leaf = 3;
    static constexpr std::uint32_t unknown = ~std::uint32_t{0};
    static constexpr std::size_t most_depth = 48;
    static constexpr std::uint64_t most_copies = 8;  // per box, on average

    /// Nodes are stored in preorder: the left child directly follows its parent.
    struct node {
        box cell;  ///< half-open
        float plane;
        std::uint32_t axis;                     ///< or is_leaf
        std::array<std::uint32_t, 2> children;  ///< left, right; in a leaf, the first is its number
        std::uint32_t initial_copies;           ///< number of copies in its leaves when it was built
    };

    struct split {
        std::uint32_t axis;
        float plane;
        double cost;  ///< of the node's boxes per frame, in nanoseconds
    };

    void rebuild_all(std::span<const box> boxes);
    void rebuild_stale(std::span<const box> boxes);
    void copy_or_rebuild(std::span<const box> boxes, std::uint32_t old, std::size_t depth);
    void build_subtree(std::span<const box> boxes, std::size_t first, std::size_t count, const box& cell,
                       std::size_t depth);
    std::uint32_t place_box(const box& b, std::uint32_t from);
    [[nodiscard]] std::uint32_t outermost_leaf(std::uint32_t at, std::size_t side) const noexcept;
    [[nodiscard]] split best_split(std::span<const box> boxes, std::size_t first, std::size_t count) const;
    [[nodiscard]] bool divide(std::span<const box> boxes, std::size_t first, std::size_t count, const split& at,
                              std::array<std::size_t, 2>& counts);
    [[nodiscard]] bool place_boxes(std::span<const box> boxes);
    void find_stale_nodes();
    [[nodiscard]] bool is_stale(std::uint32_t at) const noexcept;
    void collect_stale_roots(std::uint32_t at);
    void collect_stale_boxes();

    config config_;
    axis_set swept_ = 0;
    bool is_tree_valid_ = false;  // the members below are consistent: the last frame completed without an exception
    std::vector<std::uint32_t> present_;
    std::vector<node> nodes_;
    std::uint32_t leaves_ = 1;
    std::vector<std::uint32_t> starts_;   // by id, in entries_
    std::vector<std::uint32_t> entries_;  // leaf << 3 | the axes whose lower end lies there
    std::vector<std::uint32_t>
        start_nodes_;  // by id: the lowest node whose cell contains the box, where its descent starts
    std::vector<std::uint32_t> copies_in_leaf_;  // by leaf: number of copies
    std::vector<std::uint32_t> copies_below_;    // by node: number of copies in its leaves
    double pairs_ = 0;                           // number of ordered pairs within leaves
    double initial_pairs_ = 0;                   // the same when the planes were chosen
    std::size_t built_nodes_ = 0;
    // Used while planes are chosen:
    std::vector<node> old_;
    std::vector<std::uint32_t> new_index_;     // by old node: its new index, or that of the subtree that replaces it
    std::vector<std::uint32_t> stale_roots_;   // nodes whose subtrees the next frame rebuilds, ascending
    std::vector<std::uint32_t> root_of_leaf_;  // by leaf: index of its stale root plus one, or 0 if the leaf stays
    std::vector<std::size_t> boxes_begin_;     // by stale root: range of its boxes in ids_
    std::vector<std::size_t> boxes_end_;
    std::vector<std::uint32_t> ids_;  // a stack of the boxes of the nodes being built, children above their parents
    std::uint64_t extra_copies_ = 0;  // number of copies beyond the first of each box
};

static_assert(CuttingPartition<kd_tree_partition>);

}  // namespace aabb
