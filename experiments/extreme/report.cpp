module aabblab.extreme;

import aabb.validation;
import aabblab.results;

namespace aabblab {

namespace {

constexpr std::array<std::string_view, 3> group_names = {"boxes", "meshes", "cases"};
constexpr std::array<std::string_view, 3> role_names = {"composition", "engine", "triangle_test"};

constexpr std::array<std::string_view, 2> answers = {"no", "yes"};

constexpr auto columns_of_row = [](auto& r, auto field) {
    field("group", one_of_words(r.group, group_names));
    field("scene", r.scene);
    field("class", r.kind);
    field("contender", r.contender);
    field("role", one_of_words(r.role, role_names));
    field("must_be_exact", one_of_words(r.must_be_exact, answers));
    field("answer", one_of_words(r.made.said, aabb::verdict_names));
    field("as_expected", one_of_words(r.as_expected, answers));
    field("missing", r.made.missing);
    field("invented", r.made.invented);
    for (std::size_t i = 0; i < aabb::difference_class_names.size(); ++i)
        field("missing_" + std::string(aabb::difference_class_names[i]), r.made.classes.missing[i]);
    for (std::size_t i = 0; i < aabb::difference_class_names.size(); ++i)
        field("invented_" + std::string(aabb::difference_class_names[i]), r.made.classes.invented[i]);
    field("bytes", r.made.bytes);
    field("reason", r.made.reason);
    field("about", r.about);
};

}  // namespace

table extreme_rows(std::span<const extreme_row> rows) {
    table t;
    for (const std::string& name : names_of<extreme_row>(columns_of_row)) t.columns.push_back({name});
    for (const extreme_row& row : rows) t.rows.push_back(fields_of(row, columns_of_row));
    return t;
}

std::vector<std::string> refusals_in(std::span<const extreme_row> rows) {
    std::vector<std::pair<std::string, std::vector<std::string>>> scenes_of;  // by sentence
    for (const extreme_row& row : rows) {
        if (row.made.said != aabb::verdict::refused) continue;
        auto found = std::ranges::find_if(scenes_of, [&](const auto& one) { return one.first == row.made.reason; });
        if (found == scenes_of.end()) found = scenes_of.insert(scenes_of.end(), {row.made.reason, {}});
        if (std::ranges::find(found->second, row.scene) == found->second.end()) found->second.push_back(row.scene);
    }
    std::vector<std::string> all;
    for (const auto& [sentence, scenes] : scenes_of) {
        std::string text;
        for (const std::string& scene : scenes) text += (text.empty() ? "" : ", ") + scene;
        all.push_back(text + ": " + sentence);
    }
    return all;
}

std::vector<std::string> failures_in(std::span<const extreme_row> rows) {
    std::vector<std::string> all;
    for (const extreme_row& row : rows)
        if (!row.as_expected)
            all.push_back(row.contender + " on " + row.scene + ": " +
                          (row.made.said == aabb::verdict::refused ? "refuses: " : "") + row.made.reason);
    return all;
}

}  // namespace aabblab
