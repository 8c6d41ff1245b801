module;
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

export module aabb.local_detection:leaf_reader;

import aabb.geometry;
import :leaf_store;
import :model;
import :triangle_block;
import :vertex_lists;
import :wide_tree_policy;

export namespace aabb {

template <WideTreePolicy Tree>
[[nodiscard]] std::size_t leaves_of(const model<Tree>& m) noexcept {
    return (m.triangles().triangles.size() + triangle_block::width - 1) / triangle_block::width;
}

/// Reads those leaves that a store has claimed and lacks. Memory is told of all of them first, so that it is waited for
/// once.
template <WideTreePolicy Tree>
class leaf_reader {
public:
    /// @param read called for each as `read(leaf, number, its vertices)`
    template <class Leaf, class Read>
    inline void operator()(const model<Tree>& m, leaf_store<Leaf>& store, const Read& read) {
        const std::span<const std::uint32_t> missing = store.take_missing();
        for (const std::uint32_t number : missing) m.tree().fetch(number);
        for (std::size_t i = 0; i < missing.size(); ++i) {
            m.tree().read_vertices(missing[i], lists_[i]);
            lists_[i].fetch(m.triangles());
        }
        for (std::size_t i = 0; i < missing.size(); ++i) read(store[missing[i]], missing[i], lists_[i]);
    }

private:
    std::array<vertex_list, most_claims + 1> lists_{};
};

}  // namespace aabb
