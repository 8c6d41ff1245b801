export module aabb.truth:differences;

import aabb.geometry;
import aabb.std;

export namespace aabb {

/// Why an engine's answer on two triangles may differ from the exact one; the first that applies.
enum class difference_class : std::uint8_t {
    degenerate,     ///< one of the triangles has zero area
    pose_rounding,  ///< with the raw pose, before vertices are rounded to float, the exact answer is the engine's
    coplanar,       ///< the triangles lie in one plane
    touching,       ///< they share points, but neither passes through the other; an engine can only miss such a pair
    near,           ///< moving one by a millionth of the pair's extent changes the exact answer
    other,          ///< the engine is wrong for no such reason
};
inline constexpr std::array<std::string_view, 6> difference_class_names = {"degenerate", "pose_rounding", "coplanar",
                                                                           "touching",   "near",          "other"};

/// Pairs that an engine missed or invented, by class.
struct differences {
    std::array<std::size_t, difference_class_names.size()> missing{};
    std::array<std::size_t, difference_class_names.size()> invented{};

    differences& operator+=(const differences& other);
};

/// Compares the pair sets of triangles of two posed meshes. Both are sorted, each pair once.
[[nodiscard]] differences compare_triangle_pairs(std::span<const index_pair> exact, std::span<const index_pair> found,
                                                 const mesh& a, const pose& pose_a, const mesh& b, const pose& pose_b);

}  // namespace aabb
