module aabblab.files;

import :mesh_builder;
import :text_scanner;

namespace aabblab {

namespace {

/// How numbers are arranged in lines. Any number of colour values may follow a vertex or a face up to its line's end.
enum class arrangement : std::uint8_t {
    lines,       ///< each vertex and each face has its own line, and extra values at its end are skipped
    face_lines,  ///< line ends are insignificant, except that each face begins a line and colours may follow it
    words        ///< line ends are insignificant, and faces have no colours
};

/// Reads "OFF" with any prefix of ST, C, N: texture coordinates, colours and normals follow positions and are skipped.
/// @returns how many numbers of these a vertex has
std::size_t read_keyword(text_scanner& in) {
    if (!in.next_line()) in.fail_at_end("before the keyword OFF");
    const std::string_view keyword = in.word();
    const std::size_t off = keyword.find("OFF");
    if (off == std::string_view::npos) in.fail_expected("the keyword OFF", keyword);
    std::string_view prefix = keyword.substr(0, off);
    std::size_t attributes = 0;
    for (const auto& [mark, numbers] : {std::pair<std::string_view, std::size_t>{"ST", 2}, {"C", 4}, {"N", 3}})
        if (prefix.starts_with(mark)) {
            prefix.remove_prefix(mark.size());
            attributes += numbers;
        }
    if (prefix == "4" || prefix == "n" || prefix == "4n") in.fail("only OFF in three dimensions is read");
    if (!prefix.empty()) in.fail_expected("the keyword OFF", keyword);
    // Some writers omit the blank between the keyword and the first count.
    in.back_to(keyword.substr(off + 3));
    return attributes;
}

class off_reader {
public:
    off_reader(const file_text& file, arrangement tried)
        : in_(file, /*comment=*/'#'), name_(file.name), arrangement_(tried), mesh_(file.name) {}

    /// Reads the whole file as if its line ends had the meaning of `arrangement_`: they end each vertex and face
    /// (`lines`), each face (`face_lines`), or nothing (`words`). If the file contradicts that, throws an input_error,
    /// and the caller tries another meaning.
    [[nodiscard]] loaded_mesh read() {
        const std::size_t attributes = read_keyword(in_);
        const auto before_counts = [] { return std::string("before the numbers of vertices and faces"); };
        advance_to_word(before_counts);
        const auto vertices = in_.integer<std::uint64_t>("the number of vertices");
        if (arrangement_ != arrangement::lines) advance_to_word(before_counts);
        const auto faces = in_.integer<std::uint64_t>("the number of faces");
        // In lines, the number of edges is skipped with the rest of its line.
        if (arrangement_ != arrangement::lines) {
            advance_to_word([] { return std::string("before the number of edges"); });
            static_cast<void>(in_.integer<std::uint64_t>("the number of edges"));
        }
        for (std::uint64_t v = 0; v < vertices; ++v) read_vertex(v, vertices, attributes);
        if (arrangement_ == arrangement::face_lines && in_.has_word())
            in_.fail_expected("the end of the line after the last vertex", in_.word());
        for (std::uint64_t f = 0; f < faces; ++f) read_face(f, faces);
        if ((arrangement_ == arrangement::words && in_.has_word()) || in_.next_line())
            in_.fail("expected the end of the file after " + counted(vertices, "vertex", "vertices") + " and " +
                     counted(faces, "face") + ", found " + in_quotes(in_.word()));
        reached_end_ = true;
        return mesh_.finish(name_ + ":");
    }

    [[nodiscard]] bool has_vertex() const { return mesh_.vertices() > 0; }
    /// Whether the file was read to its end, so that an error is not about the arrangement.
    [[nodiscard]] bool reached_end() const { return reached_end_; }

private:
    /// Advances to the next word, over line ends. `where` says, for a message, what the end of the file interrupts.
    void advance_to_word(auto where) {
        if (!in_.has_word() && !in_.next_line()) in_.fail_at_end(where());
    }

    /// Reads vertex v of `count`, and skips what follows its position: the rest of its line, or else its attributes.
    void read_vertex(std::uint64_t v, std::uint64_t count, std::size_t attributes) {
        const bool has_line = arrangement_ == arrangement::lines;
        const auto where = [&] { return "after " + std::to_string(v) + " of " + std::to_string(count) + " vertices"; };
        if (has_line && !in_.next_line()) in_.fail_at_end(where());
        aabb::vec3d p{};
        for (int k = 0; k < 3; ++k) {
            if (!has_line) advance_to_word(where);
            p[k] = in_.coordinate(in_.word());
        }
        for (std::size_t i = 0; !has_line && i < attributes; ++i) {
            advance_to_word(where);
            static_cast<void>(in_.word());
        }
        mesh_.add_vertex(p, in_.line());
    }

    /// Reads face `index` of `count`. Where faces have lines, the rest of the line is skipped, as a colour may follow.
    void read_face(std::uint64_t index, std::uint64_t count) {
        const auto where = [&] { return "after " + std::to_string(index) + " of " + std::to_string(count) + " faces"; };
        if (arrangement_ == arrangement::words)
            advance_to_word(where);
        else if (!in_.next_line())
            in_.fail_at_end(where());
        const std::size_t line = in_.line();
        const auto corners = in_.integer<std::uint32_t>("the number of corners of a face");
        // A missing or extra number would shift the following ones, and accepting smaller faces would hide that.
        if (arrangement_ != arrangement::lines && corners < 3) in_.fail("expected at least three corners of a face");
        corners_.clear();
        for (std::uint32_t i = 0; i < corners; ++i) {
            if (arrangement_ != arrangement::lines) advance_to_word(where);
            corners_.push_back(in_.integer<std::uint32_t>("a face of " + std::to_string(corners) + " corners"));
        }
        mesh_.add_face(corners_, line);
    }

    text_scanner in_;
    std::string name_;
    arrangement arrangement_;
    bool reached_end_ = false;
    mesh_builder mesh_;
    std::vector<std::uint32_t> corners_;
};

struct read_attempt {
    std::optional<loaded_mesh> loaded;
    std::string rejection;
    bool has_vertex = false;
    bool reached_end = false;
};
/// Reads the file in this arrangement. A message is returned, not thrown, as another arrangement may fit.
read_attempt read_as(const file_text& file, arrangement tried) {
    off_reader reader(file, tried);
    try {
        return {.loaded = reader.read(), .rejection = {}};
    } catch (const aabb::input_error& error) {
        return {.loaded = {},
                .rejection = error.what(),
                .has_vertex = reader.has_vertex(),
                .reached_end = reader.reached_end()};
    }
}

}  // namespace

/// Reads OFF. The format ignores line ends (Geomview's manual, "OFF Files"), but writers nearly always put each vertex
/// and face on its own line, which is tried first. If that fails, faces that begin a line are tried, then any words.
loaded_mesh read_off(const file_text& file) {
    read_attempt lines = read_as(file, arrangement::lines);
    if (lines.loaded) return *std::move(lines.loaded);
    read_attempt face_lines = read_as(file, arrangement::face_lines);
    read_attempt words = read_as(file, arrangement::words);
    if (face_lines.loaded && words.loaded && face_lines.loaded->mesh.triangles != words.loaded->mesh.triangles)
        file.fail(
            "can be read in two ways, as numbers after the corners of a face are colours or more faces; expected each "
            "vertex and each face on a line of its own");
    for (read_attempt* other : {&face_lines, &words})
        if (other->loaded) return *std::move(other->loaded);
    // The file fits none. The message comes from an attempt that reached the end, as its error is not about line ends.
    for (const read_attempt* failed : {&lines, &face_lines, &words})
        if (failed->reached_end) throw aabb::input_error(failed->rejection);
    // If even the first line was no vertex, the file is not arranged in lines.
    throw aabb::input_error(lines.has_vertex ? lines.rejection : words.rejection);
}

}  // namespace aabblab
