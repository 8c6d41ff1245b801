module aabblab.configs;

import :document;

namespace aabblab {

namespace {

constexpr std::size_t longest_file = 16'777'216;

const node& entry_of(const document& doc, const node& table, std::string_view key) {
    return doc.required(table, key, "this case has no " + std::string(key));
}

bool truth_of(const document& doc, const node& table, const std::string& key) {
    return doc.flag_of(key, entry_of(doc, table, key));
}

/// Reads a coordinate, which must be finite as a float, since cases are tested in float and in double.
double coordinate_of(const document& doc, const std::string& key, const node& value) {
    if (value.kind != node_kind::integer && value.kind != node_kind::real)
        doc.fail_type("a coordinate of " + key, value, "a number");
    double number = 0;
    std::from_chars(value.text.data(), value.text.data() + value.text.size(), number);
    if (!std::isfinite(static_cast<float>(number)))
        doc.fail(value.line, "a coordinate of " + key + " is " + value.text + ", beyond the range of float");
    return number;
}

/// Reads a triangle: a list of three corners, each a list of three coordinates.
aabb::triangle3d triangle_of(const document& doc, const node& table, const std::string& key) {
    const node& corners = entry_of(doc, table, key);
    const auto require_three = [&](const node& list) {
        if (list.kind != node_kind::list || list.items.size() != 3)
            doc.fail(list.line, key + " must be three corners of three coordinates each");
    };
    require_three(corners);
    aabb::triangle3d triangle{};
    for (int i = 0; i < 3; ++i) {
        const node& corner = corners.items[static_cast<std::size_t>(i)];
        require_three(corner);
        for (int k = 0; k < 3; ++k) triangle[i][k] = coordinate_of(doc, key, corner.items[static_cast<std::size_t>(k)]);
    }
    return triangle;
}

/// Reads a [[case]]: two triangles, whether they intersect as floats, and if that differs, as doubles.
aabb::triangle_case case_of(const document& doc, const node& table) {
    doc.require_table("case", table, " of [[case]]",
                      {"name", "source", "about", "class", "first", "second", "intersect", "intersect_double"});
    const auto text = [&](const std::string& key) { return doc.text_of(key, entry_of(doc, table, key)); };
    aabb::triangle_case pair;
    pair.name = text("name");
    pair.source = text("source");
    pair.about = text("about");
    pair.kind = text("class");
    pair.first = triangle_of(doc, table, "first");
    pair.second = triangle_of(doc, table, "second");
    pair.intersect = truth_of(doc, table, "intersect");
    pair.intersect_double = table.find("intersect_double") ? truth_of(doc, table, "intersect_double") : pair.intersect;
    return pair;
}

}  // namespace

/// Reads the triangle pairs with known results in a text; the file's name is for messages.
std::vector<aabb::triangle_case> parse_triangle_cases(const std::string& text, const std::string& file) {
    const document doc(text, file, longest_file, "a file of cases");
    doc.require_keys(doc.root(), "", {"case"});
    if (!doc.root().find("case")) throw aabb::input_error(file + " has no cases; expected [[case]]");
    unique_list<aabb::triangle_case> cases;
    for (const node& table : doc.tables_of("case")) {
        const aabb::triangle_case pair = case_of(doc, table);
        if (!cases.add(pair, pair.name)) doc.fail(table.line, "two cases have the name '" + pair.name + "'");
    }
    return cases.items();
}

std::vector<aabb::triangle_case> read_triangle_cases(const std::filesystem::path& file) {
    return parse_triangle_cases(text_of_file(file, longest_file, "a file of cases"), file.string());
}

}  // namespace aabblab
