/// Draws meshes and where they intersect, for programs that show coloured meshes.
export module aabblab.drawing;

import aabb.geometry;
import aabb.std;
import aabblab.files;

export namespace aabblab {

/// A PLY or OBJ file of meshes at poses: triangles that intersect are red, and what they have in common is drawn in
/// black lines and points. Colours belong to vertices, which most programs show, so that a red triangle has vertices of
/// its own. Triangles keep their order. Meshes far from the origin are moved to it. The file appears only when it is
/// committed.
class hit_drawing {
public:
    /// @param option the option that names the file, for messages
    /// @throws aabb::input_error if the name ends otherwise or the file cannot be written, as do `commit` and `add`.
    hit_drawing(const std::filesystem::path& file, const std::string& option);

    /// Adds an object; objects are numbered from 0.
    /// @throws aabb::input_error if a vertex leaves the range of double.
    void add_object(const aabb::mesh& m, const aabb::pose& at);

    /// A triangle of an object.
    struct triangle_of {
        std::uint32_t object, triangle;
    };
    /// Adds a hit of two triangles, whose objects have been added.
    void add_hit(triangle_of s, triangle_of t, const aabb::triangle_intersection& common);

    void commit();

private:
    using colour = std::array<std::uint8_t, 3>;

    std::uint32_t add_vertex(const aabb::vec3d& at, const colour& painted);
    std::uint32_t add_curve_vertex(const aabb::vec3d& at);
    void paint_red(triangle_of t);
    void move_to_origin();
    [[nodiscard]] std::string ply_header() const;
    [[nodiscard]] std::string origin_text() const;
    void write_elements(bool is_ply);

    std::filesystem::path name_;
    output_file file_;
    std::vector<aabb::vec3d> vertices_;
    aabb::vec3d origin_{};  // of the vertices in the file
    std::vector<colour> colours_;
    std::vector<std::array<std::uint32_t, 3>> triangles_;  // of all objects
    std::vector<bool> is_red_;                             // by triangle
    std::vector<std::size_t> first_triangles_;             // of the objects
    std::vector<std::array<std::uint32_t, 2>> lines_;
    std::vector<std::uint32_t> points_;
    std::map<std::array<double, 3>, std::uint32_t> on_curve_;  // its vertices by position
};

}  // namespace aabblab
