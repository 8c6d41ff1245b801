/// The header of a PLY file: which elements follow, with which properties.
module aabblab.files:ply_header;

import aabb.std;
import :file_text;
import :scalar;
import :text_scanner;

namespace aabblab::ply {

struct scalar_name {
    std::string_view name;
    scalar type;
};
inline constexpr scalar_name scalar_names[] = {
    {"char", scalar::i8},   {"int8", scalar::i8},     {"uchar", scalar::u8},   {"uint8", scalar::u8},
    {"short", scalar::i16}, {"int16", scalar::i16},   {"ushort", scalar::u16}, {"uint16", scalar::u16},
    {"int", scalar::i32},   {"int32", scalar::i32},   {"uint", scalar::u32},   {"uint32", scalar::u32},
    {"float", scalar::f32}, {"float32", scalar::f32}, {"double", scalar::f64}, {"float64", scalar::f64}};

/// What a property is to a mesh.
enum class role : std::uint8_t { none, x, y, z, corners, strip };

struct property {
    role meaning;
    scalar type;
    std::optional<scalar> count;  // of a list
};

struct element {
    std::string name;
    std::uint64_t count;
    std::vector<property> properties;
};

/// What the vertices of an element are that a list of it names; none where they are nothing to a mesh.
[[nodiscard]] inline role role_of_vertices(const element& e) {
    return e.name == "face" ? role::corners : e.name == "tristrips" ? role::strip : role::none;
}

enum class encoding : std::uint8_t { text, little, big };

struct header {
    encoding values = encoding::text;
    std::vector<element> elements;
};

[[nodiscard]] inline scalar read_type(text_scanner& in) {
    const std::string_view word = in.word();
    const auto found = std::ranges::find(scalar_names, word, &scalar_name::name);
    if (found == std::end(scalar_names)) in.expected("the type of a property", word);
    return found->type;
}

[[nodiscard]] inline property read_property(text_scanner& in, const element& owner) {
    property p{role::none, scalar::u8, std::nullopt};
    const std::string_view start = in.word();
    if (start == "list") {
        p.count = read_type(in);
        if (!is_whole(*p.count)) in.fail("the length of a list must have a whole type");
    } else {
        in.back_to(start);
    }
    p.type = read_type(in);
    const std::string_view name = in.word();
    if (name.empty()) in.expected("the name of a property", name);
    if (owner.name == "vertex" && !p.count) {
        if (name == "x") p.meaning = role::x;
        if (name == "y") p.meaning = role::y;
        if (name == "z") p.meaning = role::z;
    } else if (p.count && (name == "vertex_indices" || name == "vertex_index")) {
        p.meaning = role_of_vertices(owner);
        if (p.meaning != role::none && !is_whole(p.type)) in.fail("the corners of a face must have a whole type");
    }
    return p;
}

/// An element must hold each of these exactly once.
inline void require_roles(const text_scanner& in, const element& e) {
    const auto require = [&](role wanted, const std::string& what) {
        if (std::ranges::count(e.properties, wanted, &property::meaning) != 1)
            in.fail("the element " + e.name + " must have one " + what);
    };
    if (e.name == "vertex") {
        require(role::x, "property x");
        require(role::y, "property y");
        require(role::z, "property z");
    }
    if (const role faces = role_of_vertices(e); faces != role::none) require(faces, "list property vertex_indices");
    if (e.properties.empty()) in.fail("the element " + in_quotes(e.name) + " has no properties");
}

/// Where the header ends and values begin; npos where there is no header, or none of single bytes. Behind a header
/// whose lines end in carriage returns alone, a line feed is the first byte of binary values.
[[nodiscard]] inline std::size_t end_of_header(std::string_view bytes) {
    constexpr std::string_view last = "end_header";
    const auto is_line_end = [&](std::size_t at) { return bytes[at] == '\n' || bytes[at] == '\r'; };
    const std::size_t first_end = std::min(bytes.find_first_of("\r\n"), bytes.size());
    const bool of_returns = bytes.substr(first_end, 1) == "\r" && bytes.substr(first_end + 1, 1) != "\n";
    for (std::size_t at = bytes.find(last); at != std::string_view::npos; at = bytes.find(last, at + 1)) {
        if (at == 0 || !is_line_end(at - 1)) continue;
        const std::size_t end = bytes.find_first_not_of(" \t", at + last.size());
        if (end == std::string_view::npos || !is_line_end(end)) continue;
        return end + (!of_returns && bytes.substr(end).starts_with("\r\n") ? 2 : 1);
    }
    return std::string_view::npos;
}

/// @throws aabb::input_error with the line.
[[nodiscard]] inline header read_header(text_scanner& in) {
    if (!in.next_line()) in.ends("before the word ply");
    if (const std::string_view magic = in.word(); magic != "ply") in.expected("the word ply", magic);
    header h;
    bool has_format = false;
    while (in.next_line()) {
        const std::string_view word = in.word();
        if (word == "format") {
            const std::string_view values = in.word();
            if (values == "ascii")
                h.values = encoding::text;
            else if (values == "binary_little_endian")
                h.values = encoding::little;
            else if (values == "binary_big_endian")
                h.values = encoding::big;
            else
                in.expected("ascii, binary_little_endian or binary_big_endian", values);
            has_format = true;
        } else if (word == "element") {
            if (!h.elements.empty()) require_roles(in, h.elements.back());
            const std::string name(in.word());
            h.elements.push_back({name, in.whole<std::uint64_t>("the number of elements"), {}});
        } else if (word == "property") {
            if (h.elements.empty()) in.fail("a property stands before the first element");
            h.elements.back().properties.push_back(read_property(in, h.elements.back()));
        } else if (word == "end_header") {
            if (!has_format) in.fail("the header has no format");
            if (!h.elements.empty()) require_roles(in, h.elements.back());
            return h;
        } else if (word != "comment" && word != "obj_info") {
            in.expected("format, comment, element, property or end_header", word);
        }
    }
    in.ends("inside the header");
}

}  // namespace aabblab::ply
