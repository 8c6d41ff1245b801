export module aabb.wide_tree.wide_node;

import aabb.std;
export import aabb.wide_tree.eight_boxes;
export import aabb.wide_tree.vertex_lists;

export namespace aabb {

/// A node with up to eight children in 64 bytes: their boxes, rounded outward to the node's own grid, as in the
/// compressed wide BVH (Ylitie, Karras and Laine, "Efficient incoherent ray traversal on GPUs", 2017).
///
/// Along axis k the grid has planes at i * 2^exponent[k] for integers i, and code q, from 1 to 254, means i = origin[k]
/// + q. Both are exact: |i| stays below 2^24, so that a plane within the range of float is a float.
struct wide_node {
    static constexpr std::size_t most_children = eight_boxes::most;
    static constexpr int last_code = 255;

    quantized_aabbs planes;
    std::array<std::int32_t, 3> origin;
    std::array<std::int8_t, 3> exponent;
    std::uint8_t children;

    void encode(std::span<const box> boxes) noexcept {
        children = static_cast<std::uint8_t>(boxes.size());
        for (int k = 0; k < 3; ++k) encode_axis(boxes, k);
        planes.keep_first(children);
    }

    [[nodiscard]] inline double step(std::size_t axis) const noexcept { return power_of_two(exponent[axis]); }
    /// The grid that maps a coordinate x to its code, x / 2^exponent - origin on each axis. Planes are exact and
    /// rounding is monotone: no coordinate is rounded past a plane.
    [[nodiscard]] inline code_grid grid() const noexcept {
        code_grid g;
        for (std::size_t k = 0; k < 3; ++k) {
            g.scale[k] = std::bit_cast<float>(static_cast<std::uint32_t>(127 - exponent[k]) << 23U);  // 2^-exponent
            g.offset[k] = static_cast<float>(origin[k]);
        }
        return g;
    }

    /// Sets bit i where the box of child i overlaps another one, and perhaps where it does not: floats are rounded to
    /// codes.
    [[nodiscard]] inline std::uint32_t children_in(const box& b) const noexcept { return planes.overlaps(grid(), b); }

    /// Decodes the box of child i. Upper codes are stored as 255 - code.
    [[nodiscard]] inline box child(std::size_t i) const noexcept {
        box b;
        for (int k = 0; k < 3; ++k) {
            const auto axis = static_cast<std::size_t>(k);
            b.min[k] = plane(axis, planes.lower[axis][i]);
            b.max[k] = plane(axis, last_code - planes.upper[axis][i]);
        }
        return b;
    }

private:
    static constexpr int least_exponent = -126;  // of normal floats
    static constexpr int origin_digits = 22;     // fewer than a float has, since codes are added

    /// The binary exponent of a positive number; that of 0 is below those of all floats.
    [[nodiscard]] static inline int power_of(double x) noexcept {
        return static_cast<int>(std::bit_cast<std::uint64_t>(x) >> 52U) - 1023;
    }
    [[nodiscard]] static inline double power_of_two(int exponent) noexcept {
        return std::bit_cast<double>(static_cast<std::uint64_t>(exponent + 1023) << 52U);
    }

    /// Encodes the boxes on axis k, rounded outward, on the finest grid on which all planes have codes from 1 to 254.
    /// The step of the grid is a power of two.
    void encode_axis(std::span<const box> boxes, int k) noexcept {
        // In double, products with powers of 2 are exact, and so are their integer parts.
        simd::eight_doubles least = simd::eight_doubles{} + boxes[0].min[k];
        simd::eight_doubles most = simd::eight_doubles{} + boxes[0].max[k];
        double low = boxes[0].min[k];
        double high = boxes[0].max[k];
        for (std::size_t i = 0; i < boxes.size(); ++i) {
            least[i] = boxes[i].min[k];
            most[i] = boxes[i].max[k];
            low = std::min(low, least[i]);
            high = std::max(high, most[i]);
        }
        // No finer grid has codes for all planes and is exact in float; the loop finds the finest that has.
        int power = std::max({power_of(high - low) - 8,
                              power_of(std::max(std::abs(low), std::abs(high))) - origin_digits, least_exponent});
        while (std::ceil(high * power_of_two(-power)) - std::floor(low * power_of_two(-power)) + 1 > last_code - 1)
            ++power;
        const double steps = power_of_two(-power);
        const double first = std::floor(low * steps) - 1;  // codes begin at 1
        const auto axis = static_cast<std::size_t>(k);
        origin[axis] = static_cast<std::int32_t>(first);
        exponent[axis] = static_cast<std::int8_t>(power);
        store_codes(planes.lower[axis], __builtin_elementwise_floor(least * steps) - first);
        store_codes(planes.upper[axis], last_code - (__builtin_elementwise_ceil(most * steps) - first));
    }

    static inline void store_codes(quantized_aabbs::row& to, simd::eight_doubles codes) noexcept {
        simd::store_eight(to.data(), simd::whole_bytes(__builtin_convertvector(codes, simd::eight_floats)));
    }

    [[nodiscard]] inline float plane(std::size_t axis, int code) const noexcept {
        constexpr double most = std::numeric_limits<float>::max();
        return static_cast<float>(std::clamp((origin[axis] + code) * step(axis), -most, most));
    }
};
static_assert(sizeof(wide_node) == 64);

/// A tree with eight children per node, stored level by level, for `batched_walk`. Child i of node n on level l is node
/// 8 n + i of level l - 1. On level 0 it is leaf 8 n + i, which has no node of its own and holds the triangles
/// 8 (8 n + i) to 8 (8 n + i) + 7 of the order, as far as they exist. The highest level has one node. All nodes are in
/// one array, level 0 first. A leaf's vertices come from the tree's vertex lists, if it has any. A tree that keeps
/// fronts keeps pairs of leaves from query to query (`bvtt_front`).
template <class T>
concept WideTreePolicy =
    TreePolicy<T> && requires(const T built, std::size_t level, std::uint32_t index, vertex_list& list) {
        { built.levels() } -> std::same_as<std::size_t>;
        { built.level(level) } -> std::same_as<const wide_node*>;
        { built.triangle_at(index) } -> std::same_as<std::uint32_t>;
        built.prefetch_vertices(index);
        built.prefetch_triangles(index);
        built.read_vertices(index, list);
        { built.keeps_fronts() } -> std::same_as<bool>;
    };

template <WideTreePolicy Tree>
[[nodiscard]] std::size_t nodes_of(const Tree& t) noexcept {
    return static_cast<std::size_t>(t.level(t.levels() - 1) - t.level(0)) + 1;
}

template <WideTreePolicy Tree>
[[nodiscard]] std::size_t leaves_of(const model<Tree>& m) noexcept {
    return (m.triangles().triangles.size() + vertex_lists::triangles - 1) / vertex_lists::triangles;
}

}  // namespace aabb
