/// Builds a mesh from vertices and polygons in file order, and reports what was changed or left out.
module aabblab.files:mesh_builder;

import :file_text;
import :loaded_mesh;
import :polygon;

namespace aabblab {

/// Exact test for collinear or coincident corners.
[[nodiscard]] inline bool has_zero_area(const aabb::triangle3d& t) {
    return aabb::exact_turn(t[0], t[1], t[2], 0) == 0 && aabb::exact_turn(t[0], t[1], t[2], 1) == 0 &&
           aabb::exact_turn(t[0], t[1], t[2], 2) == 0;
}

class mesh_builder {
public:
    explicit mesh_builder(std::string file) : file_(std::move(file)) {}

    /// Coordinates that are not finite are allowed as long as no face uses the vertex.
    /// @param line in the file; 0 if the format has no lines
    void add_vertex(const aabb::vec3d& p, std::size_t line = 0) {
        if (!aabb::is_finite(p)) not_finite_.push_back({vertices_.size(), line});
        vertices_.push_back(p);
    }
    [[nodiscard]] std::size_t vertices() const noexcept { return vertices_.size(); }
    [[nodiscard]] const aabb::vec3d& vertex(std::size_t index) const { return vertices_[index]; }
    void reserve(std::size_t vertices, std::size_t triangles) {
        vertices_.reserve(vertices);
        loaded_.mesh.triangles.reserve(triangles);
    }

    /// Polygons are triangulated by `finish`, as their vertices may follow; below three corners they are dropped.
    /// @param location the line or the number of the face, for messages
    void add_face(std::span<const std::uint32_t> corners, std::size_t location) {
        for (const std::uint32_t corner : corners) require_vertex(corner, location);
        if (corners.size() < 3) return drop_faces(1);
        if (corners.size() > 3) polygons_.push_back({loaded_.mesh.triangles.size(), corners.size(), location});
        for (std::size_t i = 2; i < corners.size(); ++i)
            loaded_.mesh.triangles.push_back({corners[0], corners[i - 1], corners[i]});
    }
    void drop_faces(std::size_t count) { loaded_.report.dropped += count; }
    /// Reports what is ignored: only the visible meshes of a scene are read, in their initial pose.
    void ignore(std::size_t animations, std::size_t hidden_meshes) {
        loaded_.report.animations = animations;
        loaded_.report.hidden_meshes = hidden_meshes;
    }

    /// Requires that the vertex exists when the mesh is finished.
    void require_vertex(std::uint32_t corner, std::size_t location) {
        if (corner < needed_vertices_) return;
        needed_vertices_ = std::size_t{corner} + 1;
        needed_at_ = location;
    }

    /// Adds a triangle of a strip. A triangle that repeats a corner only joins two parts of the strip and is skipped.
    void add_strip_triangle(const std::array<std::uint32_t, 3>& corners, std::size_t location) {
        if (corners[0] == corners[1] || corners[1] == corners[2] || corners[2] == corners[0])
            ++loaded_.report.stitches;
        else
            add_face(corners, location);
    }

    /// Counts statements or elements (`kind`) that are not read, by name, as they may describe surface. The report
    /// names only the first few, so that a strange file does not fill it.
    void report_skipped(std::string_view kind, std::string_view name, std::size_t count) {
        constexpr std::size_t most_names = 8;
        auto& skipped = loaded_.report.skipped;
        const auto part = std::ranges::find(skipped, name, &skipped_parts::name);
        if (part != skipped.end())
            part->count += count;
        else if (skipped.size() < most_names)
            skipped.push_back({kind, std::string(name), count});
        else
            loaded_.report.skipped_others += count;
    }

    /// Validates the mesh, now that all vertices are known, triangulates its polygons and returns it.
    /// @param location_prefix "FILE:" or "FILE: face ", which precedes a face's location in messages
    /// @param first_index the index of the first vertex in this format, 0 or 1, by which messages count
    [[nodiscard]] loaded_mesh finish(std::string_view location_prefix, std::size_t first_index = 0) {
        aabb::mesh& m = loaded_.mesh;
        // `needed_vertices_` is one more than the greatest index in a face, which is at `needed_at_` in the file.
        if (needed_vertices_ > vertices_.size())
            reject(std::string(location_prefix) + std::to_string(needed_at_),
                   "a face uses vertex " + std::to_string(needed_vertices_ - 1 + first_index) + ", but there are " +
                       std::to_string(vertices_.size()) + " vertices, counted from " + std::to_string(first_index));
        move_unused_vertices(first_index);
        cut_polygons(location_prefix);
        m.triangles.shrink_to_fit();
        set_vertices(m, std::move(vertices_));
        try {
            aabb::require_valid(m);
        } catch (const aabb::input_error& error) {
            const std::string left_out = loaded_.report.left_out();
            reject(file_, error.what() + (left_out.empty() ? "" : " (" + left_out + ")"));
        }
        for (std::uint32_t t = 0; t < m.triangle_count(); ++t)
            loaded_.report.zero_area += has_zero_area(m.given_triangle(t));
        return std::move(loaded_);
    }

private:
    struct polygon {
        std::size_t first_triangle;  // of its fan
        std::size_t corners;
        std::size_t location;
    };

    /// Triangulates polygons: the fans that `add_face` has stored before vertices were known may be concave.
    void cut_polygons(std::string_view location_prefix) {
        polygon_cutter cutter;
        for (const polygon& p : polygons_) {
            const std::span fan = std::span(loaded_.mesh.triangles).subspan(p.first_triangle, p.corners - 2);
            const polygon_shape shape = cutter.cut(vertices_, fan);
            const auto fail = [&](const std::string& sentence) {
                reject(std::string(location_prefix) + std::to_string(p.location),
                       "the boundary of a face of " + std::to_string(p.corners) + " corners " + sentence);
            };
            if (shape == polygon_shape::no_normal) fail("has no normal, as its signed area is zero");
            if (shape == polygon_shape::crosses_itself) fail("crosses itself");
            loaded_.report.concave += static_cast<std::size_t>(shape == polygon_shape::concave);
        }
        loaded_.report.polygons = polygons_.size();
    }

    struct located_vertex {
        std::size_t index;
        std::size_t line;
    };

    /// Moves vertices that are not finite, and that no face uses, onto a used one, as removing them would change the
    /// indices of others. Rejects the mesh if a face uses one.
    void move_unused_vertices(std::size_t first_index) {
        if (not_finite_.empty()) return;
        aabb::mesh& m = loaded_.mesh;
        std::vector<bool> is_used(vertices_.size());
        for (const auto& triangle : m.triangles)
            for (const std::uint32_t corner : triangle) is_used[corner] = true;
        for (const auto& [index, line] : not_finite_) {
            if (is_used[index])
                reject(file_ + (line == 0 ? "" : ":" + std::to_string(line)),
                       "vertex " + std::to_string(index + first_index) +
                           " has a coordinate that is not finite, and a face uses it");
            if (!m.triangles.empty()) vertices_[index] = vertices_[m.triangles[0][0]];
        }
        loaded_.report.not_finite = not_finite_.size();
    }

    std::string file_;
    loaded_mesh loaded_;
    std::vector<aabb::vec3d> vertices_;
    std::vector<polygon> polygons_;  // with more than three corners
    std::vector<located_vertex> not_finite_;
    std::size_t needed_vertices_ = 0;  // one more than the greatest corner index so far
    std::size_t needed_at_ = 0;        // the location of the face with that corner
};

// One reader per format. Text files are decoded by `as_text` before.
[[nodiscard]] loaded_mesh read_off(const file_text& file);
[[nodiscard]] loaded_mesh read_obj(const file_text& file);
[[nodiscard]] loaded_mesh read_ply(const file_text& file);
[[nodiscard]] loaded_mesh read_stl(const file_text& file);
[[nodiscard]] std::optional<loaded_mesh> read_binary_stl(const std::filesystem::path& file, std::size_t size);
[[nodiscard]] loaded_mesh read_gltf(const file_text& file);
[[nodiscard]] bool is_text_ply(std::string_view bytes);
[[nodiscard]] bool is_text_stl(std::string_view bytes);

}  // namespace aabblab
