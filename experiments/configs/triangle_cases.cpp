module aabblab.configs;

import :document;

namespace aabblab {

namespace {

constexpr std::size_t longest_file = 16'777'216;

const node& entry_of(const document& doc, const node& one, std::string_view key) {
    return doc.needed(one, key, "this case has no " + std::string(key));
}

bool truth_of(const document& doc, const node& one, const std::string& key) {
    return doc.flag_of(key, entry_of(doc, one, key));
}

double coordinate_of(const document& doc, const std::string& key, const node& value) {
    if (value.kind != node_kind::integer && value.kind != node_kind::real)
        doc.fail_type("a coordinate of " + key, value, "a number");
    double number = 0;
    std::from_chars(value.text.data(), value.text.data() + value.text.size(), number);
    if (!std::isfinite(static_cast<float>(number)))
        doc.fail(value.line, "a coordinate of " + key + " is " + value.text + ", beyond the range of float");
    return number;
}

aabb::triangle3d triangle_of(const document& doc, const node& one, const std::string& key) {
    const node& corners = entry_of(doc, one, key);
    const auto require_three = [&](const node& list) {
        if (list.kind != node_kind::list || list.items.size() != 3)
            doc.fail(list.line, key + " must be three corners of three coordinates each");
    };
    require_three(corners);
    aabb::triangle3d made{};
    for (int i = 0; i < 3; ++i) {
        const node& corner = corners.items[static_cast<std::size_t>(i)];
        require_three(corner);
        for (int k = 0; k < 3; ++k) made[i][k] = coordinate_of(doc, key, corner.items[static_cast<std::size_t>(k)]);
    }
    return made;
}

aabb::triangle_case case_of(const document& doc, const node& one) {
    doc.require_table("case", one);
    doc.require_keys(one, " of [[case]]",
                     {"name", "source", "about", "class", "first", "second", "intersect", "intersect_double"});
    const auto text = [&](const std::string& key) { return doc.text_of(key, entry_of(doc, one, key)); };
    aabb::triangle_case made;
    made.name = text("name");
    made.source = text("source");
    made.about = text("about");
    made.kind = text("class");
    made.first = triangle_of(doc, one, "first");
    made.second = triangle_of(doc, one, "second");
    made.intersect = truth_of(doc, one, "intersect");
    made.intersect_double = one.find("intersect_double") ? truth_of(doc, one, "intersect_double") : made.intersect;
    return made;
}

}  // namespace

std::vector<aabb::triangle_case> parse_triangle_cases(const std::string& text, const std::string& file) {
    const document doc(text, file, longest_file, "a file of cases");
    doc.require_keys(doc.root(), "", {"case"});
    if (!doc.root().find("case")) throw aabb::input_error(file + " has no cases; expected [[case]]");
    each_once<aabb::triangle_case> cases;
    for (const node& one : doc.tables_of("case")) {
        const aabb::triangle_case made = case_of(doc, one);
        if (!cases.add(made, made.name)) doc.fail(one.line, "two cases have the name '" + made.name + "'");
    }
    return cases.all();
}

std::vector<aabb::triangle_case> read_triangle_cases(const std::filesystem::path& file) {
    return parse_triangle_cases(text_of_file(file, longest_file, "a file of cases"), file.string());
}

}  // namespace aabblab
