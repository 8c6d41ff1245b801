export module aabblab.extreme:row;

import aabb.extreme;
import aabb.std;

export namespace aabblab {

enum class contender_role : std::uint8_t { composition, engine, triangle_test };
enum class row_group : std::uint8_t { boxes, meshes, cases };

/// How one contender did in one scene, or with one pair of triangles in every order of corners.
struct extreme_row {
    row_group group = row_group::boxes;
    std::string scene;  ///< or the case
    std::string about;
    std::string kind;  ///< of a case
    std::string contender;
    contender_role role = contender_role::composition;
    bool must_be_exact = true;
    bool as_expected = true;  ///< otherwise the suite fails
    aabb::judgement made;     ///< of a case: how many orders say no, or yes, where the other is true
};

}  // namespace aabblab
