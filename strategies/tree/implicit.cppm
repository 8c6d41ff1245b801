export module aabb.tree.implicit;

import aabb.costs;
import aabb.std;
import aabb.wide_tree;

export namespace aabb {

/// A balanced tree without child indices: every node has eight children, whose positions follow from its own. Boxes
/// have 8 bits per plane (`wide_node`). Leaves are eight triangles, whose boxes are computed on demand, so that nodes
/// take 1.14 bytes per triangle. Each triangle index takes as many bits as the largest one needs, or none if the
/// triangles keep the order of the mesh (`file_order`). Each leaf has a list of its vertices, which takes more memory
/// than the rest and saves a tenth of the query time, or a third for large meshes. Nodes are walked in batches
/// (`batched_walk`), or with `front=kept` not at all while the front of an earlier query is valid (`bvtt_front`). As a
/// binary tree, node (height, index) has the triangles index * 2^height to (index + 1) * 2^height - 1 of the order;
/// nodes below leaves have the leaf's box. A build chooses axes, not the number of triangles per side
/// (`balanced_order`). When to use: for the fastest queries.
class implicit_tree {
public:
    static constexpr std::string_view name = "implicit";
    static constexpr std::string_view summary =
        "nodes of 64 bytes with eight children, no indices, no leaf boxes, traversed in batches: fastest";
    static constexpr std::array leaves_out{absence::triangle_boxes, absence::node_indices};
    static constexpr bool has_leaf_boxes = true;

    /// How a query reads the vertices of a leaf: from the leaf's own list, or through the mesh's triangles.
    enum class vertex_choice : std::uint8_t { listed, fetched };
    /// The start of a query: at the roots, or at pairs of leaves kept from earlier queries (BVTT front tracking).
    enum class front_choice : std::uint8_t { forgotten, kept };
    struct config {
        vertex_choice vertices = vertex_choice::listed;
        front_choice front = front_choice::forgotten;
    };
    static constexpr std::tuple parameters{
        choice_parameter{"vertices", &config::vertices, std::array<std::string_view, 2>{"listed", "fetched"},
                         "how a leaf's vertices are read: from a list of 5 to 6 bytes per triangle or, slower, through "
                         "the mesh's triangles"},
        choice_parameter{"front", &config::front, std::array<std::string_view, 2>{"forgotten", "kept"},
                         "BVTT front tracking, for exact triangle tests: pairs of close leaves are kept for queries at "
                         "nearby poses"}};

    template <class Triangle, class Counters>
    using walk = front_walk<implicit_tree, Triangle, Counters>;

    /// Chooses the settings for a scene. Vertices are fetched if queries are few and the meshes not large: writing
    /// vertex lists takes about half of the time by which `sah` exceeds `median`, and saves a tenth of a query if both
    /// meshes have 150,000 triangles, whose vertices exceed the L2 cache, less for fewer. Fronts are kept over several
    /// frames, unless a frame has more pairs of objects than the cache has fronts.
    [[nodiscard]] static scene_fit fit(const scene_traits& scene) {
        constexpr double most_fetched_of_two = 200'000;
        constexpr std::size_t least_of_front = least_leaves_of_front * balanced_order::leaf_triangles;
        scene_fit fit;
        // A tenth of a query from 150,000 triangles on, in proportion below, and at least a little.
        const double saved = std::clamp(scene.triangles_per_query() / 1'500'000, 1.0 / 200, 1.0 / 10);
        const double writing_lists = (machine_costs().sah_triangle - machine_costs().median_triangle) / 2;
        const std::size_t repaid = scene.queries_that_repay(writing_lists, saved);
        if (scene.triangles > 0 && scene.triangles_per_query() <= most_fetched_of_two && scene.queries < repaid) {
            fit.settings.push_back({"vertices", "fetched"});
            fit.because.push_back(
                {"{queries} queries are expected, and vertex lists are worth their cost only from {repaid} on",
                 {{{"queries", static_cast<double>(scene.queries)}, {"repaid", static_cast<double>(repaid)}}}});
        }
        if (scene.triangles_per_query() >= double{least_of_front} && scene.exact_triangles &&
            scene.frames >= scene_traits::fewest_frames_to_keep && scene.queries <= scene.frames * most_fronts) {
            fit.settings.push_back({"front", "kept"});
            fit.because.push_back({"{frames} frames or more: pairs of leaves are kept while meshes move little",
                                   {{{"frames", scene_traits::fewest_frames_to_keep}}}});
        }
        fit.serves = !fit.settings.empty();
        return fit;
    }

    implicit_tree() = default;
    explicit implicit_tree(const config& c) : config_(c) {}

    struct cursor {
        std::uint32_t height;
        std::uint32_t index;
    };

    /// Builds the tree from an order of the triangles, eight per leaf: packs their indices, unless the order is the
    /// mesh's, writes the vertex lists, and encodes the nodes from the leaves up.
    void pack(const mesh& m, balanced_order order) {
        worker_threads workers(order.threads);
        triangles_ = static_cast<std::uint32_t>(order.triangles.size());
        index_bits_ = 0;
        packed_indices_.clear();
        if (!std::ranges::is_sorted(order.triangles)) {
            index_bits_ = std::bit_width(triangles_ - 1);
            packed_indices_.resize((std::size_t{triangles_} * index_bits_ + 7) / 8 + read_beyond);
            std::fill(packed_indices_.end() - read_beyond, packed_indices_.end(), std::byte{});
            workers.for_each_range(triangles_, triangles_per_share, [&](std::size_t begin, std::size_t end) {
                pack_triangle_indices(order.triangles, begin, end);
            });
        }
        if (config_.vertices == vertex_choice::listed) vertices_ = vertex_lists(m, order.triangles, workers);
        std::size_t total = 0;
        levels_ = 0;
        // A level has an eighth of the nodes of the level below, rounded up.
        for (std::size_t below = order.bounds.size(); levels_ == 0 || below > 1;) {
            below = groups_of(below);
            begins_[levels_++] = total;
            total += below;
        }
        nodes_.resize(total);
        encode_nodes(order.bounds, workers);
    }

    /// Recomputes all boxes, encodes the nodes anew, and rewrites vertex lists that no longer match.
    /// @param boxes working memory: the boxes of the triangles
    void refit(const mesh& m, std::vector<box>& boxes) {
        constexpr std::uint32_t in_leaf = balanced_order::leaf_triangles;
        boxes.resize(triangles_);
        bool lists_match = true;
        for (std::uint32_t leaf = 0; in_leaf * leaf < triangles_; ++leaf) {
            std::array<std::uint32_t, in_leaf> numbers;
            const std::uint32_t count = std::min(in_leaf, triangles_ - in_leaf * leaf);
            for (std::uint32_t i = 0; i < count; ++i) {
                numbers[i] = triangle_at(in_leaf * leaf + i);
                boxes[in_leaf * leaf + i] = bounds_of(m.triangle(numbers[i]));
            }
            lists_match &= vertices_.empty() || vertices_.matches(m, leaf, std::span(numbers).first(count));
        }
        worker_threads single_thread(1);
        if (!lists_match) {  // the mesh's vertices were renumbered
            std::vector<std::uint32_t> order(triangles_);
            for (std::uint32_t i = 0; i < triangles_; ++i) order[i] = triangle_at(i);
            vertices_ = vertex_lists(m, order, single_thread);
        }
        encode_nodes(merge_siblings(boxes), single_thread);
    }

    [[nodiscard]] inline cursor root(const mesh&) const noexcept {
        return skip_single_children({static_cast<std::uint32_t>(std::bit_width(triangles_ - 1)), 0});
    }
    [[nodiscard]] static inline bool is_leaf(const cursor& at) noexcept { return at.height == 0; }
    /// Whether the node has its own box.
    [[nodiscard]] static inline bool has_box(const cursor& at) noexcept { return at.height >= leaf_height; }
    [[nodiscard]] inline std::array<cursor, 2> children(const cursor& at, const mesh&) const noexcept {
        return {skip_single_children({at.height - 1, 2 * at.index}),
                skip_single_children({at.height - 1, 2 * at.index + 1})};
    }
    /// The box of a binary node, merged of the one, two, four or eight children of a wide node that it consists of: a
    /// wide node replaces three binary levels. A node within a leaf has the leaf's box.
    [[nodiscard]] inline box bounds(const cursor& at) const noexcept {
        const std::uint32_t height = std::max(at.height, leaf_height) - leaf_height;  // above the leaves
        const std::uint32_t index = at.height < leaf_height ? at.index >> (leaf_height - at.height) : at.index;
        const std::size_t level = std::min<std::size_t>(height / 3, levels() - 1);
        const auto above = static_cast<std::uint32_t>(height - 3 * level);  // the node consists of 2^above children
        const std::uint32_t first = index << above;
        const wide_node& n = nodes_[begins_[level] + first / wide_node::most_children];
        const std::uint32_t begin = first % wide_node::most_children;
        const std::uint32_t end = std::min<std::uint32_t>(begin + (1U << above), n.children);
        box range = empty_box();
        for (std::uint32_t i = begin; i < end; ++i) range = merged(range, n.child(i));
        return range;
    }
    [[nodiscard]] inline std::uint32_t triangle(const cursor& at) const noexcept { return triangle_at(at.index); }
    /// As `aabb::each_triangle_in`.
    template <class Take>
    void each_triangle_in(const mesh& m, const box& region, const Take& take) const {
        each_triangle_in_box(*this, m, region, take);
    }
    [[nodiscard]] tree_bytes bytes() const noexcept {
        return {bytes_of(nodes_), bytes_of(packed_indices_) + vertices_.bytes()};
    }

    [[nodiscard]] inline std::size_t levels() const noexcept { return levels_; }
    [[nodiscard]] inline const wide_node* level(std::size_t l) const noexcept { return &nodes_[begins_[l]]; }
    /// The index in the mesh of the triangle that comes at `i` in the order of the leaves.
    [[nodiscard]] inline std::uint32_t triangle_at(std::uint32_t i) const noexcept {
        if (index_bits_ == 0) return i;
        const std::size_t bit = std::size_t{i} * index_bits_;
        std::uint64_t word = 0;
        std::memcpy(&word, &packed_indices_[bit / 8], sizeof word);
        return static_cast<std::uint32_t>(word >> bit % 8 & ((std::uint64_t{1} << index_bits_) - 1));
    }

    [[nodiscard]] inline bool keeps_fronts() const noexcept { return config_.front == front_choice::kept; }
    inline void prefetch_vertices(std::uint32_t leaf) const noexcept {
        if (!vertices_.empty()) vertices_.prefetch(leaf);
    }
    /// Prefetches the indices of the leaf's triangles.
    inline void prefetch_triangles(std::uint32_t leaf) const noexcept {
        if (index_bits_ != 0) __builtin_prefetch(&packed_indices_[std::size_t{leaf} * index_bits_]);
    }
    inline void read_vertices(std::uint32_t leaf, vertex_list& list) const noexcept {
        list.count = 0;
        if (!vertices_.empty()) vertices_.read(leaf, list);
    }

private:
    static constexpr std::size_t read_beyond = 8;
    static constexpr std::size_t triangles_per_share = 8 * 512;  // fewer are not worth another thread
    static constexpr std::size_t boxes_per_share = wide_node::most_children * 256;
    static constexpr std::uint32_t leaf_height = 3;
    static constexpr std::size_t most_levels = 10;
    static_assert(std::uint64_t{1} << (leaf_height + 3 * most_levels) > most_triangles);

    [[nodiscard]] static constexpr std::size_t groups_of(std::size_t count) noexcept {
        return (count + wide_node::most_children - 1) / wide_node::most_children;
    }

    /// Writes a range of triangle indices to `packed_indices_`, in as many bits each as the largest needs. Ranges begin
    /// at multiples of eight indices, which fill whole bytes, so that threads write disjoint bytes.
    void pack_triangle_indices(std::span<const std::uint32_t> order, std::size_t begin, std::size_t end) noexcept {
        std::byte* to = &packed_indices_[begin * index_bits_ / 8];
        std::uint64_t unwritten = 0;
        std::size_t bits = 0;
        const auto write_byte = [&] {
            *to++ = static_cast<std::byte>(unwritten);
            unwritten >>= 8U;
        };
        for (const std::uint32_t triangle : order.subspan(begin, end - begin)) {
            unwritten |= std::uint64_t{triangle} << bits;
            for (bits += index_bits_; bits >= 8; bits -= 8) write_byte();
        }
        if (bits > 0) write_byte();
    }

    /// Replaces a node with one child by that child.
    [[nodiscard]] inline cursor skip_single_children(cursor node) const noexcept {
        while (node.height > 0 && (std::uint64_t{2} * node.index + 1) << (node.height - 1) >= triangles_)
            node = {node.height - 1, 2 * node.index};
        return node;
    }

    /// Encodes the nodes level by level; each level leaves the boxes of its nodes for the next one.
    /// @param boxes the boxes of the leaves, which are overwritten
    void encode_nodes(std::span<box> boxes, worker_threads& workers) {
        for (std::size_t l = 0; l < levels(); ++l) {
            workers.for_each_range(boxes.size(), boxes_per_share, [&](std::size_t begin, std::size_t end) {
                for (std::size_t i = begin; i < end; i += wide_node::most_children)
                    nodes_[begins_[l] + i / wide_node::most_children].encode(
                        boxes.subspan(i, std::min(wide_node::most_children, end - i)));
                merge_siblings(boxes.subspan(begin, end - begin));
            });
            // Compacts the boxes, which each range left at its beginning.
            std::size_t merged_count = 0;
            for (std::size_t begin = 0; begin < boxes.size(); begin += boxes_per_share)
                for (std::size_t i = 0; i < groups_of(std::min(boxes_per_share, boxes.size() - begin)); ++i)
                    boxes[merged_count++] = boxes[begin + i];
            boxes = boxes.first(merged_count);
        }
    }

    /// Merges the boxes of siblings, the up to `most_children` nodes or triangles of one parent, into the parent's box.
    /// @returns the boxes of all parents, which overwrite the first ones; those behind them have no meaning any more
    static std::span<box> merge_siblings(std::span<box> boxes) noexcept {
        std::size_t merged_count = 0;
        for (std::size_t i = 0; i < boxes.size(); i += wide_node::most_children) {
            box group = empty_box();
            for (const box& b : boxes.subspan(i, std::min(wide_node::most_children, boxes.size() - i)))
                group = merged(group, b);
            boxes[merged_count++] = group;
        }
        return boxes.first(merged_count);
    }

    config config_;
    std::uint32_t triangles_ = 0;
    std::size_t index_bits_ = 0;  // per triangle index; 0 if the order of the leaves is that of the mesh
    large_vector<wide_node> nodes_;
    large_vector<std::byte> packed_indices_;  // of the triangles, in the order of the leaves
    vertex_lists vertices_;                   // empty if vertices are fetched
    std::size_t levels_ = 0;
    std::array<std::size_t, most_levels> begins_{};
};

static_assert(TreePolicy<implicit_tree> && WideTreePolicy<implicit_tree>);

}  // namespace aabb
