module;
#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>

export module aabb.local_detection:corner_numbers;

import aabb.geometry;
import aabb.simd;
import :eight_boxes;
import :wide_tree_policy;

export namespace aabb {

/// Which vertices of the mesh are the corners of a leaf's triangles. Where there are fewer than eight, the last one
/// fills the rest.
struct corner_numbers {
    static constexpr std::size_t width = eight_boxes::most;

    alignas(32) std::array<std::array<std::uint32_t, width>, 3> vertex;  ///< by corner, then triangle

    template <WideTreePolicy Tree>
    void load(const mesh& m, const Tree& tree, std::uint32_t leaf) noexcept {
        const std::size_t last = m.triangles.size() - 1;
        for (std::size_t i = 0; i < width; ++i) {
            const auto place = static_cast<std::uint32_t>(std::min(width * leaf + i, last));
            for (std::size_t c = 0; c < 3; ++c) vertex[c][i] = m.triangles[tree.triangle_at(place)][c];
        }
    }

    /// Bit 8 j + i where triangle i of these has a corner that triangle j of the others has: they meet there.
    [[nodiscard]] inline std::uint64_t shared_with(const corner_numbers& other) const noexcept {
        return simd::columns_of_eight_that_share(vertex[0].data(), other.vertex[0].data());
    }
};

}  // namespace aabb
