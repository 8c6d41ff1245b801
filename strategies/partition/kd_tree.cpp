module;
#include <cassert>

module aabb.partition.kd_tree;

import aabb.costs;

// Sums and products as they are written: see aabb.base:floating_point.
#pragma clang fp contract(off) reassociate(off) reciprocal(off)

namespace aabb {

namespace {

/// As many boxes of a node as its split is chosen by.
constexpr std::size_t most_sampled = 128;

/// Half of each, so that nothing overflows.
float centre_of(const box& b, int k) {
    return b.min[k] / 2 + b.max[k] / 2;
}

/// What the boxes of a node are like, from a sample.
struct sampled {
    std::array<const box*, most_sampled> boxes;
    std::size_t n = 0;
    box bounds = empty_box();
    vec3d extent{};  // mean

    sampled(std::span<const box> all, std::span<const std::uint32_t> ids) {
        const std::size_t step = (ids.size() + most_sampled - 1) / most_sampled;
        for (std::size_t i = 0; i < ids.size(); i += step) {
            const box& b = all[ids[i]];
            boxes[n++] = &b;
            bounds = merged(bounds, b);
            for (int k = 0; k < 3; ++k) extent[k] += double{b.max[k]} - double{b.min[k]};
        }
        for (int k = 0; k < 3; ++k) extent[k] /= static_cast<double>(n);
    }

    [[nodiscard]] float median(int k) const {
        std::array<float, most_sampled> centres;
        for (std::size_t i = 0; i < n; ++i) centres[i] = centre_of(*boxes[i], k);
        const auto middle = centres.begin() + static_cast<std::ptrdiff_t>(n / 2);
        std::nth_element(centres.begin(), middle, centres.begin() + static_cast<std::ptrdiff_t>(n));
        return *middle;
    }

    /// Of a subset of so many of these boxes within bounds: entries, and tests of a sweep along the best of its axes.
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

/// Of a half-open cell.
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

axis_set kd_tree_partition::axes(std::span<const box> boxes, const membership& objects, axis_set swept) {
    // Another axis to sweep along makes other splits cheap.
    is_whole_ &= swept == swept_;
    swept_ = swept;
    present_.clear();
    for (std::uint32_t id = 0; id < boxes.size(); ++id)
        if (objects.contains(id)) present_.push_back(id);
    return 0;
}

void kd_tree_partition::fit(const whole_subset& all) {
    made_nodes_ = 0;
    // Whatever is thrown on the way, the next frame starts from nothing.
    if (!std::exchange(is_whole_, false))
        choose_all(all.boxes);
    else if (!groups_.empty())
        choose_stale(all.boxes);
    [[maybe_unused]] bool placed = place(all.boxes);
    if (!placed) {
        choose_all(all.boxes);
        placed = place(all.boxes);
    }
    compare();
    // Few nodes went off and can wait for the next frame, which then need not look for its boxes twice; but what makes
    // this one much dearer cannot.
    if (!groups_.empty() && pairs_ > 2 * pairs_at_first_) {
        choose_stale(all.boxes);
        placed = place(all.boxes);
        compare();
    }
    assert(placed);
    is_whole_ = true;
}

std::size_t kd_tree_partition::bytes() const noexcept {
    return bytes_of(present_, nodes_, starts_, entries_, homes_, now_at_, in_leaf_, below_, old_, groups_, group_of_,
                    group_starts_, group_ends_, ids_);
}

/// All planes, whatever there was.
void kd_tree_partition::choose_all(std::span<const box> boxes) {
    nodes_.clear();
    leaves_ = 0;
    groups_.clear();
    copied_ = 0;
    pairs_at_first_ = 0;
    ids_ = present_;
    homes_.clear();
    choose(boxes, 0, ids_.size(), {empty_box().max, empty_box().min}, 0);
}

/// Those below the nodes that went off, for the boxes that were in them.
void kd_tree_partition::choose_stale(std::span<const box> boxes) {
    gather();
    old_.swap(nodes_);
    nodes_.clear();
    leaves_ = 0;
    copied_ = 0;
    for (const std::uint32_t copies : in_leaf_) copied_ += copies;
    copied_ -= std::min<std::uint64_t>(copied_, present_.size());
    pairs_at_first_ = 0;
    now_at_.resize(old_.size());
    copy_or_choose(boxes, 0, 0);
    for (std::uint32_t& home : homes_) home = now_at_[home];
    groups_.clear();
}

void kd_tree_partition::copy_or_choose(std::span<const box> boxes, std::uint32_t old, std::size_t depth) {
    const auto self = static_cast<std::uint32_t>(nodes_.size());
    const auto group = std::ranges::lower_bound(groups_, old);
    if (group != groups_.end() && *group == old) {
        const auto g = static_cast<std::size_t>(group - groups_.begin());
        // Behind all groups: these are not to be written over yet.
        const std::size_t first = ids_.size();
        const std::size_t count = group_ends_[g] - group_starts_[g];
        ids_.resize(first + count);
        std::copy_n(ids_.begin() + static_cast<std::ptrdiff_t>(group_starts_[g]), count,
                    ids_.begin() + static_cast<std::ptrdiff_t>(first));
        choose(boxes, first, count, old_[old].cell, depth);
        ids_.resize(first);
        std::uint32_t last = old;
        while (old_[last].axis != is_leaf) last = old_[last].children[1];
        std::fill(now_at_.begin() + old, now_at_.begin() + last + 1, self);
        return;
    }
    now_at_[old] = self;
    nodes_.push_back(old_[old]);
    if (old_[old].axis == is_leaf) {
        nodes_[self].children[0] = leaves_++;
        return;
    }
    nodes_[self].children[0] = self + 1;
    copy_or_choose(boxes, old_[old].children[0], depth + 1);
    nodes_[self].children[1] = static_cast<std::uint32_t>(nodes_.size());
    copy_or_choose(boxes, old_[old].children[1], depth + 1);
}

/// A node and all below it, for the boxes ids_[first .. first + count).
void kd_tree_partition::choose(std::span<const box> boxes, std::size_t first, std::size_t count, const box& cell,
                               std::size_t depth) {
    const std::size_t self = nodes_.size();
    ++made_nodes_;
    nodes_.push_back({cell, 0, is_leaf, {leaves_, 0}, unknown});
    if (count >= 2 && depth < most_depth) {
        const split at = best_split(boxes, first, count);
        std::array<std::size_t, 2> parts{};
        if (at.axis != is_leaf && divide(boxes, first, count, at, parts)) {
            nodes_[self].plane = at.plane;
            nodes_[self].axis = at.axis;
            const std::size_t right = first + count;
            const std::size_t left = right + parts[1];
            std::array<box, 2> cells{cell, cell};
            // Boxes may have moved out of the cell since, and the plane lie beyond it.
            const auto k = static_cast<int>(at.axis);
            cells[0].max[k] = std::min(at.plane, cell.max[k]);
            cells[1].min[k] = std::max(at.plane, cell.min[k]);
            nodes_[self].children[0] = static_cast<std::uint32_t>(nodes_.size());
            choose(boxes, left, parts[0], cells[0], depth + 1);
            nodes_[self].children[1] = static_cast<std::uint32_t>(nodes_.size());
            ids_.resize(left);
            choose(boxes, right, parts[1], cells[1], depth + 1);
            ids_.resize(right);
            return;
        }
    }
    ++leaves_;
}

/// Puts the boxes right of a plane, then those left of it, behind the ones at hand.
/// @returns false where that makes too many copies, or one side has them all
bool kd_tree_partition::divide(std::span<const box> boxes, std::size_t first, std::size_t count, const split& at,
                               std::array<std::size_t, 2>& parts) {
    const std::size_t end = first + count;
    ids_.resize(end + 2 * count);
    // The left ones from the back of this room, so that either may be any number.
    std::size_t right = end;
    std::size_t left = ids_.size();
    for (std::size_t i = first; i < end; ++i) {
        const std::uint32_t id = ids_[i];
        ids_[right] = id;
        right += lies_right(boxes[id], at.axis, at.plane);
        ids_[left - 1] = id;
        left -= lies_left(boxes[id], at.axis, at.plane);
    }
    parts = {ids_.size() - left, right - end};
    const std::uint64_t copies = parts[0] + parts[1] - count;
    const bool splits = parts[0] < count && parts[1] < count &&
                        copied_ + copies <= (most_copies - 1) * present_.size() &&
                        (!config_.leaf || 2 * copies <= count);
    if (!splits) {
        ids_.resize(end);
        return false;
    }
    copied_ += copies;
    // In the order of ids again.
    std::reverse(ids_.begin() + static_cast<std::ptrdiff_t>(left), ids_.end());
    std::copy(ids_.begin() + static_cast<std::ptrdiff_t>(left), ids_.end(),
              ids_.begin() + static_cast<std::ptrdiff_t>(right));
    ids_.resize(right + parts[0]);
    return true;
}

kd_tree_partition::split kd_tree_partition::best_split(std::span<const box> boxes, std::size_t first,
                                                       std::size_t count) const {
    constexpr double never = std::numeric_limits<double>::infinity();
    const sampled sample(boxes, std::span(ids_).subspan(first, count));
    const double each = static_cast<double>(count) / static_cast<double>(sample.n);
    split best{is_leaf, 0, config_.leaf ? never : sample.cost(static_cast<double>(count), sample.bounds, swept_)};
    if (config_.leaf && count <= *config_.leaf) return best;
    for (std::uint32_t axis = 0; axis < 3; ++axis) {
        const auto k = static_cast<int>(axis);
        const float plane = sample.median(k);
        std::size_t left = 0;
        std::size_t right = 0;
        for (std::size_t i = 0; i < sample.n; ++i) {
            left += lies_left(*sample.boxes[i], axis, plane);
            right += lies_right(*sample.boxes[i], axis, plane);
        }
        if (left == sample.n || right == sample.n) continue;
        std::array<box, 2> within{sample.bounds, sample.bounds};
        within[0].max[k] = within[1].min[k] = plane;
        const double cost = sample.cost(each * static_cast<double>(left), within[0], swept_) +
                            sample.cost(each * static_cast<double>(right), within[1], swept_);
        if (cost < best.cost) best = {axis, plane, cost};
    }
    return best;
}

/// Finds the leaves of all boxes.
/// @returns false when these would be too many, and most boxes lie in leaves in which they did not
bool kd_tree_partition::place(std::span<const box> boxes) {
    const std::size_t most = 2 * most_copies * present_.size();
    starts_.resize(boxes.size() + 1);
    homes_.resize(boxes.size(), 0);
    in_leaf_.assign(leaves_, 0);
    entries_.clear();
    std::size_t next = 0;  // of starts_
    for (const std::uint32_t id : present_) {
        const box& b = boxes[id];
        while (next <= id) starts_[next++] = static_cast<std::uint32_t>(entries_.size());
        homes_[id] = put(b, lies_within(b, nodes_[homes_[id]].cell) ? homes_[id] : 0);
        if (entries_.size() > most) return false;
    }
    while (next <= boxes.size()) starts_[next++] = static_cast<std::uint32_t>(entries_.size());
    return true;
}

/// Into every leaf that it reaches into below a node whose cell holds all of the box.
/// @returns the lowest such node
inline std::uint32_t kd_tree_partition::put(const box& b, std::uint32_t from) {
    struct waiting {
        std::uint32_t at;
        axis_set owned;
    };
    std::array<waiting, most_depth> stack;
    std::size_t height = 0;
    std::uint32_t home = unknown;
    axis_set owned = every_axis;
    for (std::uint32_t at = from;;) {
        const node* n = &nodes_[at];
        for (; n->axis != is_leaf; n = &nodes_[at]) {
            const bool left = lies_left(b, n->axis, n->plane);
            if (left && lies_right(b, n->axis, n->plane)) {
                home = std::min(home, at);
                stack[height++] = {n->children[1], owned & ~(axis_set{1} << n->axis)};
            }
            // Which of them it is cannot be foreseen.
            at = n->children[static_cast<std::size_t>(!left)];
        }
        entries_.push_back(n->children[0] << 3 | owned);
        ++in_leaf_[n->children[0]];
        // Nodes below others have greater numbers.
        home = std::min(home, at);
        if (height == 0) return home;
        at = stack[--height].at;
        owned = stack[height].owned;
    }
}

/// Holds how many are where against how many there were when planes were chosen.
void kd_tree_partition::compare() {
    below_.resize(nodes_.size());
    for (std::size_t at = nodes_.size(); at-- > 0;) {
        node& n = nodes_[at];
        below_[at] = n.axis == is_leaf ? in_leaf_[n.children[0]] : below_[n.children[0]] + below_[n.children[1]];
        if (n.at_first == unknown) n.at_first = below_[at];
    }
    pairs_ = 0;
    for (const std::uint32_t copies : in_leaf_) pairs_ += static_cast<double>(copies) * copies;
    if (pairs_at_first_ == 0) pairs_at_first_ = pairs_;
    groups_.clear();
    if (is_off(0))
        groups_.push_back(0);
    else
        mark(0);
}

/// More than twice as many as at first, or less than half; a few more or less are chance.
bool kd_tree_partition::is_off(std::uint32_t at) const noexcept {
    const std::uint64_t now = below_[at];
    const std::uint64_t before = nodes_[at].at_first;
    return now > 2 * before + 16 || 2 * now + 16 < before;
}

/// A node that is as it was with a child that is not can divide its boxes anew between its children.
void kd_tree_partition::mark(std::uint32_t at) {
    if (nodes_[at].axis == is_leaf) return;
    const auto [left, right] = nodes_[at].children;
    if (is_off(left) || is_off(right)) {
        groups_.push_back(at);
        return;
    }
    mark(left);
    mark(right);
}

/// The first or the last leaf below a node.
std::uint32_t kd_tree_partition::leaf_of(std::uint32_t at, std::size_t side) const noexcept {
    while (nodes_[at].axis != is_leaf) at = nodes_[at].children[side];
    return nodes_[at].children[0];
}

/// The boxes of each group, in the order of ids. The leaves of a box rise, so those of a group follow each other.
void kd_tree_partition::gather() {
    group_of_.assign(leaves_, 0);
    group_starts_.resize(groups_.size());
    group_ends_.resize(groups_.size());
    std::size_t room = 0;
    for (std::size_t g = 0; g < groups_.size(); ++g) {
        group_starts_[g] = group_ends_[g] = room;
        room += below_[groups_[g]];
        const std::uint32_t last = leaf_of(groups_[g], 1);
        for (std::uint32_t leaf = leaf_of(groups_[g], 0); leaf <= last; ++leaf)
            group_of_[leaf] = static_cast<std::uint32_t>(g) + 1;
    }
    ids_.resize(room);
    for (const std::uint32_t id : present_) {
        // One that came since has no leaves.
        if (std::size_t{id} + 1 >= starts_.size()) break;
        std::uint32_t last = 0;
        for (std::uint32_t i = starts_[id]; i < starts_[id + 1]; ++i) {
            const std::uint32_t group = group_of_[entries_[i] >> 3];
            if (group != 0 && group != last) ids_[group_ends_[group - 1]++] = id;
            last = group;
        }
    }
}

}  // namespace aabb
