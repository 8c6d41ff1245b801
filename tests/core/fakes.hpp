#pragma once

// Minimal strategies of each kind: what they have is all that the concepts and the stages require.

import aabb.std;
import aabb;

struct fake_sort {
    static constexpr std::string_view name = "fake";
    static constexpr std::string_view summary = "a bubble sort";
    static void sort(std::span<aabb::projection> list, auto&) {
        for (std::size_t end = list.size(); end > 1; --end)
            for (std::size_t i = 1; i < end; ++i)
                if (list[i].key < list[i - 1].key) std::swap(list[i], list[i - 1]);
    }
};

struct fake_whole_partition {
    static constexpr std::string_view name = "fake_whole";
    static constexpr std::string_view summary = "one subset";
};

/// Two half-spaces x < 0 and x >= 0.
struct fake_cutting_partition {
    static constexpr std::string_view name = "fake_cutting";
    static constexpr std::string_view summary = "two halves";
    static aabb::axis_set axes(std::span<const aabb::box>, const aabb::membership&, aabb::axis_set) { return 0; }
    static void fit(const aabb::whole_subset&) {}
    [[nodiscard]] static std::uint32_t subset_count() { return 2; }
    static void for_each_subset(std::uint32_t, const aabb::box& b, auto visit) {
        if (b.min[0] < 0) visit(std::uint32_t{0}, aabb::every_axis);
        if (b.max[0] >= 0) visit(std::uint32_t{1}, aabb::axis_set{b.min[0] < 0 ? 0b110U : 0b111U});
    }
    [[nodiscard]] static std::uint64_t copies(std::uint32_t, const aabb::box& b) {
        return b.min[0] < 0 && b.max[0] >= 0 ? 2 : 1;
    }
};

/// Sorts anything by `precedes`, and reports its swaps.
struct fake_swapping_sort {
    static constexpr std::string_view name = "fake_swapping";
    static constexpr std::string_view summary = "a bubble sort that reports";
    static void sort(auto list, auto&, auto... on_swap) {
        for (std::size_t end = list.size(); end > 1; --end)
            for (std::size_t i = 1; i < end; ++i)
                if (precedes(list[i], list[i - 1])) {
                    const bool goes_on = (on_swap(list[i - 1], list[i]) && ...);
                    std::swap(list[i], list[i - 1]);
                    if (!goes_on) return;
                }
    }
};

/// Finds all pairs when it is updated.
struct fake_coherent_sweep {
    static constexpr std::string_view name = "fake_coherent";
    static constexpr std::string_view summary = "all pairs of all objects";
    void update(std::span<const aabb::box> boxes, const aabb::membership& objects, auto&, auto&) {
        pairs.clear();
        for (std::uint32_t a = 0; a < boxes.size(); ++a)
            for (std::uint32_t b = a + 1; b < boxes.size(); ++b)
                if (objects.contains(a) && objects.contains(b) && overlaps(boxes[a], boxes[b])) pairs.push_back({a, b});
    }
    void search(std::vector<aabb::index_pair>& out) const { out.insert(out.end(), pairs.begin(), pairs.end()); }
    [[nodiscard]] static aabb::axis_set axes() { return 0; }

    std::vector<aabb::index_pair> pairs;
};

/// Tests every pair of the subset, whatever the order.
struct fake_sweep {
    static constexpr std::string_view name = "fake";
    static constexpr std::string_view summary = "all pairs of a subset";
    static aabb::axis_set axes(std::span<const aabb::box>, const aabb::membership&) { return 0b010; }
    template <class Subset>
    static void sweep(const Subset& subset, std::vector<aabb::index_pair>& pairs, auto&) {
        const auto list = subset.lists[1];
        for (std::size_t i = 0; i < list.size(); ++i)
            for (std::size_t j = i + 1; j < list.size(); ++j)
                if (overlaps(subset.boxes[list[i].id], subset.boxes[list[j].id]) &&
                    Subset::owns(Subset::owned(list[i]), Subset::owned(list[j])))
                    pairs.push_back(aabb::ordered_pair(list[i].id, list[j].id));
    }
};

/// Rejects every sort but fake_sort.
struct picky_sweep : fake_sweep {
    template <class Sort, class...>
    static constexpr std::string_view rejects() {
        return std::string_view(Sort::name) == fake_sort::name ? "" : "picky works with the fake sort only";
    }
};

/// Builds as many nodes as a tree has, each with the bounds of the mesh.
struct fake_build {
    static constexpr std::string_view name = "fake";
    static constexpr std::string_view summary = "as many nodes as a tree has, and a box for the root";
    [[nodiscard]] static std::vector<aabb::build_node> build(const aabb::mesh& m, aabb::leaf_arrangement) {
        return std::vector<aabb::build_node>(2 * m.triangles.size() - 1, {bounds_of(m), 0, 0});
    }
    [[nodiscard]] static aabb::balanced_order order(const aabb::mesh&) { return {}; }
};
static_assert(aabb::BuildPolicy<fake_build>);

struct fake_tree {
    static constexpr std::string_view name = "fake";
    static constexpr std::string_view summary = "a list of triangles as a tree";
    struct cursor {
        std::uint32_t triangle;
        bool leaf;
    };
    static constexpr bool has_leaf_boxes = false;
    void pack(std::span<const aabb::build_node> nodes) {
        mesh_bounds = nodes[0].bounds;
        triangles = static_cast<std::uint32_t>(nodes.size() / 2 + 1);
    }
    void refit(const aabb::mesh& m, std::vector<aabb::box>&) { mesh_bounds = bounds_of(m); }
    [[nodiscard]] cursor root(const aabb::mesh&) const { return {0, triangles == 1}; }
    [[nodiscard]] static bool is_leaf(cursor at) { return at.leaf; }
    [[nodiscard]] std::array<cursor, 2> children(cursor at, const aabb::mesh&) const {
        return {cursor{at.triangle, true}, cursor{at.triangle + 1, at.triangle + 2 == triangles}};
    }
    [[nodiscard]] aabb::box bounds(cursor) const { return mesh_bounds; }
    [[nodiscard]] static std::uint32_t triangle(cursor at) { return at.triangle; }
    [[nodiscard]] static aabb::leaf_test_choice leaf_test() { return aabb::leaf_test_choice::none; }
    [[nodiscard]] static aabb::tree_bytes bytes() { return {}; }

    aabb::box mesh_bounds{};
    std::uint32_t triangles = 0;
};

/// Reports triangles as intersecting if their boxes overlap.
struct fake_triangle {
    static constexpr std::string_view name = "fake";
    static constexpr std::string_view summary = "boxes of triangles";
    [[nodiscard]] static bool intersects(const aabb::triangle3f& s, const aabb::triangle3f& t) {
        return overlaps(bounds_of(s), bounds_of(t));
    }
};
