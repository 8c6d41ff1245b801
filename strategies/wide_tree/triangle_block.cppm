export module aabb.wide_tree.triangle_block;

import aabb.std;
export import aabb.wide_tree.wide_node;

export namespace aabb {

/// The triangles of a leaf as a structure of arrays, padded to eight with the last triangle.
struct triangle_block {
    static constexpr std::size_t width = eight_boxes::most;
    using row = std::array<float, width>;

    alignas(32) std::array<std::array<row, 3>, 3> corner;  ///< corner c, axis k: [c][k]
    std::uint32_t triangles;

    /// Loads the triangles in the mesh's own frame.
    template <WideTreePolicy Tree>
    void load(const mesh& m, const Tree& tree, std::uint32_t leaf, const vertex_list& list) noexcept {
        load(m, tree, leaf, list, [](auto&) {});
    }

    /// Loads the triangles in A's frame: transformed in double and rounded to float.
    template <WideTreePolicy Tree>
    void load(const mesh& m, const Tree& tree, std::uint32_t leaf, const vertex_list& list,
              const relative_pose& to_a) noexcept {
        if (!to_a.moves()) return load(m, tree, leaf, list);
        load(m, tree, leaf, list, [&](columns& eight) {
            std::array<simd::eight_doubles, 3> x;
            for (std::size_t k = 0; k < 3; ++k) x[k] = __builtin_convertvector(eight[k], simd::eight_doubles);
            x = to_a.images(x);
            for (std::size_t k = 0; k < 3; ++k) eight[k] = __builtin_convertvector(x[k], simd::eight_floats);
        });
    }

    /// The triangles' boxes: rows of lower bounds along each axis, then of upper bounds.
    [[nodiscard]] inline std::array<simd::eight_floats, 6> bounds() const noexcept {
        const auto lesser = [](simd::eight_floats p, simd::eight_floats q) { return p < q ? p : q; };
        const auto greater = [](simd::eight_floats p, simd::eight_floats q) { return p > q ? p : q; };
        std::array<simd::eight_floats, 6> rows;
        for (std::size_t k = 0; k < 3; ++k) {
            const auto x = [&](std::size_t c) { return simd::load_eight<simd::eight_floats>(corner[c][k].data()); };
            rows[k] = lesser(lesser(x(0), x(1)), x(2));
            rows[3 + k] = greater(greater(x(0), x(1)), x(2));
        }
        return rows;
    }

    /// Sets bit i where the box of triangle i overlaps another one.
    [[nodiscard]] inline std::uint32_t triangles_in(const box& b) const noexcept {
        const std::array<simd::eight_floats, 6> rows = bounds();
        auto overlap = (rows[0] <= b.max[0]) & (rows[3] >= b.min[0]);
        for (int k = 1; k < 3; ++k) {
            const auto axis = static_cast<std::size_t>(k);
            overlap &= (rows[axis] <= b.max[k]) & (rows[3 + axis] >= b.min[k]);
        }
        return simd::bits_of_eight(overlap) & (0xffU >> (width - triangles));
    }

private:
    using columns = std::array<simd::eight_floats, 3>;

    /// Reads the leaf's distinct vertices, at most sixteen, transforms each once, and distributes them to corners by
    /// permutations: `list.positions[c]` has the positions of the triangles' corners c in the list.
    /// @param change transforms eight points, given as three vectors of coordinates
    template <class Tree, class Change>
    inline void load(const mesh& m, const Tree& tree, std::uint32_t leaf, const vertex_list& list,
                     Change change) noexcept {
        triangles = static_cast<std::uint32_t>(std::min(width, m.triangles.size() - width * leaf));
        if (list.count == 0) return load_from_mesh(m, tree, leaf, change);  // the leaf has no list
        const auto eight_from = [&](std::size_t first) __attribute__((always_inline)) {
            std::array<const float*, width> from;
            for (std::size_t i = 0; i < width; ++i) from[i] = m.vertices[list.vertices[first + i]].at;
            columns eight = simd::transpose_eight_points(from.data());
            change(eight);
            return eight;
        };
        const columns low = eight_from(0);
        const columns high = eight_from(width);
        for (std::size_t k = 0; k < 3; ++k) {
            // Joined in a register, since a wide load from two narrower stores stalls.
            const simd::sixteen_floats points = simd::joined(low[k], high[k]);
            for (std::size_t c = 0; c < 3; ++c)
                simd::store_eight(corner[c][k].data(), simd::select_eight_of_sixteen(points, list.positions[c]));
        }
    }

    /// Loads the triangles of a leaf without a vertex list, as it has more than sixteen vertices or the tree has no
    /// lists: corner by corner, so that a shared vertex is transformed several times.
    template <class Tree, class Change>
    void load_from_mesh(const mesh& m, const Tree& tree, std::uint32_t leaf, Change change) noexcept {
        std::array<const std::uint32_t*, width> vertices;
        for (std::uint32_t i = 0; i < width; ++i)
            vertices[i] = m.triangles[tree.triangle_at(width * leaf + std::min(i, triangles - 1))].data();
        for (std::size_t c = 0; c < 3; ++c) {
            std::array<const float*, width> points;
            for (std::size_t i = 0; i < width; ++i) points[i] = m.vertices[vertices[i][c]].at;
            columns eight = simd::transpose_eight_points(points.data());
            change(eight);
            for (std::size_t k = 0; k < 3; ++k) simd::store_eight(corner[c][k].data(), eight[k]);
        }
    }
};

/// The vertex indices of a leaf's triangles, padded to eight with the last triangle.
struct corner_indices {
    static constexpr std::size_t width = eight_boxes::most;

    alignas(32) std::array<std::array<std::uint32_t, width>, 3> vertex;  ///< by corner, then triangle

    template <WideTreePolicy Tree>
    void load(const mesh& m, const Tree& tree, std::uint32_t leaf) noexcept {
        const std::size_t last = m.triangles.size() - 1;
        for (std::size_t i = 0; i < width; ++i) {
            const auto in_order = static_cast<std::uint32_t>(std::min(width * leaf + i, last));
            for (std::size_t c = 0; c < 3; ++c) vertex[c][i] = m.triangles[tree.triangle_at(in_order)][c];
        }
    }

    /// Sets bit 8 j + i where triangle i of these and triangle j of the others share a corner.
    [[nodiscard]] inline std::uint64_t pairs_sharing_corners(const corner_indices& other) const noexcept {
        return simd::columns_with_shared_number(vertex[0].data(), other.vertex[0].data());
    }
};

}  // namespace aabb
