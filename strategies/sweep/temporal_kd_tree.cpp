module;
#include <cassert>
#include <ranges>

module aabb.sweep.temporal_kd_tree;

#pragma clang fp contract(off) reassociate(off) reciprocal(off)  // see aabb.base:floating_point

namespace aabb {

namespace {

constexpr box everywhere{.min = empty_box().max, .max = empty_box().min};  // infinite

/// Whether an open cell holds a box.
bool holds(const box& cell, const box& b) {
    unsigned inside = 1;
    for (int k = 0; k < 3; ++k)
        inside &= static_cast<unsigned>(b.min[k] > cell.min[k]) & static_cast<unsigned>(b.max[k] < cell.max[k]);
    return inside != 0;
}

/// -1 if a box lies strictly left of a plane, 1 if strictly right, 0 if the plane touches it.
int side_of(const box& b, std::uint32_t axis, float plane) {
    const auto k = static_cast<int>(axis);
    return static_cast<int>(b.min[k] > plane) - static_cast<int>(b.max[k] < plane);
}

double centre(const box& b, int k) {
    return (double{b.min[k]} + double{b.max[k]}) / 2;
}

/// Grows a box by a margin; bounds stay finite. Rounding leaves the box in the grown one, since it is monotone.
box grown(const box& b, float margin) {
    constexpr float most = std::numeric_limits<float>::max();
    box result = b;
    for (int k = 0; k < 3; ++k) {
        result.min[k] = std::max(b.min[k] - margin, -most);
        result.max[k] = std::min(b.max[k] + margin, most);
    }
    return result;
}

}  // namespace

std::size_t temporal_kd_tree_sweep::bytes() const noexcept {
    return bytes_of(grown_, is_static_, node_of_, order_, nodes_, free_, grown_pairs_, pairs_, listed_, placed_, above_,
                    list_, own_, from_above_);
}

/// Finds the boxes that have left their grown boxes, and grows them anew; puts arrivals to the root.
/// @returns false if all are static and none has come or gone
bool temporal_kd_tree_sweep::grow_moved(std::span<const box> boxes, const membership& objects) {
    if (nodes_.empty()) nodes_.push_back({.cell = everywhere});
    const vec3d extent = spread_of(boxes, objects).extent;
    const double mean = std::max({extent[0], extent[1], extent[2]});
    const auto margin = static_cast<float>(std::min(config_.margin * mean, double{std::numeric_limits<float>::max()}));
    bool has_changed = false;
    // Of a frame that has become smaller, the last objects have left. Pairs may still name them.
    for (std::size_t id = boxes.size(); id < node_of_.size(); ++id) {
        has_changed |= node_of_[id] != none;
        is_static_[id] = 0;
    }
    grown_.resize(boxes.size());
    node_of_.resize(boxes.size(), none);
    if (is_static_.size() < boxes.size()) is_static_.resize(boxes.size());
    std::size_t statics = 0;
    for (std::uint32_t id = 0; id < boxes.size(); ++id) {
        if (!objects.contains(id)) {
            has_changed |= node_of_[id] != none;
            node_of_[id] = none;
            is_static_[id] = 0;
            continue;
        }
        const bool is_known = node_of_[id] != none;
        is_static_[id] = is_known && contains(grown_[id], boxes[id]) ? 1 : 0;
        statics += is_static_[id];
        if (is_static_[id] != 0) continue;
        has_changed = true;
        grown_[id] = grown(boxes[id], margin);
        if (is_known) continue;
        node_of_[id] = 0;
        order_.push_back(id);
    }
    keeps_pairs_ = 2 * statics > objects.size();
    return has_changed;
}

/// Removes the pairs that the search will find again, and those of departed objects: all but those of static boxes.
void temporal_kd_tree_sweep::forget_pairs() {
    if (keeps_pairs_)
        std::erase_if(grown_pairs_, [this](index_pair p) { return is_static_[p.a] == 0 || is_static_[p.b] == 0; });
    else
        grown_pairs_.clear();
}

void temporal_kd_tree_sweep::update_tree() {
    place_moved();
    order_by_node();
    mend(/*at=*/0, /*depth=*/0);
    for (node& n : nodes_) n.own_moving = 0;
    for (const std::uint32_t id : order_)
        if (is_static_[id] == 0) ++nodes_[node_of_[id]].own_moving;
    list_nodes();
    for (const std::uint32_t at : std::views::reverse(listed_)) {  // children before their parents
        node& n = nodes_[at];
        n.moving = n.own_moving;
        if (n.axis != is_leaf) n.moving += nodes_[n.children[0]].moving + nodes_[n.children[1]].moving;
    }
}

/// Lists the nodes of the tree, parents before their children.
void temporal_kd_tree_sweep::list_nodes() {
    listed_.assign(1, 0);
    for (std::size_t i = 0; i < listed_.size(); ++i) {
        const node& n = nodes_[listed_[i]];
        if (n.axis != is_leaf) listed_.insert(listed_.end(), n.children.begin(), n.children.end());
    }
}

/// Moves each box that is not static up to the first node whose cell holds it, and down to the lowest one.
void temporal_kd_tree_sweep::place_moved() {
    for (std::uint32_t id = 0; id < node_of_.size(); ++id) {
        if (node_of_[id] == none || is_static_[id] != 0) continue;
        const box& b = grown_[id];
        std::uint32_t at = node_of_[id];
        while (!holds(nodes_[at].cell, b)) at = nodes_[at].parent;
        while (nodes_[at].axis != is_leaf) {
            const int side = side_of(b, nodes_[at].axis, nodes_[at].plane);
            if (side == 0) break;
            at = nodes_[at].children[side > 0 ? 1 : 0];
        }
        node_of_[id] = at;
    }
}

/// Orders the present objects by node in preorder, in each node as in the last frame, and counts them.
void temporal_kd_tree_sweep::order_by_node() {
    std::erase_if(order_, [this](std::uint32_t id) { return id >= node_of_.size() || node_of_[id] == none; });
    for (node& n : nodes_) n.own = 0;
    for (const std::uint32_t id : order_) ++nodes_[node_of_[id]].own;
    list_nodes();
    for (const std::uint32_t at : std::views::reverse(listed_)) {
        node& n = nodes_[at];
        n.population = n.own;
        if (n.axis != is_leaf) n.population += nodes_[n.children[0]].population + nodes_[n.children[1]].population;
    }
    nodes_[0].first = 0;
    for (const std::uint32_t at : listed_) {
        node& n = nodes_[at];
        if (n.axis != is_leaf) {
            nodes_[n.children[0]].first = n.first + n.own;
            nodes_[n.children[1]].first = n.first + n.own + nodes_[n.children[0]].population;
        }
        n.own = 0;  // counted again as they are placed
    }
    placed_.resize(order_.size());
    for (const std::uint32_t id : order_) {
        node& n = nodes_[node_of_[id]];
        placed_[n.first + n.own++] = id;
    }
    order_.swap(placed_);
}

/// Checks the subtree at a node from above, and settles the boxes of its parts that are badly divided.
void temporal_kd_tree_sweep::mend(std::uint32_t at, std::size_t depth) {
    const node n = nodes_[at];
    if (n.axis == is_leaf) {
        if (n.own > config_.leaf) settle(at, n.first, n.own, depth);
        return;
    }
    const division d{.cut = n.own, .left = nodes_[n.children[0]].population, .right = nodes_[n.children[1]].population};
    if (is_useless(d) || is_poor(d)) {
        settle(at, n.first, n.population, depth);
        return;
    }
    for (const std::uint32_t child : n.children) mend(child, depth + 1);
}

/// Places the boxes order_[first .. first + count), all those of the subtree at a node, in it from its root on, and
/// changes its planes where they divide them badly.
void temporal_kd_tree_sweep::settle(std::uint32_t at, std::size_t first, std::size_t count, std::size_t depth) {
    division d{};
    for (;;) {
        if (nodes_[at].axis == is_leaf) {
            d = {.cut = count, .left = 0, .right = 0};
            if (count <= config_.leaf || depth == most_depth) break;
            const centres c = centres_of(std::span(order_).subspan(first, count));
            const auto plane = static_cast<float>(c.mean[static_cast<int>(c.axis)]);
            const division halves = divide(first, count, c.axis, plane);
            if (halves.left == 0 || halves.right == 0) break;  // boxes that lie too close to be divided
            d = halves;
            const std::array<std::uint32_t, 2> children{take_node(), take_node()};
            nodes_[at].axis = c.axis;
            nodes_[at].plane = plane;
            nodes_[at].children = children;
            break;
        }
        const std::uint32_t axis = nodes_[at].axis;
        d = divide(first, count, axis, nodes_[at].plane);
        if (!is_useless(d) && is_poor(d)) {
            const centres c = centres_of(std::span(order_).subspan(first, count));
            nodes_[at].plane = static_cast<float>(c.mean[static_cast<int>(axis)]);
            d = divide(first, count, axis, nodes_[at].plane);
            if (!is_useless(d) && is_poor(d)) {
                replace_by_child(at, d.left > d.right ? 0 : 1);
                continue;
            }
        }
        if (!is_useless(d)) break;
        make_leaf(at);
    }
    node& n = nodes_[at];
    n.first = static_cast<std::uint32_t>(first);
    n.own = static_cast<std::uint32_t>(d.cut);
    n.population = static_cast<std::uint32_t>(count);
    for (std::size_t i = first; i < first + d.cut; ++i) node_of_[order_[i]] = at;
    if (n.axis == is_leaf) return;
    const auto [left, right] = n.children;
    const auto k = static_cast<int>(n.axis);
    for (const std::uint32_t child : {left, right}) {
        nodes_[child].cell = n.cell;
        nodes_[child].parent = at;
    }
    nodes_[left].cell.max[k] = nodes_[right].cell.min[k] = n.plane;
    settle(left, first + d.cut, d.left, depth + 1);
    settle(right, first + d.cut + d.left, d.right, depth + 1);
}

void temporal_kd_tree_sweep::make_leaf(std::uint32_t at) {
    for (const std::uint32_t child : nodes_[at].children) free_subtree(child);
    nodes_[at].axis = is_leaf;
}

/// Puts the subtree of a child, whose cell grows, in the place of a node, and frees the other child's.
void temporal_kd_tree_sweep::replace_by_child(std::uint32_t at, std::size_t side) {
    const std::uint32_t kept = nodes_[at].children[side];
    free_subtree(nodes_[at].children[1 - side]);
    nodes_[at].axis = nodes_[kept].axis;
    nodes_[at].plane = nodes_[kept].plane;
    nodes_[at].children = nodes_[kept].children;
    free_.push_back(kept);
}

void temporal_kd_tree_sweep::free_subtree(std::uint32_t at) {
    if (nodes_[at].axis != is_leaf)
        for (const std::uint32_t child : nodes_[at].children) free_subtree(child);
    free_.push_back(at);
}

std::uint32_t temporal_kd_tree_sweep::take_node() {
    if (free_.empty()) {
        nodes_.emplace_back();
        return static_cast<std::uint32_t>(nodes_.size() - 1);
    }
    const std::uint32_t taken = free_.back();
    free_.pop_back();
    nodes_[taken] = {};
    return taken;
}

/// Orders the boxes order_[first .. first + count) by their side of a plane: those that it touches, left, right.
temporal_kd_tree_sweep::division temporal_kd_tree_sweep::divide(std::size_t first, std::size_t count,
                                                                std::uint32_t axis, float plane) {
    placed_.resize(std::max(placed_.size(), count));
    division d{};
    for (std::size_t i = first; i < first + count; ++i) {
        const std::uint32_t id = order_[i];
        const int side = side_of(grown_[id], axis, plane);
        if (side == 0)
            order_[first + d.cut++] = id;
        else if (side < 0)
            placed_[d.left++] = id;
        else
            placed_[count - ++d.right] = id;
    }
    const std::span sides = std::span(order_).subspan(first + d.cut);
    for (std::size_t i = 0; i < d.left; ++i) sides[i] = placed_[i];
    for (std::size_t i = 0; i < d.right; ++i) sides[d.left + i] = placed_[count - 1 - i];
    return d;
}

/// Whether a node is not worth its plane: it has fewer boxes than a leaf may have, or none on one side.
bool temporal_kd_tree_sweep::is_useless(const division& d) const noexcept {
    return d.cut + d.left + d.right < config_.leaf || d.left == 0 || d.right == 0;
}

/// Whether a plane leaves too many pairs to test for its balance. Between 0, for the pairs of two halves, and 1, for
/// all pairs, their number must not exceed the share of the smaller side in what it is tested against.
bool temporal_kd_tree_sweep::is_poor(const division& d) noexcept {
    const auto cut = static_cast<double>(d.cut);
    const auto left = static_cast<double>(d.left);
    const auto right = static_cast<double>(d.right);
    const double all = cut + left + right;
    const double pairs = (cut * cut + left * left + right * right - all) / 2 + cut * (left + right);
    const double most = (all * all - all) / 2;
    const double least = all * all / 4 - all / 2;
    return (pairs - least) / (most - least) > std::min(left, right) / (std::max(left, right) + cut);
}

/// The mean of the boxes' centres, and the axis on which they vary most.
temporal_kd_tree_sweep::centres temporal_kd_tree_sweep::centres_of(std::span<const std::uint32_t> ids) const {
    vec3d origin{}, sum{}, squares{};  // relative to the first centre, so that no digits cancel far from the origin
    for (int k = 0; k < 3; ++k) origin[k] = centre(grown_[ids.front()], k);
    for (const std::uint32_t id : ids)
        for (int k = 0; k < 3; ++k) {
            const double x = centre(grown_[id], k) - origin[k];
            sum[k] += x;
            squares[k] += x * x;
        }
    const auto n = static_cast<double>(ids.size());
    centres result{};
    vec3d variance{};
    for (int k = 0; k < 3; ++k) {
        result.mean[k] = origin[k] + sum[k] / n;
        variance[k] = squares[k] - sum[k] / n * sum[k];
        if (variance[k] > variance[static_cast<int>(result.axis)]) result.axis = static_cast<std::uint32_t>(k);
    }
    return result;
}

}  // namespace aabb
