module;
#include <boost/geometry/core/cs.hpp>
#include <boost/geometry/geometries/box.hpp>
#include <boost/geometry/geometries/point.hpp>
#include <boost/geometry/index/rtree.hpp>
#include <boost/iterator/function_output_iterator.hpp>

module aabb.engines;

import :box_engine;
import :engine;

namespace aabb {

namespace {

namespace index = boost::geometry::index;

/// Counts the allocated bytes.
template <class T>
struct counting_allocator {
    using value_type = T;

    explicit counting_allocator(std::size_t& account) : bytes(&account) {}
    template <class Other>
    explicit(false) counting_allocator(const counting_allocator<Other>& other) : bytes(other.bytes) {}

    [[nodiscard]] T* allocate(std::size_t n) {
        T* memory = std::allocator<T>().allocate(n);
        *bytes += n * sizeof(T);
        return memory;
    }
    void deallocate(T* at, std::size_t n) {
        *bytes -= n * sizeof(T);
        std::allocator<T>().deallocate(at, n);
    }
    template <class Other>
    bool operator==(const counting_allocator<Other>& other) const {
        return bytes == other.bytes;
    }

    std::size_t* bytes;
};

using corner = boost::geometry::model::point<float, 3, boost::geometry::cs::cartesian>;
using bounds = boost::geometry::model::box<corner>;
using entry = std::pair<bounds, std::uint32_t>;
// Packing fills nodes whatever the split algorithm; 8 to 16 entries per node are fastest.
using tree =
    index::rtree<entry, index::linear<16>, index::indexable<entry>, index::equal_to<entry>, counting_allocator<entry>>;

class boost_rtree final : public box_engine {
public:
    [[nodiscard]] std::vector<part_bytes> bytes() const override {
        return {{"engine", bytes_of(entries_) + tree_bytes_}};
    }

private:
    /// Packs a new tree of the present boxes.
    void take_boxes(std::span<const box> boxes, std::span<const std::uint32_t> ids) override {
        tree_.reset();
        entries_.clear();
        for (const std::uint32_t id : ids) {
            const box& b = boxes[id];
            entries_.push_back({{{b.min[0], b.min[1], b.min[2]}, {b.max[0], b.max[1], b.max[2]}}, id});
        }
        // Constructed from a range, the tree is packed: nodes are full, with 16 entries.
        tree_.emplace(entries_.begin(), entries_.end(), index::linear<16>(), index::indexable<entry>(),
                      index::equal_to<entry>(), counting_allocator<entry>(tree_bytes_));
    }

    void find_pairs(std::vector<index_pair>& pairs) override {
        // In the order of the leaves, so that successive queries share cached nodes.
        for (const entry& query : *tree_)
            tree_->query(index::intersects(query.first), boost::make_function_output_iterator([&](const entry& other) {
                             if (query.second < other.second) pairs.push_back({query.second, other.second});
                         }));
    }

    std::vector<entry> entries_;
    std::size_t tree_bytes_ = 0;
    std::optional<tree> tree_;
};

}  // namespace

engine boost_rtree_engine() {
    return {.name = "boost_rtree",
            .summary = "Boost.Geometry's R-tree, rebuilt by packing in each frame and queried with each box",
            .boxes = make_stage<global_stage, boost_rtree>};
}

}  // namespace aabb
