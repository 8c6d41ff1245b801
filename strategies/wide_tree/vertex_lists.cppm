export module aabb.wide_tree.vertex_lists;

export import aabb.local_detection;
import aabb.std;
export import aabb.wide_tree.kernels;

export namespace aabb {

/// The distinct vertices of a leaf of eight triangles.
struct vertex_list {
    static constexpr std::size_t most = 16;

    alignas(64) std::array<std::uint32_t, most> vertices;  ///< ascending, padded with the first
    std::array<std::uint32_t, 3> positions;                ///< by corner: 4 bits per triangle, padded with the last
    std::uint32_t count;                                   ///< 0 if the vertices must be read from the mesh

    /// Prefetches every second vertex, since neighbours mostly share a cache line.
    inline void prefetch(const mesh& m) const noexcept {
        if (count == 0) return;
        for (std::size_t i = 0; i < most; i += 2) __builtin_prefetch(&m.vertices[vertices[i]]);
    }
};

/// The distinct vertices of each leaf of eight triangles. Adjacent triangles share most of their corners, so that a
/// leaf reads some ten vertices instead of 24, transforms sixteen, and does not read the mesh's triangles at all.
///
/// Vertices ascend, so that accesses to adjacent memory follow each other. Few leaves, of scattered triangles, have
/// more than sixteen vertices: their lists are empty, and they are read from the mesh.
class vertex_lists {
public:
    static constexpr std::size_t triangles = balanced_order::leaf_triangles;

    vertex_lists() = default;
    /// Writes the list of each leaf. Threads take shares of `leaves_per_share` leaves, and write the lists of each
    /// share to a part of its own; the parts are concatenated afterwards, as lists differ in length. `begins_` has the
    /// byte at which the list of each leaf begins, at first within its part.
    /// @param order the mesh's triangles in the order of the leaves
    vertex_lists(const mesh& m, std::span<const std::uint32_t> order, worker_threads& workers) {
        // As many bytes per vertex index as the number of vertices needs.
        while (index_bytes_ < 4 && m.vertices.size() > std::uint64_t{1} << 8 * index_bytes_) ++index_bytes_;
        begins_.resize((order.size() + triangles - 1) / triangles);
        const std::size_t most_bytes_of_part = leaves_per_share * (header + index_bytes_ * vertex_list::most);
        std::vector<std::size_t> sizes((begins_.size() + leaves_per_share - 1) / leaves_per_share);
        large_vector<std::byte> parts(sizes.size() * most_bytes_of_part);
        const auto triangles_of = [&](std::size_t leaf) {
            const std::size_t begin = std::min(leaf * triangles, order.size());
            return order.subspan(begin, std::min(triangles, order.size() - begin));
        };
        workers.for_each_index(sizes.size(), [&](std::size_t p, std::size_t) {
            std::byte* const begin = &parts[p * most_bytes_of_part];
            std::byte* end = begin;
            for (std::size_t l = p * leaves_per_share; l < std::min(begins_.size(), (p + 1) * leaves_per_share); ++l) {
                for (const std::uint32_t t : triangles_of(l + ahead)) __builtin_prefetch(&m.triangles[t]);
                begins_[l] = static_cast<std::uint32_t>(end - begin);
                end = write_list(m, triangles_of(l), end);
            }
            sizes[p] = static_cast<std::size_t>(end - begin);
        });
        std::vector<std::size_t> offsets;
        std::size_t total = 0;
        for (const std::size_t size : sizes) offsets.push_back(std::exchange(total, total + size));
        if (total > most_bytes)
            throw input_error("vertex lists take at most 4 GiB; this mesh needs implicit:vertices=fetched");
        lists_.resize(total + read_beyond);
        std::fill(lists_.end() - read_beyond, lists_.end(), std::byte{});
        workers.for_each_index(sizes.size(), [&](std::size_t p, std::size_t) {
            std::memcpy(&lists_[offsets[p]], &parts[p * most_bytes_of_part], sizes[p]);
            for (std::size_t l = p * leaves_per_share; l < std::min(begins_.size(), (p + 1) * leaves_per_share); ++l)
                begins_[l] += static_cast<std::uint32_t>(offsets[p]);
        });
    }

    [[nodiscard]] inline bool empty() const noexcept { return begins_.empty(); }
    inline void prefetch(std::uint32_t leaf) const noexcept { __builtin_prefetch(&lists_[begins_[leaf]]); }
    inline void read(std::uint32_t leaf, vertex_list& to) const noexcept {
        const std::byte* at = &lists_[begins_[leaf]];
        to.count = static_cast<std::uint32_t>(*at);
        if (to.count == 0) return;
        std::memcpy(to.positions.data(), at + 1, sizeof to.positions);
        simd::unpack_sixteen(to.vertices.data(), at + header, index_bytes_, to.count);
    }

    /// Whether the list still has the corners of the leaf's triangles: a mesh may renumber its vertices.
    [[nodiscard]] bool matches(const mesh& m, std::uint32_t leaf,
                               std::span<const std::uint32_t> of_leaf) const noexcept {
        vertex_list list;
        read(leaf, list);
        if (list.count == 0) return true;  // vertices are read from the mesh
        bool same = true;
        for (std::size_t i = 0; i < of_leaf.size(); ++i)
            for (std::size_t c = 0; c < 3; ++c)
                same &= list.vertices[list.positions[c] >> 4 * i & 15U] == m.triangles[of_leaf[i]][c];
        return same;
    }

    [[nodiscard]] std::size_t bytes() const noexcept { return bytes_of(begins_, lists_); }

private:
    static constexpr std::size_t header = 1 + sizeof vertex_list::positions;
    static constexpr std::size_t read_beyond = 64;
    static constexpr std::size_t most_bytes = 0xffffffff;
    static constexpr std::size_t ahead = 4;                // leaves whose triangles are prefetched
    static constexpr std::size_t leaves_per_share = 1024;  // fewer are not worth another thread

    /// Writes the list of one leaf: one byte for the number of vertices, 0 if there are more than sixteen; for each
    /// corner, the positions of the eight triangles' vertices in the list, in 4 bits each; and the indices of the
    /// vertices, ascending.
    /// @param of_leaf the leaf's triangles, padded to eight by the last
    /// @returns the end of the list
    std::byte* write_list(const mesh& m, std::span<const std::uint32_t> of_leaf, std::byte* to) const {
        constexpr std::size_t corners = 3 * triangles;
        alignas(32) std::array<std::uint32_t, corners> vertices;
        for (std::size_t i = 0; i < triangles; ++i)
            std::ranges::copy(m.triangles[of_leaf[std::min(i, of_leaf.size() - 1)]], &vertices[3 * i]);
        const auto bits_where = [&](const auto& compare, std::uint32_t v) {
            std::uint32_t bits = 0;
            for (std::size_t eight = 0; eight < corners; eight += 8)
                bits |= simd::bits_of_eight(compare(simd::load_eight<simd::eight_words>(&vertices[eight]), v)) << eight;
            return bits;
        };
        // Finds all first occurrences before any position, so that no iteration depends on the previous one.
        std::array<std::uint8_t, corners> first;  // by corner: where its vertex occurs first
        std::uint32_t is_new = 0;
        for (std::size_t at = 0; at < corners; ++at) {
            const std::uint32_t same = bits_where([](auto x, std::uint32_t v) { return x == v; }, vertices[at]);
            first[at] = static_cast<std::uint8_t>(std::countr_zero(same));
            is_new |= same & -same;  // the first occurrence
        }
        const auto count = static_cast<std::size_t>(std::popcount(is_new));
        *to = static_cast<std::byte>(count > vertex_list::most ? 0 : count);
        if (count > vertex_list::most) return to + 1;
        std::array<std::uint32_t, corners> position;  // of first occurrences: the number of lesser vertices
        for (std::uint32_t left = is_new; left != 0; left &= left - 1) {
            const auto at = static_cast<std::size_t>(std::countr_zero(left));
            const std::uint32_t less = bits_where([](auto x, std::uint32_t v) { return x < v; }, vertices[at]);
            position[at] = static_cast<std::uint32_t>(std::popcount(less & is_new));
            std::memcpy(to + header + index_bytes_ * position[at], &vertices[at], index_bytes_);
        }
        std::array<std::uint32_t, 3> positions{};
        for (std::size_t at = 0; at < corners; ++at) positions[at % 3] |= position[first[at]] << 4 * (at / 3);
        std::memcpy(to + 1, positions.data(), sizeof positions);
        return to + header + index_bytes_ * count;
    }

    large_vector<std::uint32_t> begins_;  // by leaf
    large_vector<std::byte> lists_;
    std::size_t index_bytes_ = 1;
};

}  // namespace aabb
