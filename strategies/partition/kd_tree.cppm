export module aabb.partition.kd_tree;

import aabb.global_search;
import aabb.std;

export namespace aabb {

/// A kd-tree over the frame: planes at medians of the boxes' centres cut space into leaves, and a box is copied into
/// every leaf that it reaches into. Planes are kept from frame to frame; only below a node whose boxes went elsewhere
/// are they chosen anew. After Serpa and Rodrigues, "Flexible use of temporal and spatial reasoning for fast and
/// scalable CPU broad-phase collision detection using KD-trees" (Computer Graphics Forum 38, 2019), from what the names
/// and comments of its authors' program tell: it too hands boxes that lie across planes down to the leaves, but moves
/// planes and objects in place; here a box is looked for from the last node whose cell held all of it, if it still
/// does, and the sweep in a leaf is whichever is named. When to use: clusters and unlike densities, for which cells of
/// one size do not do.
///
/// A box lies left of a plane when its lower end does, and right when its upper end does not, so space is divided
/// half-open, and the leaf that holds the greater lower ends of a pair owns it.
///
/// A node is split on the axis, of those on which its boxes have a median, that a model of evenly spread boxes finds
/// cheapest, and where that is cheaper than not to split: so an axis that is swept is hardly cut, and nothing is where
/// most boxes would be copied. No frame has more than eight copies of each box when planes are new, and sixteen before
/// all are chosen anew.
class kd_tree_partition {
public:
    static constexpr std::string_view name = "kd_tree";
    static constexpr std::string_view summary =
        "planes at medians, kept between frames and chosen anew where boxes went elsewhere";

    struct config {
        /// A leaf with more boxes is split wherever no more than half of them are copied. auto: where that costs less.
        std::optional<std::uint32_t> leaf;
    };
    static constexpr std::tuple parameters{
        integer_parameter{"leaf", &config::leaf, 2U, 65'535U, "boxes in a leaf; auto: as many as cost least"}};

    kd_tree_partition() = default;
    explicit kd_tree_partition(const config& c) : config_(c) {}

    /// It looks at boxes, not at lists.
    axis_set axes(std::span<const box> boxes, const membership& objects, axis_set swept);

    void fit(const whole_subset& all);

    [[nodiscard]] std::uint32_t subset_count() const noexcept { return leaves_; }
    /// How many nodes had their planes chosen in this frame, leaves among them.
    [[nodiscard]] std::size_t made_nodes() const noexcept { return made_nodes_; }

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
    static constexpr std::uint64_t most_copies = 8;  // of a box, on average

    /// Nodes stand before their children, the left one right behind.
    struct node {
        box cell;  ///< half-open
        float plane;
        std::uint32_t axis;                     ///< or is_leaf
        std::array<std::uint32_t, 2> children;  ///< left, right; of a leaf its number
        std::uint32_t at_first;                 ///< copies in its leaves when it was made
    };

    /// Where to split a node, and what the frame costs then, in nanoseconds.
    struct split {
        std::uint32_t axis;
        float plane;
        double cost;
    };

    void choose_all(std::span<const box> boxes);
    void choose_stale(std::span<const box> boxes);
    void copy_or_choose(std::span<const box> boxes, std::uint32_t old, std::size_t depth);
    void choose(std::span<const box> boxes, std::size_t first, std::size_t count, const box& cell, std::size_t depth);
    std::uint32_t put(const box& b, std::uint32_t from);
    [[nodiscard]] std::uint32_t leaf_of(std::uint32_t at, std::size_t side) const noexcept;
    [[nodiscard]] split best_split(std::span<const box> boxes, std::size_t first, std::size_t count) const;
    [[nodiscard]] bool divide(std::span<const box> boxes, std::size_t first, std::size_t count, const split& at,
                              std::array<std::size_t, 2>& parts);
    [[nodiscard]] bool place(std::span<const box> boxes);
    void compare();
    [[nodiscard]] bool is_off(std::uint32_t at) const noexcept;
    void mark(std::uint32_t at);
    void gather();

    config config_;
    axis_set swept_ = 0;
    bool is_whole_ = false;  // what follows is that of a frame
    std::vector<std::uint32_t> present_;
    std::vector<node> nodes_;
    std::uint32_t leaves_ = 1;
    std::vector<std::uint32_t> starts_;   // by id, in entries_
    std::vector<std::uint32_t> entries_;  // leaf << 3 | the axes whose lower end lies there
    std::vector<std::uint32_t> homes_;    // by id: the lowest node whose cell holds all of the box
    std::vector<std::uint32_t> in_leaf_;  // copies
    std::vector<std::uint32_t> below_;    // by node: copies in its leaves
    double pairs_ = 0;                    // within leaves
    double pairs_at_first_ = 0;
    std::size_t made_nodes_ = 0;
    // While planes are chosen:
    std::vector<node> old_;
    std::vector<std::uint32_t> now_at_;      // by old node: itself, or what stands for it now
    std::vector<std::uint32_t> groups_;      // nodes to be chosen anew in the next frame, in their order
    std::vector<std::uint32_t> group_of_;    // by leaf, from 1; 0: stays
    std::vector<std::size_t> group_starts_;  // in ids_
    std::vector<std::size_t> group_ends_;
    std::vector<std::uint32_t> ids_;  // of the nodes at hand, those of a child behind its parent's
    std::uint64_t copied_ = 0;
};

static_assert(CuttingPartition<kd_tree_partition>);

}  // namespace aabb
