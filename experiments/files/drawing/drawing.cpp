module aabblab.drawing;

import aabblab.fmt;
import aabblab.output;

namespace aabblab {

namespace {

bool is_ply_file(const std::filesystem::path& file) {
    return mesh_ending_of(file) == ".ply";
}

/// The pose's image of a vertex, each coordinate rounded.
aabb::vec3d world_point(const aabb::vec3d& v, const aabb::pose& at) {
    aabb::vec3d world{};
    for (int i = 0; i < 3; ++i) {
        const double* const row = &at.rotation[static_cast<std::size_t>(3 * i)];
        world[i] = row[0] * v[0] + row[1] * v[1] + row[2] * v[2] + at.translation[i];
    }
    return world;
}

/// Rejects another ending before the file is opened.
std::filesystem::path with_known_ending(std::filesystem::path file, const std::string& option) {
    if (const std::string ending = mesh_ending_of(file); ending != ".ply" && ending != ".obj")
        throw aabb::input_error(
            fmt::format("{} writes PLY or OBJ, so its file must end in .ply or .obj, not '{}'", option, ending));
    return file;
}

}  // namespace

hit_drawing::hit_drawing(const std::filesystem::path& file, const std::string& option)
    : name_(with_known_ending(file, option)), file_(file) {}

/// Vertices that no triangle uses are left out.
void hit_drawing::add_object(const aabb::mesh& m, const aabb::pose& at) {
    // Pale, so that red and black stand out; objects alternate.
    constexpr std::array<colour, 2> pale{{{170, 190, 220}, {220, 210, 170}}};
    const colour& painted = pale[first_triangles_.size() % pale.size()];
    first_triangles_.push_back(triangles_.size());
    constexpr std::uint32_t unseen = 0xffffffff;
    std::vector<std::uint32_t> numbers(m.vertices.size(), unseen);
    for (const auto& corners : m.triangles) {
        std::array<std::uint32_t, 3> drawn{};
        for (std::size_t i = 0; i < 3; ++i) {
            std::uint32_t& number = numbers[corners[i]];
            if (number == unseen) number = add_vertex(world_point(m.given_vertex(corners[i]), at), painted);
            drawn[i] = number;
        }
        triangles_.push_back(drawn);
    }
    is_red_.resize(triangles_.size());
}

std::uint32_t hit_drawing::add_vertex(const aabb::vec3d& at, const colour& painted) {
    if (!is_finite(at)) throw aabb::input_error(name_.string() + ": a vertex lies beyond the range of double");
    vertices_.push_back(at);
    colours_.push_back(painted);
    return static_cast<std::uint32_t>(vertices_.size() - 1);
}

/// Neighbouring hits share ends of their lines where these are rounded alike.
std::uint32_t hit_drawing::add_curve_vertex(const aabb::vec3d& at) {
    const auto [entry, is_new] = on_curve_.try_emplace({at[0], at[1], at[2]});
    if (is_new) entry->second = add_vertex(at, {0, 0, 0});
    return entry->second;
}

void hit_drawing::paint_red(triangle_of t) {
    const std::size_t triangle = first_triangles_[t.object] + t.triangle;
    if (is_red_[triangle]) return;
    is_red_[triangle] = true;
    for (std::uint32_t& corner : triangles_[triangle]) {
        const aabb::vec3d at = vertices_[corner];
        corner = add_vertex(at, {220, 40, 40});
    }
}

void hit_drawing::add_hit(triangle_of s, triangle_of t, const aabb::triangle_intersection& common) {
    if (common.kind == aabb::intersection_kind::none) return;
    paint_red(s);
    paint_red(t);
    std::array<std::uint32_t, 6> corners{};
    for (std::uint32_t i = 0; i < common.size; ++i) corners[i] = add_curve_vertex(common.corners[i]);
    const std::uint32_t lines = common.size == 2 ? 1 : common.size;  // of a polygon, around it
    const std::size_t before = lines_.size();
    for (std::uint32_t i = 0; i < lines; ++i)
        if (const std::uint32_t from = corners[i], to = corners[(i + 1) % common.size]; from != to)
            lines_.push_back({from, to});
    // A point, or what is too short to have two ends once they are rounded.
    if (lines_.size() == before) points_.push_back(corners[0]);
}

/// Many programs read coordinates as floats, and show meshes far from the origin as steps. Where floats would keep
/// fewer than 12 bits of the extent, coordinates become differences from their middle. These are exact, since both
/// numbers are nearly equal (Sterbenz, "Floating-point computation", 1974).
void hit_drawing::move_to_origin() {
    if (vertices_.empty()) return;
    aabb::vec3d low = vertices_.front(), high = low;
    double half_extent = 0;
    for (int k = 0; k < 3; ++k) {
        for (const aabb::vec3d& v : vertices_) {
            low[k] = std::min(low[k], v[k]);
            high[k] = std::max(high[k], v[k]);
        }
        half_extent = std::max(half_extent, high[k] / 2 - low[k] / 2);
    }
    for (int k = 0; k < 3; ++k) {
        if (!(std::min(std::abs(low[k]), std::abs(high[k])) > 0x1p12 * half_extent)) continue;
        origin_[k] = low[k] / 2 + high[k] / 2;
        for (aabb::vec3d& v : vertices_) v[k] -= origin_[k];
    }
}

std::string hit_drawing::ply_header() const {
    std::string text = "ply\nformat ascii 1.0\ncomment triangles that intersect are red, their intersections black\n";
    if (origin_ != aabb::vec3d{}) text += "comment " + origin_text() + "\n";
    text += fmt::format("element vertex {}\n", vertices_.size());
    for (const char axis : {'x', 'y', 'z'}) text += fmt::format("property double {}\n", axis);
    for (const char* const part : {"red", "green", "blue"}) text += fmt::format("property uchar {}\n", part);
    text += fmt::format("element face {}\nproperty list uchar int vertex_indices\n", triangles_.size());
    text += fmt::format("element edge {}\nproperty int vertex1\nproperty int vertex2\n", lines_.size());
    return text + "end_header\n";
}

std::string hit_drawing::origin_text() const {
    return "relative to " + aabb::shortest(origin_[0]) + " " + aabb::shortest(origin_[1]) + " " +
           aabb::shortest(origin_[2]);
}

/// Writes vertices, triangles and lines; OBJ counts from 1, has colours from 0 to 1, and names points, too.
void hit_drawing::write_elements(bool is_ply) {
    std::string text;
    const auto end_line = [&] {
        text.back() = '\n';
        if (text.size() < 1U << 16U) return;
        file_.write(text);
        text.clear();
    };
    for (std::size_t v = 0; v < vertices_.size(); ++v) {
        if (!is_ply) text += "v ";
        for (const double x : vertices_[v].at) text += aabb::shortest(x) + ' ';
        for (const std::uint8_t part : colours_[v])
            text += (is_ply ? std::to_string(part) : fmt::format("{:.3f}", part / 255.0)) + ' ';
        end_line();
    }
    const auto write = [&](std::string_view start, std::span<const std::uint32_t> numbers) {
        text += start;
        for (const std::uint32_t v : numbers) text += std::to_string(is_ply ? v : v + 1) + ' ';
        end_line();
    };
    for (const auto& corners : triangles_) write(is_ply ? "3 " : "f ", corners);
    for (const auto& ends : lines_) write(is_ply ? "" : "l ", ends);
    if (!is_ply)
        for (const std::uint32_t point : points_) write("p ", std::span(&point, 1));
    file_.write(text);
}

void hit_drawing::commit() {
    if (vertices_.size() > 0x7fffffff) throw aabb::input_error(name_.string() + ": too many vertices to draw");
    move_to_origin();
    if (is_ply_file(name_))
        file_.write(ply_header());
    else if (origin_ != aabb::vec3d{})
        file_.write("# " + origin_text() + "\n");
    write_elements(is_ply_file(name_));
    file_.commit();
    if (origin_ != aabb::vec3d{}) note(name_.string() + " has coordinates " + origin_text());
}

}  // namespace aabblab
