module aabblab.extreme;

import aabb.policy;
import aabb.validation;
import aabblab.fmt;
import aabblab.numbers;
import aabblab.results;

namespace aabblab {

namespace {

using row_list = std::vector<const extreme_row*>;

/// Groups rows by a text, in order of first appearance.
template <class Text>
std::vector<std::pair<std::string, row_list>> by(std::span<const extreme_row> rows, Text text) {
    std::vector<std::pair<std::string, row_list>> groups;
    for (const extreme_row& row : rows) {
        auto group = std::ranges::find(groups, std::invoke(text, row), &std::pair<std::string, row_list>::first);
        if (group == groups.end()) group = groups.insert(groups.end(), {std::invoke(text, row), {}});
        group->second.push_back(&row);
    }
    return groups;
}

/// The rows in which the member has this value.
template <class Value>
row_list with(const row_list& rows, Value extreme_row::* member, const Value& value) {
    row_list selected = rows;
    std::erase_if(selected, [&](const extreme_row* row) { return row->*member != value; });
    return selected;
}

/// The distinct names with this role.
std::vector<std::string> contenders_in(std::span<const extreme_row> rows, contender_role role) {
    std::vector<std::string> names;
    for (const auto& [name, of_contender] : by(rows, &extreme_row::contender))
        if (of_contender.front()->role == role) names.push_back(name);
    return names;
}

/// "-12 +3" are false negatives and false positives; "-" if there are none.
std::string counts(std::uint64_t missing, std::uint64_t invented) {
    std::string text = missing > 0 ? "-" + std::to_string(missing) : "";
    if (invented > 0) text += (text.empty() ? "+" : " +") + std::to_string(invented);
    return text.empty() ? "-" : text;
}

/// Sums up candidates that must be exact: "312 exact", "312 refused", or "3 WRONG".
std::string sum_cell(const row_list& rows) {
    if (rows.empty()) return "-";
    std::set<std::string> contenders;
    std::set<std::string> failed;
    bool refused = true;
    for (const extreme_row* row : rows) {
        contenders.insert(row->contender);
        if (!row->as_expected) failed.insert(row->contender);
        refused = refused && row->made.said == aabb::verdict::refused;
    }
    if (!failed.empty()) return std::to_string(failed.size()) + " WRONG";
    return std::to_string(contenders.size()) + (refused ? " refused" : " exact");
}

/// The cell of one candidate: "exact", "refused", "WRONG", or its counts of errors if it may be inexact; "-" if it was
/// not run.
std::string cell(const row_list& rows) {
    if (rows.empty()) return "-";
    std::uint64_t missing = 0;
    std::uint64_t invented = 0;
    bool refused = false;
    bool wrong = false;
    for (const extreme_row* row : rows) {
        if (!row->as_expected) return "WRONG";
        missing += row->made.missing;
        invented += row->made.invented;
        refused = refused || row->made.said == aabb::verdict::refused;
        wrong = wrong || row->made.said == aabb::verdict::wrong;
    }
    if (missing + invented > 0) return counts(missing, invented);
    return refused ? "refused" : wrong ? "wrong" : "exact";
}

/// One row per text: the first columns summarise its rows, then there is one column per name.
template <class First>
table contender_table(std::vector<column> columns, std::span<const extreme_row> rows, std::string extreme_row::* text,
                      const std::vector<std::string>& names, First first) {
    table t{std::move(columns), {}};
    for (const std::string& name : names) t.columns.push_back({name});
    for (const auto& [value, same] : by(rows, text)) {
        std::vector<std::string>& cells = t.rows.emplace_back(1, value);
        std::ranges::move(first(same), std::back_inserter(cells));
        for (const std::string& name : names) cells.push_back(cell(with(same, &extreme_row::contender, name)));
    }
    return t;
}

template <class Wanted>
std::vector<extreme_row> filtered(std::span<const extreme_row> rows, Wanted wanted) {
    std::vector<extreme_row> selected;
    std::ranges::copy_if(rows, std::back_inserter(selected), wanted);
    return selected;
}

/// Omits rows without errors.
table wrong_table(const std::string& title, std::span<const extreme_row> rows, std::string extreme_row::* text) {
    std::set<std::string> wrong;
    for (const extreme_row& row : rows)
        if (row.made.said == aabb::verdict::wrong) wrong.insert(row.*text);
    const auto shown = filtered(rows, [&](const extreme_row& row) { return wrong.contains(row.*text); });
    return contender_table({{title, false}}, shown, text, contenders_in(rows, contender_role::triangle_test),
                           [](const row_list&) { return std::vector<std::string>(); });
}

constexpr std::array<std::string_view, 3> group_names = {"boxes", "meshes", "cases"};
constexpr std::array<std::string_view, 3> role_names = {"composition", "engine", "triangle_test"};

constexpr std::array<std::string_view, 2> answers = {"no", "yes"};

constexpr auto columns_of_row = [](auto& r, auto field) {
    field("group", one_of_words(r.group, group_names));
    field("scene", r.scene);
    field("class", r.kind);
    field("contender", r.contender);
    field("precision", r.precision);
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
    field("stated_bytes", r.stated_bytes);
    field("reason", r.made.reason);
    field("about", r.about);
};

}  // namespace

table case_table(std::span<const extreme_row> rows) {
    const auto shown = filtered(rows, [](const extreme_row& row) { return row.group == row_group::cases; });
    const auto sums_of = [](const row_list& same) {
        std::set<std::string> cases;
        for (const extreme_row* row : same) cases.insert(row->scene);
        const row_list tests = with(same, &extreme_row::role, contender_role::triangle_test);
        return std::vector{std::to_string(cases.size()), sum_cell(with(tests, &extreme_row::must_be_exact, true)),
                           sum_cell(with(same, &extreme_row::role, contender_role::composition))};
    };
    return contender_table({{"class", false}, {"cases"}, {"exact tests"}, {"compositions"}}, shown, &extreme_row::kind,
                           contenders_in(shown, contender_role::engine), sums_of);
}

table inexact_case_table(std::span<const extreme_row> rows) {
    // Tests with non-default parameters are in the CSV file only.
    const auto shown = filtered(rows, [](const extreme_row& row) {
        return row.group == row_group::cases && row.role == contender_role::triangle_test && !row.must_be_exact &&
               aabb::parse_strategy(row.contender).settings.empty();
    });
    return wrong_table("class", shown, &extreme_row::kind);
}

table scene_table(std::span<const extreme_row> rows, row_group group) {
    const auto shown = filtered(
        rows, [&](const extreme_row& row) { return row.group == group && row.role != contender_role::triangle_test; });
    return contender_table(
        {{"scene", false}, {"compositions"}}, shown, &extreme_row::scene, contenders_in(shown, contender_role::engine),
        [](const row_list& same) {
            return std::vector{sum_cell(with(same, &extreme_row::role, contender_role::composition))};
        });
}

table inexact_scene_table(std::span<const extreme_row> rows) {
    const auto shown = filtered(rows, [](const extreme_row& row) {
        return row.group == row_group::meshes && row.role == contender_role::triangle_test;
    });
    return wrong_table("scene", shown, &extreme_row::scene);
}

table class_table(std::span<const extreme_row> rows) {
    table t{{{"may be inexact", false}}, {}};
    for (const std::string_view name : aabb::difference_class_names) t.columns.push_back({std::string(name)});
    const auto shown =
        filtered(rows, [](const extreme_row& row) { return row.group == row_group::meshes && !row.must_be_exact; });
    for (const auto& [name, of_contender] : by(shown, &extreme_row::contender)) {
        aabb::differences sum;
        for (const extreme_row* row : of_contender) sum += row->made.classes;
        std::vector<std::string> cells{name};
        for (std::size_t c = 0; c < sum.missing.size(); ++c) cells.push_back(counts(sum.missing[c], sum.invented[c]));
        t.rows.push_back(std::move(cells));
    }
    return t;
}

std::vector<std::string> memory_in(std::span<const extreme_row> rows) {
    std::vector<std::string> sentences;
    const auto limited = filtered(
        rows, [](const extreme_row& row) { return row.stated_bytes > 0 && row.role == contender_role::composition; });
    for (const auto& [scene, of_scene] : by(limited, &extreme_row::scene)) {
        std::size_t most = 0;
        for (const extreme_row* row : of_scene) most = std::max(most, row->made.bytes);
        sentences.push_back(scene + ", " + of_scene.front()->about + ":\n  compositions hold at most " + grouped(most) +
                            " bytes, of " + grouped(of_scene.front()->stated_bytes) + " stated");
    }
    return sentences;
}

std::string csv_of(std::span<const extreme_row> rows) {
    return csv_of(rows, columns_of_row);
}

std::vector<extreme_row> read_extreme_rows(const std::filesystem::path& file) {
    return rows_of_file<extreme_row>(file, columns_of_row,
                                     std::array<std::string_view, 2>{"precision", "stated_bytes"});
}

std::vector<std::string> refusals_in(std::span<const extreme_row> rows) {
    std::vector<std::string> sentences;
    const auto refused = filtered(rows, [](const extreme_row& row) { return row.made.said == aabb::verdict::refused; });
    for (const auto& [sentence, same] : by(refused, [](const extreme_row& row) { return row.made.reason; })) {
        std::vector<std::string> scenes;
        for (const extreme_row* row : same)
            if (std::ranges::find(scenes, row->scene) == scenes.end()) scenes.push_back(row->scene);
        sentences.push_back(fmt::format("{}: {}", fmt::join(scenes, ", "), sentence));
    }
    return sentences;
}

std::vector<std::string> failures_in(std::span<const extreme_row> rows) {
    std::vector<std::string> sentences;
    for (const extreme_row& row : rows)
        if (!row.as_expected)
            sentences.push_back(row.full_name() + " on " + row.scene + ": " +
                                (row.made.said == aabb::verdict::refused ? "refuses: " : "") + row.made.reason);
    return sentences;
}

}  // namespace aabblab
