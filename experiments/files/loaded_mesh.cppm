export module aabblab.files:loaded_mesh;

import aabb.geometry;
import aabb.std;

export namespace aabblab {

/// What a mesh is read without.
struct skipped_parts {
    std::string_view what;  ///< "statement" or "element"
    std::string name;       ///< in the file
    std::size_t count = 0;
};

/// What reading a mesh did to it.
struct mesh_report {
    std::size_t polygons = 0;   ///< faces of more than three corners
    std::size_t concave = 0;    ///< those of them that were ear-clipped; the others were fan-triangulated
    std::size_t zero_area = 0;  ///< triangles of zero area, exactly: kept
    /// Coordinates that are not floats: rounded to nearest. Text counts when it differs as a double, so "0.1" does.
    std::size_t rounded = 0;
    std::size_t dropped = 0;             ///< faces of fewer than three corners, points, lines
    std::size_t stitches = 0;            ///< triangles of strips that repeat a corner: left out
    std::size_t not_finite = 0;          ///< vertices with NaN or infinity, which no face uses: moved to one that is
    std::size_t animations = 0;          ///< ignored: the scene is read in the pose in which it stands
    std::size_t hidden_meshes = 0;       ///< that are in the file, but not in the scene that it shows
    std::vector<skipped_parts> skipped;  ///< that may have been meant for surface, in the order of the file
    std::size_t skipped_others = 0;      ///< parts of still other names
    /// One line; empty where there is nothing to say.
    [[nodiscard]] std::string text() const;
    /// The part of it that tells what the mesh does not have.
    [[nodiscard]] std::string left_out() const;
};

struct loaded_mesh {
    aabb::mesh mesh;
    mesh_report report;
};

}  // namespace aabblab
