module;
#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

/// Reference systems in place of our pipeline, and what their answers differ in from the exact one. Behind plain types:
/// no header of CGAL, FCL or libccd reaches an importer.
export module aabb.validation;

import aabb;

export namespace aabb {

/// A whole reference system, by the name it has in configs and tables.
struct engine_info {
    std::string name;
    std::string summary;
    bool searches_boxes;   ///< can stand in for global search
    bool collides_meshes;  ///< can stand in for local detection
    bool exact;  ///< its pair sets equal the exact ones on every input; others' differences are listed by class
};

/// brute_force, cgal, fcl, libccd.
[[nodiscard]] std::span<const engine_info> engines();

/// Whether this engine is exact.
/// @throws input_error on an unknown name, with the nearest one.
[[nodiscard]] bool is_exact_engine(std::string_view name);

/// The engine in place of a global search. Differs from a composed stage in nothing but speed and counters.
/// @throws input_error on an unknown name, with the nearest one, or an engine that has no broad phase.
[[nodiscard]] std::unique_ptr<global_stage> make_box_engine(std::string_view name);

/// The engine in place of a local detection. Every engine has one.
/// @throws input_error on an unknown name, with the nearest one.
[[nodiscard]] std::unique_ptr<local_stage> make_mesh_engine(std::string_view name);

/// Do two closed triangles share a point? By CGAL's exact kernel; zero-area triangles as the segments or points they
/// are.
[[nodiscard]] bool exactly_intersect(const triangle3f& s, const triangle3f& t);
[[nodiscard]] bool exactly_intersect(const triangle3d& s, const triangle3d& t);

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

    [[nodiscard]] std::size_t total() const;
    differences& operator+=(const differences& other);
};

/// Compares the pair sets of triangles of two posed meshes. Both are sorted, each pair once.
[[nodiscard]] differences compare_triangle_pairs(std::span<const index_pair> exact, std::span<const index_pair> found,
                                                 const mesh& a, const pose& pose_a, const mesh& b, const pose& pose_b);

}  // namespace aabb
