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
    /// @param steps each called for all of them before the next, as `step(leaf, number, its vertices)`, so that none
    /// waits for what was made just before
    template <class Leaf, class... Steps>
    inline void operator()(const model<Tree>& m, leaf_store<Leaf>& store, const Steps&... steps) {
        const std::span<const std::uint32_t> missing = store.take_missing();
        for (const std::uint32_t number : missing) m.tree().fetch_vertices(number);
        for (std::size_t i = 0; i < missing.size(); ++i) {
            m.tree().read_vertices(missing[i], lists_[i]);
            lists_[i].fetch(m.triangles());
        }
        const auto do_all = [&](const auto& step) {
            for (std::size_t i = 0; i < missing.size(); ++i) step(store[missing[i]], missing[i], lists_[i]);
        };
        (do_all(steps), ...);
    }

private:
    std::array<vertex_list, most_claims + 1> lists_{};
};

}  // namespace aabb
