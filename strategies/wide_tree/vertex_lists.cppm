export module aabb.wide_tree.vertex_lists;

export import aabb.local_detection;
import aabb.std;
export import aabb.wide_tree.kernels;

export namespace aabb {

/// The vertices of a leaf of eight triangles, each once.
struct vertex_list {
    static constexpr std::size_t most = 16;

    alignas(64) std::array<std::uint32_t, most> vertices;  ///< ascending; the first one fills the rest
    std::array<std::uint32_t, 3> places;  ///< by corner: 4 bits a triangle; the last one fills the rest
    std::uint32_t count;                  ///< 0 where they have to be found in the mesh

    /// Tells memory that they will be read: of every second, since neighbours mostly share a line of it.
    inline void fetch(const mesh& m) const noexcept {
        if (count == 0) return;
        for (std::size_t i = 0; i < most; i += 2) __builtin_prefetch(&m.vertices[vertices[i]]);
    }
};

/// The vertices of leaves of eight triangles, each once: neighbours share most of their corners, so that some ten are
/// read in place of twenty-four, sixteen moved, and the mesh's triangles not read at all.
///
/// A list is a byte, how many vertices there are; for each corner, eight triangles' places in the list in 4 bits each;
/// and the vertices' indices, each in as many bytes as the largest one has, ascending, so that those side by side in
/// memory follow each other. Few leaves, of triangles that lie apart, have more than sixteen vertices: they have a list
/// of none, and are read from the mesh.
class vertex_lists {
public:
    static constexpr std::size_t triangles = balanced_order::leaf_triangles;

    vertex_lists() = default;
    /// @param order the mesh's triangles, leaf by leaf
    vertex_lists(const mesh& m, std::span<const std::uint32_t> order, worker_threads& workers) {
        while (width_ < 4 && m.vertices.size() > std::uint64_t{1} << 8 * width_) ++width_;
        begins_.resize((order.size() + triangles - 1) / triangles);
        // What one thread lists at a time, with room for the longest lists.
        const std::size_t room = least_shared * (header + width_ * vertex_list::most);
        std::vector<std::size_t> sizes((begins_.size() + least_shared - 1) / least_shared);
        large_vector<std::byte> parts(sizes.size() * room);
        const auto triangles_of = [&](std::size_t leaf) {
            const std::size_t begin = std::min(leaf * triangles, order.size());
            return order.subspan(begin, std::min(triangles, order.size() - begin));
        };
        workers.for_each_index(sizes.size(), [&](std::size_t p, std::size_t) {
            std::byte* const begin = &parts[p * room];
            std::byte* end = begin;
            for (std::size_t l = p * least_shared; l < std::min(begins_.size(), (p + 1) * least_shared); ++l) {
                for (const std::uint32_t t : triangles_of(l + ahead)) __builtin_prefetch(&m.triangles[t]);
                begins_[l] = static_cast<std::uint32_t>(end - begin);
                end = add(m, triangles_of(l), end);
            }
            sizes[p] = static_cast<std::size_t>(end - begin);
        });
        std::vector<std::size_t> offsets;
        std::size_t all = 0;
        for (const std::size_t size : sizes) {
            offsets.push_back(all);
            all += size;
        }
        if (all > most_bytes)
            throw input_error("lists of vertices take no more than 4 GiB; this mesh needs implicit:vertices=fetched");
        lists_.resize(all + read_beyond);
        std::fill(lists_.end() - read_beyond, lists_.end(), std::byte{});
        workers.for_each_index(sizes.size(), [&](std::size_t p, std::size_t) {
            std::memcpy(&lists_[offsets[p]], &parts[p * room], sizes[p]);
            for (std::size_t l = p * least_shared; l < std::min(begins_.size(), (p + 1) * least_shared); ++l)
                begins_[l] += static_cast<std::uint32_t>(offsets[p]);
        });
    }

    [[nodiscard]] inline bool empty() const noexcept { return begins_.empty(); }

    inline void fetch(std::uint32_t leaf) const noexcept { __builtin_prefetch(&lists_[begins_[leaf]]); }
    inline void read(std::uint32_t leaf, vertex_list& to) const noexcept {
        const std::byte* at = &lists_[begins_[leaf]];
        to.count = static_cast<std::uint32_t>(*at);
        if (to.count == 0) return;
        std::memcpy(to.places.data(), at + 1, sizeof to.places);
        simd::load_sixteen_numbers(to.vertices.data(), at + header, width_, to.count);
    }

    /// Whether these are still the corners of the leaf's triangles.
    [[nodiscard]] bool matches(const mesh& m, std::uint32_t leaf,
                               std::span<const std::uint32_t> of_leaf) const noexcept {
        vertex_list list;
        read(leaf, list);
        bool same = true;
        if (list.count == 0) return same;
        for (std::size_t i = 0; i < of_leaf.size(); ++i)
            for (std::size_t c = 0; c < 3; ++c)
                same &= list.vertices[list.places[c] >> 4 * i & 15U] == m.triangles[of_leaf[i]][c];
        return same;
    }

    [[nodiscard]] std::size_t bytes() const noexcept { return bytes_of(begins_, lists_); }

private:
    static constexpr std::size_t header = 1 + sizeof vertex_list::places;
    static constexpr std::size_t read_beyond = 64;
    static constexpr std::size_t most_bytes = 0xffffffff;
    static constexpr std::size_t ahead = 4;            // leaves whose triangles memory is told of
    static constexpr std::size_t least_shared = 1024;  // leaves that are worth another thread

    /// @returns the end of the list that begins at `to`
    std::byte* add(const mesh& m, std::span<const std::uint32_t> of_leaf, std::byte* to) const {
        constexpr std::size_t corners = 3 * triangles;
        alignas(32) std::array<std::uint32_t, corners> all;
        for (std::size_t i = 0; i < triangles; ++i)
            std::ranges::copy(m.triangles[of_leaf[std::min(i, of_leaf.size() - 1)]], &all[3 * i]);
        // Bit by bit, those that are so to `one`.
        const auto bits_where = [&](const auto& is, std::uint32_t one) {
            std::uint32_t bits = 0;
            for (std::size_t eight = 0; eight < corners; eight += 8)
                bits |= simd::bits_of_eight(is(simd::load_eight<simd::eight_words>(&all[eight]), one)) << eight;
            return bits;
        };
        // Where each stands first, of all before any has a place, so that none waits for the one before.
        std::array<std::uint8_t, corners> first;
        std::uint32_t is_new = 0;
        for (std::size_t at = 0; at < corners; ++at) {
            const std::uint32_t same = bits_where([](auto some, std::uint32_t one) { return some == one; }, all[at]);
            first[at] = static_cast<std::uint8_t>(std::countr_zero(same));
            is_new |= same & -same;
        }
        const auto count = static_cast<std::size_t>(std::popcount(is_new));
        *to = static_cast<std::byte>(count > vertex_list::most ? 0 : count);
        if (count > vertex_list::most) return to + 1;
        std::array<std::uint32_t, corners> place;  // of those that are new
        for (std::uint32_t left = is_new; left != 0; left &= left - 1) {
            const auto at = static_cast<std::size_t>(std::countr_zero(left));
            const std::uint32_t less = bits_where([](auto some, std::uint32_t one) { return some < one; }, all[at]);
            place[at] = static_cast<std::uint32_t>(std::popcount(less & is_new));
            std::memcpy(to + header + width_ * place[at], &all[at], width_);
        }
        std::array<std::uint32_t, 3> places{};
        for (std::size_t at = 0; at < corners; ++at) places[at % 3] |= place[first[at]] << 4 * (at / 3);
        std::memcpy(to + 1, places.data(), sizeof places);
        return to + header + width_ * count;
    }

    large_vector<std::uint32_t> begins_;  // by leaf
    large_vector<std::byte> lists_;
    std::size_t width_ = 1;  // bytes of an index
};

}  // namespace aabb
