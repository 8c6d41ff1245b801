module aabblab.files;

import aabblab.fmt;
import :mesh_builder;
import :scalar;
import :text_scanner;

namespace aabblab {

namespace {

struct scalar_name {
    std::string_view name;
    scalar type;
};
constexpr scalar_name scalar_names[] = {
    {"char", scalar::i8},   {"int8", scalar::i8},     {"uchar", scalar::u8},   {"uint8", scalar::u8},
    {"short", scalar::i16}, {"int16", scalar::i16},   {"ushort", scalar::u16}, {"uint16", scalar::u16},
    {"int", scalar::i32},   {"int32", scalar::i32},   {"uint", scalar::u32},   {"uint32", scalar::u32},
    {"float", scalar::f32}, {"float32", scalar::f32}, {"double", scalar::f64}, {"float64", scalar::f64}};

/// The meaning of a property for the mesh.
enum class meaning : std::uint8_t { none, x, y, z, corners, strip };

struct property {
    meaning means;
    scalar type;
    std::optional<scalar> count;  // the type of a list's length
};

struct element {
    std::string name;
    std::uint64_t count;
    std::vector<property> properties;
};

/// What an element's list of vertex indices means; none if the element is not read.
meaning meaning_of_list(const element& e) {
    return e.name == "face" ? meaning::corners : e.name == "tristrips" ? meaning::strip : meaning::none;
}

enum class encoding : std::uint8_t { text, little_endian, big_endian };
constexpr std::array<std::string_view, 3> encoding_names{"ascii", "binary_little_endian", "binary_big_endian"};

struct header {
    encoding values = encoding::text;
    std::vector<element> elements;
};

scalar read_type(text_scanner& in) {
    const std::string_view word = in.word();
    const auto entry = std::ranges::find(scalar_names, word, &scalar_name::name);
    if (entry == std::end(scalar_names)) in.fail_expected("the type of a property", word);
    return entry->type;
}

/// Reads a property line of the header, "property TYPE NAME" or "property list TYPE TYPE NAME" (of the length and of
/// the items), and finds what it means for the mesh: a coordinate, the corners of a face or strip, or nothing.
property read_property(text_scanner& in, const element& owner) {
    property p{meaning::none, scalar::u8, /*count=*/std::nullopt};
    if (const std::string_view start = in.word(); start == "list") {
        p.count = read_type(in);
        if (!is_integer(*p.count)) in.fail("the length of a list must have a whole type");
    } else {
        in.back_to(start);
    }
    p.type = read_type(in);
    const std::string_view name = in.word();
    if (name.empty()) in.fail_expected("the name of a property", name);
    if (owner.name == "vertex" && !p.count) {
        if (name == "x") p.means = meaning::x;
        if (name == "y") p.means = meaning::y;
        if (name == "z") p.means = meaning::z;
    } else if (p.count && (name == "vertex_indices" || name == "vertex_index")) {
        p.means = meaning_of_list(owner);
        if (p.means != meaning::none && !is_integer(p.type)) in.fail("the corners of a face must have a whole type");
    }
    return p;
}

/// Requires that an element has each property that the mesh needs exactly once.
void require_properties(const text_scanner& in, const element& e) {
    const auto require = [&](meaning wanted, const std::string& noun) {
        if (std::ranges::count(e.properties, wanted, &property::means) != 1)
            in.fail("the element " + e.name + " must have one " + noun);
    };
    if (e.name == "vertex") {
        require(meaning::x, "property x");
        require(meaning::y, "property y");
        require(meaning::z, "property z");
    }
    if (const meaning faces = meaning_of_list(e); faces != meaning::none)
        require(faces, "list property vertex_indices");
    if (e.properties.empty()) in.fail("the element " + in_quotes(e.name) + " has no properties");
}

/// The offset of the first value, which follows the line "end_header"; npos if there is no such line, as in UTF-16. If
/// the lines of the header end in carriage returns alone, a following line feed already belongs to the binary values.
std::size_t end_of_header(std::string_view bytes) {
    constexpr std::string_view last = "end_header";
    const auto is_line_end = [&](std::size_t i) { return bytes[i] == '\n' || bytes[i] == '\r'; };
    const std::size_t first_end = std::min(bytes.find_first_of("\r\n"), bytes.size());
    const bool has_only_returns = bytes.substr(first_end, 1) == "\r" && bytes.substr(first_end + 1, 1) != "\n";
    for (std::size_t i = bytes.find(last); i != std::string_view::npos; i = bytes.find(last, i + 1)) {
        if (i == 0 || !is_line_end(i - 1)) continue;
        const std::size_t end = bytes.find_first_not_of(" \t", i + last.size());
        if (end == std::string_view::npos || !is_line_end(end)) continue;
        return end + (!has_only_returns && bytes.substr(end).starts_with("\r\n") ? 2 : 1);
    }
    return std::string_view::npos;
}

/// Reads the header up to end_header: the encoding of the values, and the elements with their properties.
header read_header(text_scanner& in) {
    if (!in.next_line()) in.fail_at_end("before the word ply");
    if (const std::string_view magic = in.word(); magic != "ply") in.fail_expected("the word ply", magic);
    header h;
    bool has_format = false;
    while (in.next_line()) {
        const std::string_view word = in.word();
        if (word == "format") {
            const std::string_view values = in.word();
            const auto name = std::ranges::find(encoding_names, values);
            if (name == encoding_names.end())
                in.fail_expected("ascii, binary_little_endian or binary_big_endian", values);
            h.values = static_cast<encoding>(name - encoding_names.begin());
            has_format = true;
        } else if (word == "element") {
            if (!h.elements.empty()) require_properties(in, h.elements.back());
            const std::string name(in.word());
            h.elements.push_back({name, in.integer<std::uint64_t>("the number of elements"), {}});
        } else if (word == "property") {
            if (h.elements.empty()) in.fail("a property precedes the first element");
            h.elements.back().properties.push_back(read_property(in, h.elements.back()));
        } else if (word == "end_header") {
            if (!has_format) in.fail("the header has no format");
            if (!h.elements.empty()) require_properties(in, h.elements.back());
            return h;
        } else if (word != "comment" && word != "obj_info") {
            in.fail_expected("format, comment, element, property or end_header", word);
        }
    }
    in.fail_at_end("inside the header");
}

/// Reads the values of a text file, one element per line; has the same members as `binary_values`.
class text_values {
public:
    explicit text_values(text_scanner& in) : in_(in) {}

    void begin(const element& e, std::uint64_t index) {
        if (!in_.next_line())
            in_.fail_at_end(fmt::format("after {} of {} elements {}", index, e.count, in_quotes(e.name)));
    }
    [[nodiscard]] double coordinate(scalar) { return in_.coordinate(in_.word()); }
    [[nodiscard]] std::uint32_t integer(scalar) { return in_.integer<std::uint32_t>("a whole number"); }
    /// Reads a corner of a strip, or -1, which ends a part of it.
    [[nodiscard]] std::int64_t corner_or_end(scalar) {
        const auto corner = in_.integer<std::int64_t>("a whole number");
        if (corner < -1 || corner > std::numeric_limits<std::uint32_t>::max())
            in_.fail("a strip has corner " + std::to_string(corner) + "; only -1 ends a part of one");
        return corner;
    }
    void skip(scalar) {
        if (in_.word().empty()) in_.fail_expected("the value of a property", {});
    }
    void end_element() {
        if (in_.has_word()) in_.fail_expected("the end of the line after the last property", in_.word());
    }
    [[nodiscard]] std::size_t location(std::uint64_t) const { return in_.line(); }
    [[nodiscard]] std::size_t line() const { return in_.line(); }
    void end() {
        if (in_.next_line())
            in_.fail("expected the end of the file after the last element, found " + in_quotes(in_.word()));
    }
    static constexpr std::string_view location_prefix = ":";

private:
    text_scanner& in_;
};

class binary_values {
public:
    binary_values(std::string file, std::string_view bytes, bool is_big_endian)
        : file_(std::move(file)), bytes_(bytes), is_big_endian_(is_big_endian) {}

    void begin(const element& e, std::uint64_t index) {
        element_ = &e;
        index_ = index;
    }
    [[nodiscard]] double coordinate(scalar type) { return number(type); }
    [[nodiscard]] std::uint32_t integer(scalar type) {
        const double value = number(type);
        if (value < 0) fail("has a negative length or corner");
        return static_cast<std::uint32_t>(value);
    }
    [[nodiscard]] std::int64_t corner_or_end(scalar type) {
        const double value = number(type);
        if (value < -1) fail("has a negative corner; only -1 ends a part of a strip");
        return static_cast<std::int64_t>(value);
    }
    void skip(scalar type) { static_cast<void>(number(type)); }
    static void end_element() {}
    [[nodiscard]] static std::size_t location(std::uint64_t face) { return face; }
    void end() const {
        if (bytes_.find_first_not_of(" \t\r\n") != std::string_view::npos)
            reject(file_, fmt::format("continues for {} bytes after the last element that its header announces",
                                      bytes_.size()));
    }
    [[nodiscard]] static std::size_t line() { return 0; }
    static constexpr std::string_view location_prefix = ": face ";

private:
    /// Takes the next value of the file. Every type fits into a double exactly.
    [[nodiscard]] double number(scalar type) {
        if (bytes_.size() < bytes_of(type))
            reject(file_, fmt::format("ends in element {} of {} elements {}", index_, element_->count,
                                      in_quotes(element_->name)));
        const double value = number_at(&bytes_.front(), type, is_big_endian_);
        bytes_.remove_prefix(bytes_of(type));
        return value;
    }
    [[noreturn]] void fail(const std::string& sentence) const {
        reject(file_, element_->name + " " + std::to_string(index_) + " " + sentence);
    }

    std::string file_;
    std::string_view bytes_;
    bool is_big_endian_;
    const element* element_ = nullptr;
    std::uint64_t index_ = 0;
};

/// Splits a strip into triangles of three consecutive corners. Every other triangle is reversed for consistent winding.
/// -1 ends a part of the strip and starts another; a part of fewer than three corners is dropped.
class strip_triangles {
public:
    strip_triangles(mesh_builder& mesh, std::size_t location) : mesh_(mesh), location_(location) {}

    /// Adds the triangle of this corner and the two before it, every other one reversed; -1 ends a part of the strip.
    void add(std::int64_t corner) {
        if (corner < 0) return end_part();
        const auto c = static_cast<std::uint32_t>(corner);
        mesh_.require_vertex(c, location_);
        const auto [a, b] = last_two_;
        if (corners_ >= 2)
            mesh_.add_strip_triangle(corners_ % 2 == 0 ? std::array{a, b, c} : std::array{b, a, c}, location_);
        last_two_ = {b, c};
        ++corners_;
    }
    void end_part() {
        if (corners_ == 1 || corners_ == 2) mesh_.drop_faces(1);
        corners_ = 0;
    }

private:
    mesh_builder& mesh_;
    std::size_t location_;
    std::array<std::uint32_t, 2> last_two_{};
    std::uint64_t corners_ = 0;  // of the current part
};

/// Reads all elements in the order of the header and adds vertices, faces and strips to the mesh; others are skipped.
/// @tparam Values `text_values` or `binary_values`: each call takes the next value of the file, of a given type
template <class Values>
loaded_mesh read_elements(const file_text& file, const header& h, Values values) {
    mesh_builder mesh(file.name);
    std::vector<std::uint32_t> corners;
    for (const element& e : h.elements) {
        if (e.count > 0 && e.name != "vertex" && meaning_of_list(e) == meaning::none)
            mesh.report_skipped("element", e.name, e.count);
        for (std::uint64_t index = 0; index < e.count; ++index) {
            values.begin(e, index);
            aabb::vec3d point{};
            for (const property& p : e.properties) {
                if (p.means == meaning::strip) {
                    strip_triangles strip(mesh, values.location(index));
                    for (std::uint32_t left = values.integer(*p.count); left > 0; --left)
                        strip.add(values.corner_or_end(p.type));
                    strip.end_part();
                } else if (p.means == meaning::corners) {
                    corners.clear();
                    for (std::uint32_t left = values.integer(*p.count); left > 0; --left)
                        corners.push_back(values.integer(p.type));
                    mesh.add_face(corners, values.location(index));
                } else if (p.means != meaning::none) {
                    point[static_cast<int>(p.means) - static_cast<int>(meaning::x)] = values.coordinate(p.type);
                } else {
                    for (std::uint32_t left = p.count ? values.integer(*p.count) : 1; left > 0; --left)
                        values.skip(p.type);
                }
            }
            values.end_element();
            if (e.name == "vertex") mesh.add_vertex(point, values.line());
        }
    }
    values.end();
    return mesh.finish(file.name + std::string(Values::location_prefix));
}

}  // namespace

/// Reads PLY, text or binary by its header. Only the header of a binary file is decoded as text; a text file is read
/// again from its start, so that messages have its line numbers.
loaded_mesh read_ply(const file_text& file) {
    const std::size_t end = std::min(end_of_header(file.text), file.text.size());
    const file_text header_text = as_text({file.name, file.text.substr(0, end)});
    text_scanner header_scanner(header_text, no_comments);
    const header h = read_header(header_scanner);
    const std::string_view values = std::string_view(file.text).substr(end);
    if (h.values != encoding::text)
        return read_elements(file, h, binary_values(file.name, values, h.values == encoding::big_endian));
    text_scanner in(file, no_comments);
    static_cast<void>(read_header(in));
    return read_elements(file, h, text_values(in));
}

/// Whether the file is text: unless its header says binary. Without a legible header, it may be UTF-16.
bool is_text_ply(std::string_view bytes) {
    const std::size_t end = end_of_header(bytes);
    if (end == std::string_view::npos) return true;
    for (std::string_view rest = bytes.substr(0, end); !rest.empty();) {
        const std::size_t line_end = rest.find_first_of("\r\n");
        std::istringstream line{std::string(rest.substr(0, line_end))};
        std::string keyword;
        std::string values;
        if (line >> keyword >> values; keyword == "format") return !values.starts_with("binary_");
        rest.remove_prefix(line_end + 1);
    }
    return true;
}

}  // namespace aabblab
