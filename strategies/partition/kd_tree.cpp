module;
#include <cassert>

module aabb.partition.kd_tree;

import aabb.costs;

#pragma clang fp contract(off) reassociate(off) reciprocal(off)  // see aabb.base:floating_point

namespace aabb {

namespace {

/// Limit on the sample of boxes from which a split is chosen.
constexpr std::size_t most_sampled = 128;

/// A sample of a node's boxes.
struct sampled {
    std::array<const box*, most_sampled> boxes;
    std::size_t n = 0;
    box bounds = empty_box();
    vec3d extent{};  // mean

    /// Takes boxes at a regular stride, and measures their bounds and mean extent.
    sampled(std::span<const box> boxes_by_id, std::span<const std::uint32_t> ids) {
        const std::size_t step = (ids.size() + most_sampled - 1) / most_sampled;
        for (std::size_t i = 0; i < ids.size(); i += step) {
            const box& b = boxes_by_id[ids[i]];
            boxes[n++] = &b;
            bounds = merged(bounds, b);
            for (int k = 0; k < 3; ++k) extent[k] += double{b.max[k]} - double{b.min[k]};
        }
        for (int k = 0; k < 3; ++k) extent[k] /= static_cast<double>(n);
    }

    /// The median of the centres, halved before they are summed to avoid overflow.
    [[nodiscard]] float median(int k) const {
        std::array<float, most_sampled> centres;
        for (std::size_t i = 0; i < n; ++i) centres[i] = boxes[i]->min[k] / 2 + boxes[i]->max[k] / 2;
        const auto middle = centres.begin() + static_cast<std::ptrdiff_t>(n / 2);
        std::nth_element(centres.begin(), middle, centres.begin() + static_cast<std::ptrdiff_t>(n));
        return *middle;
    }

    /// The cost of a subset: its entries, and a test for each pair of boxes that overlap on the best swept axis, a
    /// share of about 2 e / w of all pairs, for boxes of mean extent e in bounds of width w.
    [[nodiscard]] double cost(double count, const box& within, axis_set swept) const {
        const cost_model& ns = machine_costs();
        double share = 1;
        for (int k = 0; k < 3; ++k) {
            const double width = double{within.max[k]} - double{within.min[k]};
            if (has_axis(swept, static_cast<std::size_t>(k)) && width > 2 * extent[k])
                share = std::min(share, 2 * extent[k] / width);
        }
        return ns.cut_subset + ns.cut_entry * count + ns.cut_test * count * count / 2 * share;
    }
};

/// Whether a half-open cell contains a box.
bool lies_within(const box& b, const box& cell) {
    unsigned within = 1;
    for (int k = 0; k < 3; ++k)
        within &= static_cast<unsigned>(b.min[k] >= cell.min[k]) & static_cast<unsigned>(b.max[k] < cell.max[k]);
    return within != 0;
}

bool lies_left(const box& b, std::uint32_t axis, float plane) {
    return b.min[static_cast<int>(axis)] < plane;
}
bool lies_right(const box& b, std::uint32_t axis, float plane) {
    return b.max[static_cast<int>(axis)] >= plane;
}

}  // namespace

/// Collects the present objects. A tree for other swept axes is discarded, since the costs of splits depend on them.
axis_set kd_tree_partition::axes(std::span<const box> boxes, const membership& objects, axis_set swept) {
    is_tree_valid_ &= swept == swept_;
    swept_ = swept;
    present_.clear();
    for (std::uint32_t id = 0; id < boxes.size(); ++id)
        if (objects.contains(id)) present_.push_back(id);
    return 0;
}

/// Rebuilds the subtrees that the last frame found stale, and finds the leaves of all boxes.
void kd_tree_partition::fit(const whole_subset& scene) {
    built_nodes_ = 0;
    // After an exception, the next frame rebuilds the whole tree.
    if (!std::exchange(is_tree_valid_, false))
        rebuild_all(scene.boxes);
    else if (!stale_roots_.empty())
        rebuild_stale(scene.boxes);
    [[maybe_unused]] bool placed = place_boxes(scene.boxes);
    if (!placed) {
        rebuild_all(scene.boxes);
        placed = place_boxes(scene.boxes);
    }
    find_stale_nodes();
    // Stale subtrees are usually rebuilt in the next frame, so that boxes are placed only once per frame, but not if
    // they make the current frame much more expensive.
    if (!stale_roots_.empty() && pairs_ > 2 * initial_pairs_) {
        rebuild_stale(scene.boxes);
        placed = place_boxes(scene.boxes);
        find_stale_nodes();
    }
    assert(placed);
    is_tree_valid_ = true;
}

std::size_t kd_tree_partition::bytes() const noexcept {
    return bytes_of(present_, nodes_, starts_, entries_, start_nodes_, new_index_, copies_in_leaf_, copies_below_, old_,
                    stale_roots_, root_of_leaf_, boxes_begin_, boxes_end_, ids_);
}

/// Builds the tree anew from the present objects.
void kd_tree_partition::rebuild_all(std::span<const box> boxes) {
    nodes_.clear();
    leaves_ = 0;
    stale_roots_.clear();
    extra_copies_ = 0;
    initial_pairs_ = 0;
    ids_ = present_;
    start_nodes_.clear();
    const box all_space{.min = empty_box().max, .max = empty_box().min};  // infinite
    build_subtree(boxes, /*first=*/0, ids_.size(), /*cell=*/all_space, /*depth=*/0);
}

/// Replaces the tree by a copy in which the subtrees at `stale_roots_` are rebuilt from their boxes.
void kd_tree_partition::rebuild_stale(std::span<const box> boxes) {
    collect_stale_boxes();
    old_.swap(nodes_);
    nodes_.clear();
    leaves_ = 0;
    extra_copies_ = 0;
    for (const std::uint32_t copies : copies_in_leaf_) extra_copies_ += copies;
    extra_copies_ -= std::min<std::uint64_t>(extra_copies_, present_.size());  // those beyond the first of each box
    initial_pairs_ = 0;
    new_index_.resize(old_.size());
    copy_or_rebuild(boxes, /*old=*/0, /*depth=*/0);
    for (std::uint32_t& start : start_nodes_) start = new_index_[start];
    stale_roots_.clear();
}

/// Appends a copy of the old subtree at `old`, with its stale subtrees rebuilt. `new_index_` gets the new index of each
/// old node; for those of a rebuilt subtree, that of its root.
void kd_tree_partition::copy_or_rebuild(std::span<const box> boxes, std::uint32_t old, std::size_t depth) {
    const auto self = static_cast<std::uint32_t>(nodes_.size());
    const auto root = std::ranges::lower_bound(stale_roots_, old);
    if (root != stale_roots_.end() && *root == old) {  // a subtree to rebuild
        const auto r = static_cast<std::size_t>(root - stale_roots_.begin());
        // Copy its boxes to the top of the stack: building overwrites what is above them, which is still needed.
        const std::size_t first = ids_.size();
        const std::size_t count = boxes_end_[r] - boxes_begin_[r];
        ids_.resize(first + count);
        std::copy_n(ids_.begin() + static_cast<std::ptrdiff_t>(boxes_begin_[r]), count,
                    ids_.begin() + static_cast<std::ptrdiff_t>(first));
        build_subtree(boxes, first, count, old_[old].cell, depth);
        ids_.resize(first);
        std::uint32_t last = old;  // becomes the last of its descendants, which follow it in preorder
        while (old_[last].axis != is_leaf) last = old_[last].children[1];
        std::fill(new_index_.begin() + old, new_index_.begin() + last + 1, self);
        return;
    }
    new_index_[old] = self;
    nodes_.push_back(old_[old]);
    if (old_[old].axis == is_leaf) {
        nodes_[self].children[0] = leaves_++;
        return;
    }
    nodes_[self].children[0] = self + 1;
    copy_or_rebuild(boxes, old_[old].children[0], depth + 1);
    nodes_[self].children[1] = static_cast<std::uint32_t>(nodes_.size());
    copy_or_rebuild(boxes, old_[old].children[1], depth + 1);
}

/// Appends to `nodes_` a subtree of the boxes ids_[first .. first + count), the top of the stack `ids_`: a single leaf
/// if no split is cheaper, or else a node, for whose children the boxes are pushed onto the stack.
/// @param cell the half-open region of the root
void kd_tree_partition::build_subtree(std::span<const box> boxes, std::size_t first, std::size_t count, const box& cell,
                                      std::size_t depth) {
    const std::size_t self = nodes_.size();
    ++built_nodes_;
    nodes_.push_back({.cell = cell, .plane = 0, .axis = is_leaf, .children = {leaves_, 0}, .initial_copies = unknown});
    if (count >= 2 && depth < most_depth) {
        const split at = best_split(boxes, first, count);
        std::array<std::size_t, 2> counts{};
        if (at.axis != is_leaf && divide(boxes, first, count, at, counts)) {
            nodes_[self].plane = at.plane;
            nodes_[self].axis = at.axis;
            const std::size_t right = first + count;
            const std::size_t left = right + counts[1];  // on top of the stack, so built and removed first
            std::array<box, 2> cells{cell, cell};
            // Boxes may have left the cell of a stale node, so the plane may lie outside.
            const auto k = static_cast<int>(at.axis);
            cells[0].max[k] = std::min(at.plane, cell.max[k]);
            cells[1].min[k] = std::max(at.plane, cell.min[k]);
            nodes_[self].children[0] = static_cast<std::uint32_t>(nodes_.size());
            build_subtree(boxes, left, counts[0], cells[0], depth + 1);
            nodes_[self].children[1] = static_cast<std::uint32_t>(nodes_.size());
            ids_.resize(left);
            build_subtree(boxes, right, counts[1], cells[1], depth + 1);
            ids_.resize(right);
            return;
        }
    }
    ++leaves_;
}

/// Splits the `count` boxes from `first` at a plane: pushes those right of it, then those left of it, onto the stack of
/// ids. Boxes on the plane are copied to both sides. `counts` are left, right.
/// @returns false, with the stack as before, if one side has all boxes or the copies are too many
bool kd_tree_partition::divide(std::span<const box> boxes, std::size_t first, std::size_t count, const split& at,
                               std::array<std::size_t, 2>& counts) {
    const std::size_t end = first + count;
    ids_.resize(end + 2 * count);
    // The left side grows downwards from the end of the range, so that either side may have any length.
    std::size_t right = end;
    std::size_t left = ids_.size();
    for (std::size_t i = first; i < end; ++i) {
        const std::uint32_t id = ids_[i];
        ids_[right] = id;
        right += lies_right(boxes[id], at.axis, at.plane);
        ids_[left - 1] = id;
        left -= lies_left(boxes[id], at.axis, at.plane);
    }
    counts = {ids_.size() - left, right - end};
    const std::uint64_t copies = counts[0] + counts[1] - count;
    const bool separates = counts[0] < count && counts[1] < count;
    // If the leaf size is configured, no cost has been compared, so a plane through most boxes is rejected here.
    const bool is_worth_it = !config_.leaf || 2 * copies <= count;
    if (!separates || !is_worth_it || extra_copies_ + copies > (most_copies - 1) * present_.size()) {
        ids_.resize(end);
        return false;
    }
    extra_copies_ += copies;
    // Restore ascending order of ids.
    std::reverse(ids_.begin() + static_cast<std::ptrdiff_t>(left), ids_.end());
    std::copy(ids_.begin() + static_cast<std::ptrdiff_t>(left), ids_.end(),
              ids_.begin() + static_cast<std::ptrdiff_t>(right));
    ids_.resize(right + counts[0]);
    return true;
}

/// The cheapest split of the boxes ids_[first .. first + count), at the median of a sample's centres on an axis. The
/// axis is `is_leaf` if no split is cheaper, or the configured leaf size is not exceeded.
kd_tree_partition::split kd_tree_partition::best_split(std::span<const box> boxes, std::size_t first,
                                                       std::size_t count) const {
    constexpr double never = std::numeric_limits<double>::infinity();
    const sampled sample(boxes, std::span(ids_).subspan(first, count));
    const double scale = static_cast<double>(count) / static_cast<double>(sample.n);
    split best{.axis = is_leaf, .plane = 0, .cost = never};  // with a configured leaf size, any split is cheaper
    if (!config_.leaf) best.cost = sample.cost(static_cast<double>(count), sample.bounds, swept_);
    if (config_.leaf && count <= *config_.leaf) return best;
    for (std::uint32_t axis = 0; axis < 3; ++axis) {
        const auto k = static_cast<int>(axis);
        const float plane = sample.median(k);
        std::size_t left = 0, right = 0;
        for (std::size_t i = 0; i < sample.n; ++i) {
            left += lies_left(*sample.boxes[i], axis, plane);
            right += lies_right(*sample.boxes[i], axis, plane);
        }
        if (left == sample.n || right == sample.n) continue;
        std::array<box, 2> within{sample.bounds, sample.bounds};
        within[0].max[k] = within[1].min[k] = plane;
        const double cost = sample.cost(scale * static_cast<double>(left), within[0], swept_) +
                            sample.cost(scale * static_cast<double>(right), within[1], swept_);
        if (cost < best.cost) best = {axis, plane, cost};
    }
    return best;
}

/// Finds the leaves that each box overlaps. The search starts at the lowest node that contained the box in the last
/// frame, if it still does. The entries of box `id` are entries_[starts_[id] .. starts_[id + 1]).
/// @returns false if there are too many copies, which requires a full rebuild
bool kd_tree_partition::place_boxes(std::span<const box> boxes) {
    const std::size_t most = 2 * most_copies * present_.size();
    starts_.resize(boxes.size() + 1);
    start_nodes_.resize(boxes.size(), 0);
    copies_in_leaf_.assign(leaves_, 0);
    entries_.clear();
    std::size_t next = 0;  // next element of starts_
    for (const std::uint32_t id : present_) {
        const box& b = boxes[id];
        while (next <= id) starts_[next++] = static_cast<std::uint32_t>(entries_.size());
        start_nodes_[id] = place_box(b, lies_within(b, nodes_[start_nodes_[id]].cell) ? start_nodes_[id] : 0);
        if (entries_.size() > most) return false;
    }
    while (next <= boxes.size()) starts_[next++] = static_cast<std::uint32_t>(entries_.size());
    return true;
}

/// Adds entries for all leaves that a box overlaps below node `from`. Bits mark the axes on which the box's lower end
/// lies in the leaf: of two boxes' common leaves, the one where each axis is set for one of them reports the pair.
/// @returns the lowest node whose cell contains the box
inline std::uint32_t kd_tree_partition::place_box(const box& b, std::uint32_t from) {
    struct waiting {
        std::uint32_t at;
        axis_set owned;
    };
    std::array<waiting, most_depth> stack;
    std::size_t height = 0;
    std::uint32_t lowest = unknown;
    axis_set owned = every_axis;
    for (std::uint32_t at = from;;) {
        const node* n = &nodes_[at];
        for (; n->axis != is_leaf; n = &nodes_[at]) {
            const bool left = lies_left(b, n->axis, n->plane);
            if (left && lies_right(b, n->axis, n->plane)) {
                lowest = std::min(lowest, at);
                // The lower end lies on the left, so the right child does not own it.
                stack[height++] = {.at = n->children[1], .owned = owned & ~(axis_set{1} << n->axis)};
            }
            // Branch-free, since the side is hard to predict.
            at = n->children[static_cast<std::size_t>(!left)];
        }
        entries_.push_back(n->children[0] << 3 | owned);
        ++copies_in_leaf_[n->children[0]];
        // In preorder, descendants have greater indices.
        lowest = std::min(lowest, at);
        if (height == 0) return lowest;
        at = stack[--height].at;
        owned = stack[height].owned;
    }
}

/// Counts the copies below each node, and collects the roots of subtrees to rebuild, whose number has much changed.
void kd_tree_partition::find_stale_nodes() {
    copies_below_.resize(nodes_.size());
    for (std::size_t at = nodes_.size(); at-- > 0;) {
        node& n = nodes_[at];
        copies_below_[at] = n.axis == is_leaf ? copies_in_leaf_[n.children[0]]
                                              : copies_below_[n.children[0]] + copies_below_[n.children[1]];
        if (n.initial_copies == unknown) n.initial_copies = copies_below_[at];
    }
    // The cost of searching the leaves grows with this sum: if it has doubled, `fit` does not wait for the next frame.
    pairs_ = 0;
    for (const std::uint32_t copies : copies_in_leaf_) pairs_ += static_cast<double>(copies) * copies;
    if (initial_pairs_ == 0) initial_pairs_ = pairs_;  // the tree was just built
    stale_roots_.clear();
    // A stale node is rebuilt from its parent, but the root has none.
    if (is_stale(0))
        stale_roots_.push_back(0);
    else
        collect_stale_roots(0);
}

/// Whether a node is stale: its number of copies has more than doubled or halved, with a tolerance for small numbers.
bool kd_tree_partition::is_stale(std::uint32_t at) const noexcept {
    const std::uint64_t current = copies_below_[at];
    const std::uint64_t initial = nodes_[at].initial_copies;
    return current > 2 * initial + 16 || 2 * current + 16 < initial;
}

/// Collects the roots to rebuild: the lowest nodes not stale with a stale child, so that they redistribute boxes.
void kd_tree_partition::collect_stale_roots(std::uint32_t at) {
    if (nodes_[at].axis == is_leaf) return;
    const auto [left, right] = nodes_[at].children;
    if (is_stale(left) || is_stale(right)) {
        stale_roots_.push_back(at);
        return;
    }
    collect_stale_roots(left);
    collect_stale_roots(right);
}

/// The first or the last leaf below a node.
std::uint32_t kd_tree_partition::outermost_leaf(std::uint32_t at, std::size_t side) const noexcept {
    while (nodes_[at].axis != is_leaf) at = nodes_[at].children[side];
    return nodes_[at].children[0];
}

/// Lists the boxes below each stale root r, ascending by id, in ids_[boxes_begin_[r] .. boxes_end_[r]). Entries of a
/// box ascend by leaf, so that comparison with the last root lists it once.
void kd_tree_partition::collect_stale_boxes() {
    root_of_leaf_.assign(leaves_, 0);
    boxes_begin_.resize(stale_roots_.size());
    boxes_end_.resize(stale_roots_.size());
    std::size_t total = 0;
    for (std::size_t r = 0; r < stale_roots_.size(); ++r) {
        boxes_begin_[r] = boxes_end_[r] = total;
        total += copies_below_[stale_roots_[r]];  // room for all: a box has at least one copy
        const std::uint32_t last = outermost_leaf(stale_roots_[r], /*side=*/1);
        for (std::uint32_t leaf = outermost_leaf(stale_roots_[r], /*side=*/0); leaf <= last; ++leaf)
            root_of_leaf_[leaf] = static_cast<std::uint32_t>(r) + 1;
    }
    ids_.resize(total);
    for (const std::uint32_t id : present_) {
        // Boxes inserted since the last frame have no leaves yet.
        if (std::size_t{id} + 1 >= starts_.size()) break;
        std::uint32_t last = 0;
        for (std::uint32_t i = starts_[id]; i < starts_[id + 1]; ++i) {
            const std::uint32_t root = root_of_leaf_[entries_[i] >> 3];
            if (root != 0 && root != last) ids_[boxes_end_[root - 1]++] = id;
            last = root;
        }
    }
}

}  // namespace aabb
