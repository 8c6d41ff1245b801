module aabblab.files;

import :mesh_builder;
import :text_scanner;

namespace aabblab {

namespace {

/// The words of a statement, which a backslash at the end of a line continues on the next line.
class statement_words {
public:
    explicit statement_words(text_scanner& in) : in_(in) {}

    /// The next word of the statement; empty after the last. A backslash at a line's end continues the statement.
    [[nodiscard]] std::string_view next() {
        for (;;) {
            if (is_continued_ && !in_.next_line()) in_.fail_at_end("after a backslash");
            std::string_view word = in_.word();
            is_continued_ = word.ends_with('\\') && !in_.has_word();
            if (is_continued_) word.remove_suffix(1);
            if (!word.empty() || !is_continued_) return word;
        }
    }

private:
    text_scanner& in_;
    bool is_continued_ = false;
};

/// The vertex index in "v", "v/vt", "v//vn" or "v/vt/vn", from 0. OBJ counts from 1, or backwards from the last vertex.
std::uint32_t parse_corner(const text_scanner& in, std::string_view word, std::size_t vertices) {
    const std::string_view number = word.substr(0, word.find('/'));
    const std::string_view others = word.substr(number.size());
    const read_number<std::int64_t> parsed(number);
    if (!parsed.is_number || parsed.out_of_range ||
        others.find_first_not_of("/-0123456789") != std::string_view::npos || std::ranges::count(others, '/') > 2)
        in.fail_expected("the number of a vertex", word);
    const std::int64_t value = parsed.value;
    if (value == 0) in.fail("a face uses vertex 0, but vertices are counted from 1");
    const std::int64_t index = value > 0 ? value - 1 : static_cast<std::int64_t>(vertices) + value;
    if (index < 0 || index > std::numeric_limits<std::uint32_t>::max())
        in.fail("a face uses vertex " + std::string(number) + ", with " + counted(vertices, "vertex", "vertices") +
                " before it");
    return static_cast<std::uint32_t>(index);
}

/// Statements that do not change the surface: appearance, names, groups, and attributes of free-form geometry.
constexpr std::string_view without_surface[] = {
    "vt",     "vn",    "vp",       "g",        "o",    "s",    "mg",   "usemtl",     "mtllib",    "usemap",
    "maplib", "bevel", "c_interp", "d_interp", "lod",  "end",  "parm", "shadow_obj", "trace_obj", "cstype",
    "deg",    "bmat",  "step",     "trim",     "hole", "scrv", "sp",   "con",        "ctech",     "stech"};

}  // namespace

/// Reads vertices ("v") and faces ("f"). The report names skipped statements that may describe surface.
loaded_mesh read_obj(const file_text& file) {
    text_scanner in(file, /*comment=*/'#');
    mesh_builder mesh(file.name);
    std::vector<std::uint32_t> corners;
    while (in.next_line()) {
        statement_words words(in);
        const std::size_t line = in.line();
        const std::string_view statement = words.next();
        if (statement == "v") {
            aabb::vec3d p{};
            for (int k = 0; k < 3; ++k) p[k] = in.coordinate(words.next());
            mesh.add_vertex(p, line);
            for (std::string_view word = words.next(); !word.empty(); word = words.next())
                if (!read_number<double>(word).is_number)
                    in.fail_expected("the weight or the colour of a vertex", word);
        } else if (statement == "f" || statement == "fo") {  // early versions of the format use "fo"
            corners.clear();
            for (std::string_view word = words.next(); !word.empty(); word = words.next())
                corners.push_back(parse_corner(in, word, mesh.vertices()));
            mesh.add_face(corners, line);
        } else {
            if (std::ranges::find(without_surface, statement) == std::end(without_surface))
                mesh.report_skipped("statement", statement, /*count=*/1);
            while (!words.next().empty()) continue;
        }
    }
    return mesh.finish(file.name + ":", /*first_index=*/1);
}

}  // namespace aabblab
