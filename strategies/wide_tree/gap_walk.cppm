export module aabb.wide_tree.gap_walk;

import aabb.std;
import aabb.wide_tree.box_images;
export import aabb.wide_tree.leaf_reader;
export import aabb.wide_tree.level_steps;

export namespace aabb {

/// Descends two trees to pairs of triangles that are near each other, depth first, and if asked of the children of two
/// nodes to the nearest pair first. Gaps of boxes, and gaps along a preferred direction, are computed in float, eight
/// at a time, and are bounds from below. Once near points are known, the direction between them separates most other
/// triangles of smooth surfaces.
///
/// Planes of A's nodes are floats. Those of B's are rounded to float by 2^-24 of their magnitude, which is at most
/// twice that of B's box, with room for planes further out; images of triangles are off by `image_error`, along a
/// direction by at most the sum over the axes. A difference rounds by 2^-24 of both magnitudes, and heights along a
/// direction of length 1 at most by 2^-21 of the greatest coordinate: `slack_`, 2^-19 of it, covers all of this.
/// Squares and sums round by less than 2^-21 of the square, or below the normal numbers by 2^-148, which
/// `square_not_below` has room for.
template <WideTreePolicy Tree>
class gap_walk {
public:
    /// The greatest coordinate in A's frame, so that squares of gaps are in the range of float.
    static constexpr float most_coordinate = 0x1p60F;

    /// The squared bound with which squared gaps are compared: less only if the distance is more than d.
    [[nodiscard]] static double square_not_below(double d) noexcept { return d * d * (1 + 0x1p-18) + 0x1p-147; }

    /// Passes pairs of triangles whose squared distance in A's frame may be at most `limit()` to `visit`, until it
    /// returns true. The boxes of both meshes there are within `most_coordinate`.
    /// @param nearest_first whether near pairs come first, which takes longer if the limit stays
    /// @param limit as `square_not_below`; is read again for each pair of nodes, so that it may decrease meanwhile
    template <class Counters, class Limit, class Visit>
    void find(const model<Tree>& a, const model<Tree>& b, const relative_pose& to_a, bool nearest_first,
              Counters& counters, const Limit& limit, const Visit& visit) {
        begin(a, b, to_a);
        nearest_first_ = nearest_first;
        while (!pending_.empty()) {
            const node_pair p = pending_.back();
            pending_.pop_back();
            if (double{p.gap} > limit()) continue;
            counters.add(work::node_visits);
            if (p.step + 1 < steps_.size()) {
                open(a.tree(), b.tree(), p, counters, limit());
            } else if (visit_triangles(a, b, to_a, p, counters, limit, visit)) {
                return;
            }
        }
    }

    /// Sets the direction from A to B, in A's frame, along which gaps are computed until the end of the query.
    void prefer(const vec3d& direction) noexcept {
        const double length = std::sqrt(dot(direction, direction)) * (1 + 0x1p-20);
        const bool is_known = length > 0x1p-100 && length < 0x1p100;
        for (int k = 0; k < 3; ++k) direction_[k] = is_known ? static_cast<float>(direction[k] / length) : 0;
    }

    [[nodiscard]] std::size_t bytes() const noexcept {
        return steps_.bytes() + images_.bytes() + bytes_of(pending_, leaves_of_a_, leaves_of_b_);
    }

private:
    static constexpr std::size_t width = wide_node::most_children;
    static constexpr std::uint32_t children = wide_node::most_children;
    static constexpr std::uint32_t no_leaf = 0xffffffff;
    static constexpr std::uint32_t slots = 32;       // for leaves of each tree
    using rows = std::array<simd::eight_floats, 6>;  // lower bounds on each axis, then upper bounds

    struct node_pair {
        float gap;  ///< squared
        std::uint32_t step;
        std::uint32_t a, b;
    };
    /// Eight boxes with their heights along the preferred direction: the greatest of A's, the least of B's.
    struct extents {
        rows boxes;
        simd::eight_floats height;
        std::size_t count;
    };
    /// A pair 8 j + i of child i of A's node and j of B's, or of two triangles, with its squared gap.
    struct near_pair {
        float gap;
        std::uint32_t pair;
    };
    /// A leaf that was read, in the slot of its number modulo the number of slots.
    struct leaf {
        std::uint32_t number = no_leaf;
        triangle_block block;
        vertex_list vertices;
    };

    void begin(const model<Tree>& a, const model<Tree>& b, const relative_pose& to_a) {
        require_ieee_arithmetic();
        a.require_fit();
        b.require_fit();
        steps_.begin({a.tree().levels(), b.tree().levels()});
        images_.begin(b.tree().level(0), nodes_of(b.tree()), to_a.to_boxes());
        for (std::vector<leaf>* const leaves : {&leaves_of_a_, &leaves_of_b_}) {
            leaves->resize(slots);
            for (leaf& l : *leaves) l.number = no_leaf;
        }
        float greatest = 0;
        const box image = to_a(b.bounds());
        for (int k = 0; k < 3; ++k)
            for (const float x : {image.min[k], image.max[k], a.bounds().min[k], a.bounds().max[k]})
                greatest = std::max(greatest, std::abs(x));
        const vec3f& error = to_a.image_error();
        slack_ = 0x1p-19F * greatest + 0x1p-140F;
        leaf_slack_ = slack_ + (error[0] + error[1] + error[2]) * (1 + 0x1p-20F);
        vec3d between{};  // of the centres
        for (int k = 0; k < 3; ++k)
            between[k] = (double{image.min[k]} + double{image.max[k]}) / 2 -
                         (double{a.bounds().min[k]} + double{a.bounds().max[k]}) / 2;
        prefer(between);
        pending_.assign(1, {.gap = 0, .step = 0, .a = 0, .b = 0});
    }

    /// The squared gaps of eight boxes of A and box j of B.
    [[nodiscard, gnu::always_inline]] static inline simd::eight_floats gaps(const extents& of_a, const extents& of_b,
                                                                            std::size_t j, float slack) noexcept {
        const auto squared = [slack](simd::eight_floats gap) __attribute__((always_inline)) {
            gap -= slack;
            const simd::eight_floats positive = gap > 0.0F ? gap : simd::eight_floats{};
            return positive * positive;
        };
        simd::eight_floats sum{};
        for (std::size_t k = 0; k < 3; ++k) {
            const simd::eight_floats above = of_b.boxes[k][j] - of_a.boxes[3 + k];
            const simd::eight_floats below = of_a.boxes[k] - of_b.boxes[3 + k][j];
            sum += squared(above > below ? above : below);
        }
        const simd::eight_floats along = squared(of_b.height[j] - of_a.height);
        return along > sum ? along : sum;
    }

    /// Boxes with their greatest heights along the preferred direction, or if `sign` is negative their least ones.
    [[nodiscard]] extents reaching(const rows& boxes, float sign, std::size_t count) const noexcept {
        simd::eight_floats height{};
        for (std::size_t k = 0; k < 3; ++k) {
            const float along = direction_[static_cast<int>(k)];
            height += along * boxes[along * sign > 0 ? 3 + k : k];
        }
        return {boxes, height, count};
    }
    /// The same of triangles, whose heights may be within those of their boxes.
    [[nodiscard]] extents reaching(const triangle_block& block, float sign) const noexcept {
        simd::eight_floats height{};
        for (std::size_t c = 0; c < 3; ++c) {
            simd::eight_floats of_corner{};
            for (std::size_t k = 0; k < 3; ++k)
                of_corner += direction_[static_cast<int>(k)] *
                             simd::load_eight<simd::eight_floats>(block.corner[c][k].data()) * sign;
            height = c == 0 ? of_corner : (of_corner > height ? of_corner : height);
        }
        return {block.bounds(), height * sign, block.triangles};
    }

    /// The boxes of a node's children, which are exact.
    [[nodiscard]] static inline rows boxes_of(const wide_node& n) noexcept {
        rows boxes;
        const auto codes = [](const quantized_aabbs::row& r) {
            return __builtin_convertvector(simd::load_eight<simd::eight_bytes>(r.data()), simd::eight_floats);
        };
        for (std::size_t k = 0; k < 3; ++k) {
            const auto step = static_cast<float>(n.step(k)), origin = static_cast<float>(n.origin[k]);
            boxes[k] = (origin + codes(n.planes.lower[k])) * step;
            boxes[3 + k] = (origin + (255.0F - codes(n.planes.upper[k]))) * step;
        }
        return boxes;
    }
    [[nodiscard]] static inline rows rows_of(const eight_boxes& boxes) noexcept {
        rows bounds;
        for (std::size_t k = 0; k < 3; ++k) {
            bounds[k] = simd::load_eight<simd::eight_floats>(boxes.lower[k].data());
            bounds[3 + k] = simd::load_eight<simd::eight_floats>(boxes.upper[k].data());
        }
        return bounds;
    }

    /// The pairs that may be near enough, if asked in the order of their gaps; valid until the next call.
    [[nodiscard]] std::span<const near_pair> near_pairs(const extents& of_a, const extents& of_b, float slack,
                                                        double limit) noexcept {
        constexpr float infinity = std::numeric_limits<float>::infinity();
        const bool is_in_float = limit < double{std::numeric_limits<float>::max()};
        const float most = is_in_float ? std::nextafter(static_cast<float>(limit), infinity) : infinity;
        const std::uint32_t lanes_of_a = (1U << of_a.count) - 1;
        std::size_t count = 0;
        for (std::uint32_t j = 0; j < of_b.count; ++j) {
            const simd::eight_floats gap = gaps(of_a, of_b, j, slack);
            for (std::uint32_t rest = simd::bits_of_eight(gap <= most) & lanes_of_a; rest != 0; rest &= rest - 1) {
                const auto i = static_cast<std::uint32_t>(std::countr_zero(rest));
                near_[count++] = {gap[i], children * j + i};
            }
        }
        if (nearest_first_) std::ranges::sort(std::span(near_).first(count), {}, &near_pair::gap);
        return std::span(near_).first(count);
    }

    /// Pushes the pairs of children that are near enough, the nearest last. Of a node that is not opened, whose
    /// children bound it more closely than its box, the first child counts.
    template <class Counters>
    void open(const Tree& a, const Tree& b, const node_pair& p, Counters& counters, double limit) {
        const wide_node& node_a = a.level(steps_[p.step].a - 1)[p.a];
        const wide_node& node_b = b.level(steps_[p.step].b - 1)[p.b];
        counters.add(work::box_tests, std::uint64_t{node_a.children} * node_b.children);
        const bool opens_a = steps_.opens_a(p.step), opens_b = steps_.opens_b(p.step);
        const std::uint32_t opened_bits = (opens_a ? 7U : 0U) | (opens_b ? 7U << 3U : 0U);
        const std::size_t first = pending_.size();
        std::uint64_t pushed = 0;  // bit 8 j + i for the pairs of the next step
        for (const auto& [gap, pair] :
             near_pairs(reaching(boxes_of(node_a), 1, node_a.children),
                        reaching(rows_of(images_.of(node_b)), -1, node_b.children), slack_, limit)) {
            const std::uint32_t opened = pair & opened_bits;
            if ((pushed >> opened & 1U) != 0) continue;
            pushed |= std::uint64_t{1} << opened;
            // Without the order, the gap of another child may be less.
            const bool is_least = nearest_first_ || (opens_a && opens_b);
            pending_.push_back({.gap = is_least ? gap : 0.0F,
                                .step = p.step + 1,
                                .a = opens_a ? children * p.a + (opened & 7U) : p.a,
                                .b = opens_b ? children * p.b + (opened >> 3U) : p.b});
        }
        std::reverse(pending_.begin() + static_cast<std::ptrdiff_t>(first), pending_.end());
    }

    [[nodiscard]] static vec3d first_corner_of(const triangle_block& block) noexcept {
        return {block.corner[0][0][0], block.corner[0][1][0], block.corner[0][2][0]};
    }

    template <class... Frame>
    [[nodiscard]] static const triangle_block& read(std::vector<leaf>& leaves, const model<Tree>& m,
                                                    std::uint32_t number, const Frame&... frame) {
        leaf& into = leaves[number % slots];
        if (into.number != number) {
            m.tree().read_vertices(number, into.vertices);
            into.block.load(m.triangles(), m.tree(), number, into.vertices, frame...);
            into.number = number;
        }
        return into.block;
    }

    /// Passes the pairs of triangles of two leaves that are near enough to `visit`; returns whether it stopped.
    template <class Counters, class Limit, class Visit>
    [[nodiscard]] bool visit_triangles(const model<Tree>& a, const model<Tree>& b, const relative_pose& to_a,
                                       const node_pair& p, Counters& counters, const Limit& limit, const Visit& visit) {
        const triangle_block& of_a = read(leaves_of_a_, a, p.a);
        const triangle_block& of_b = read(leaves_of_b_, b, p.b, to_a);
        counters.add(work::box_tests, std::uint64_t{of_a.triangles} * of_b.triangles);
        // Without near points, a line through both leaves probably separates them, and those next to them.
        if (!nearest_first_) prefer(first_corner_of(of_b) - first_corner_of(of_a));
        for (const auto& [gap, pair] : near_pairs(reaching(of_a, 1), reaching(of_b, -1), leaf_slack_, limit())) {
            if (nearest_first_ && double{gap} > limit()) break;
            counters.add(work::triangle_tests);
            if (visit(a.tree().triangle_at(children * p.a + (pair & 7U)),
                      b.tree().triangle_at(children * p.b + (pair >> 3U))))
                return true;
        }
        return false;
    }

    level_steps steps_;
    image_cache images_;  // of nodes of B, in A's frame
    std::vector<node_pair> pending_;
    std::vector<leaf> leaves_of_a_, leaves_of_b_;
    std::array<near_pair, width * width> near_{};
    vec3f direction_{};
    float slack_ = 0, leaf_slack_ = 0;
    bool nearest_first_ = false;
};

}  // namespace aabb
