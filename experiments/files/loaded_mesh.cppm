module;
#include <cstddef>
#include <string>

export module aabblab.files:loaded_mesh;

import aabb.geometry;

export namespace aabblab {

/// What reading a mesh did to it.
struct mesh_report {
    std::size_t polygons = 0;   ///< faces of more than three corners
    std::size_t concave = 0;    ///< those of them that were cut by ears; the others were fanned
    std::size_t zero_area = 0;  ///< triangles of zero area, exactly: kept
    /// Coordinates that are not floats: rounded to nearest. Text counts when it differs from the float as far as a
    /// double can tell, so "0.1" does.
    std::size_t rounded = 0;
    std::size_t dropped = 0;                 ///< faces of fewer than three corners, points, lines
    std::size_t animations = 0;              ///< ignored: the scene is read in the pose in which it stands
    std::size_t hidden_meshes = 0;           ///< that are in the file, but not in the scene that it shows
    [[nodiscard]] std::string text() const;  ///< one line; empty where there is nothing to say
};

struct loaded_mesh {
    aabb::mesh mesh;
    mesh_report report;
};

}  // namespace aabblab
