export module aabblab.files:loaded_mesh;

import aabb.geometry;
import aabb.std;

export namespace aabblab {

/// Parts of a file that are not read.
struct skipped_parts {
    std::string_view what;  ///< "statement" or "element"
    std::string name;       ///< as in the file
    std::size_t count = 0;
};

/// How reading changed a mesh, and what it left out.
struct mesh_report {
    std::size_t polygons = 0;            ///< faces of more than three corners
    std::size_t concave = 0;             ///< polygons that were ear-clipped; the others were fan-triangulated
    std::size_t zero_area = 0;           ///< triangles of exactly zero area; they are kept
    std::size_t dropped = 0;             ///< faces of fewer than three corners, points, lines
    std::size_t stitches = 0;            ///< triangles of strips that repeat a corner; they are skipped
    std::size_t not_finite = 0;          ///< unused vertices with NaN or infinity; they are moved onto a used one
    std::size_t animations = 0;          ///< ignored; the scene is read in its initial pose
    std::size_t hidden_meshes = 0;       ///< meshes in the file that its scene does not show
    std::vector<skipped_parts> skipped;  ///< parts that may have described surface, in file order
    std::size_t skipped_others = 0;      ///< parts with further names
    /// A summary in one line; empty if nothing was changed or left out.
    [[nodiscard]] std::string text() const;
    /// The part of the summary about what was left out.
    [[nodiscard]] std::string left_out() const;
};

struct loaded_mesh {
    aabb::mesh mesh;
    mesh_report report;
};

}  // namespace aabblab
