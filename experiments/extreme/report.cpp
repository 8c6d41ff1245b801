module aabblab.extreme;

import aabb.policy;
import aabb.validation;
import aabblab.fmt;
import aabblab.numbers;
import aabblab.results;

namespace aabblab {

namespace {

using row_list = std::vector<const extreme_row*>;

/// Groups rows by a text, which a member or a function of a row gives, in order of first appearance.
template <class Text>
std::vector<std::pair<std::string, row_list>> grouped_by(std::span<const extreme_row> rows, Text text) {
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
row_list rows_with(const row_list& rows, Value extreme_row::* member, const Value& value) {
    row_list selected = rows;
    std::erase_if(selected, [&](const extreme_row* row) { return row->*member != value; });
    return selected;
}

/// The distinct names with this role.
std::vector<std::string> candidates_in(std::span<const extreme_row> rows, candidate_role role) {
    std::vector<std::string> names;
    for (const auto& [name, of_candidate] : grouped_by(rows, &extreme_row::candidate))
        if (of_candidate.front()->role == role) names.push_back(name);
    return names;
}

/// "-12 +3" are false negatives and false positives; "-" if there are none.
std::string counts(std::uint64_t false_negatives, std::uint64_t false_positives) {
    std::string text = false_negatives > 0 ? "-" + std::to_string(false_negatives) : "";
    if (false_positives > 0) text += (text.empty() ? "+" : " +") + std::to_string(false_positives);
    return text.empty() ? "-" : text;
}

/// A table cell for many candidates that must be exact: the number of those that are, "312 exact"; "312 rejected" if
/// each rejects its scenes, as expected; or the number of those that fail, "3 WRONG".
std::string sum_cell(const row_list& rows) {
    if (rows.empty()) return "-";
    std::set<std::string> candidates, failed;
    bool rejected = true;
    for (const extreme_row* row : rows) {
        candidates.insert(row->candidate);
        if (!row->as_expected) failed.insert(row->candidate);
        rejected = rejected && row->result.outcome == aabb::verdict::rejected;
    }
    if (!failed.empty()) return std::to_string(failed.size()) + " WRONG";
    return std::to_string(candidates.size()) + (rejected ? " rejected" : " exact");
}

/// A cell for one candidate: "exact", "rejected", "WRONG", "-12 +3" if it may be inexact, or "-" if it did not run.
std::string cell_of(const row_list& rows) {
    if (rows.empty()) return "-";
    std::uint64_t false_negatives = 0, false_positives = 0;
    bool rejected = false, wrong = false;
    for (const extreme_row* row : rows) {
        if (!row->as_expected) return "WRONG";
        false_negatives += row->result.false_negatives;
        false_positives += row->result.false_positives;
        rejected = rejected || row->result.outcome == aabb::verdict::rejected;
        wrong = wrong || row->result.outcome == aabb::verdict::wrong;
    }
    if (false_negatives + false_positives > 0) return counts(false_negatives, false_positives);
    return rejected ? "rejected" : wrong ? "wrong" : "exact";
}

/// A table with one row per scene, or per class of cases, and one column per candidate.
/// @param columns the first columns: the scene or class, then those of the summary
/// @param key the member by which rows are grouped
/// @param summary_cells returns the cells of the summary of a group
template <class Summary>
table candidate_table(std::vector<column> columns, std::span<const extreme_row> rows, std::string extreme_row::* key,
                      const std::vector<std::string>& names, Summary summary_cells) {
    table t{std::move(columns), {}};
    for (const std::string& name : names) t.columns.push_back({name});
    for (const auto& [value, group] : grouped_by(rows, key)) {
        std::vector<std::string>& cells = t.rows.emplace_back(1, value);
        std::ranges::move(summary_cells(group), std::back_inserter(cells));
        for (const std::string& name : names) cells.push_back(cell_of(rows_with(group, &extreme_row::candidate, name)));
    }
    return t;
}

template <class Wanted>
std::vector<extreme_row> filtered(std::span<const extreme_row> rows, Wanted wanted) {
    std::vector<extreme_row> selected;
    std::ranges::copy_if(rows, std::back_inserter(selected), wanted);
    return selected;
}

/// The errors of inexact triangle tests by scene or class of cases, without rows that have none.
/// @param key the member that holds the scene or the class
table wrong_table(const std::string& title, std::span<const extreme_row> rows, std::string extreme_row::* key) {
    const auto tests = filtered(rows, [](const extreme_row& row) { return row.role == candidate_role::triangle_test; });
    std::set<std::string> wrong;
    for (const extreme_row& row : tests)
        if (row.result.outcome == aabb::verdict::wrong) wrong.insert(row.*key);
    const auto shown = filtered(tests, [&](const extreme_row& row) { return wrong.contains(row.*key); });
    return candidate_table({{title, /*is_number=*/false}}, shown, key,
                           candidates_in(tests, candidate_role::triangle_test),
                           /*summary_cells=*/[](const row_list&) { return std::vector<std::string>(); });
}

constexpr std::array<std::string_view, 3> group_names = {"boxes", "meshes", "cases"};
constexpr std::array<std::string_view, 3> role_names = {"composition", "engine", "triangle_test"};
constexpr std::array<std::string_view, 2> yes_no = {"no", "yes"};

constexpr auto columns_of_row = [](auto& r, auto field) {
    field("group", one_of_words(r.group, group_names));
    field("scene", r.scene);
    field("class", r.kind);
    field("contender", r.candidate);
    field("precision", r.precision);
    field("role", one_of_words(r.role, role_names));
    field("must_be_exact", one_of_words(r.must_be_exact, yes_no));
    field("answer", one_of_words(r.result.outcome, aabb::verdict_names));
    field("as_expected", one_of_words(r.as_expected, yes_no));
    field("missing", r.result.false_negatives);
    field("invented", r.result.false_positives);
    for (std::size_t i = 0; i < aabb::difference_class_names.size(); ++i)
        field("missing_" + std::string(aabb::difference_class_names[i]), r.result.classes.false_negatives[i]);
    for (std::size_t i = 0; i < aabb::difference_class_names.size(); ++i)
        field("invented_" + std::string(aabb::difference_class_names[i]), r.result.classes.false_positives[i]);
    field("bytes", r.result.bytes);
    field("stated_bytes", r.stated_bytes);
    field("reason", r.result.reason);
    field("about", r.about);
};

}  // namespace

/// One row per class of triangle cases: their number, the exact triangle tests and the compositions in one cell each,
/// and a column per engine.
table case_table(std::span<const extreme_row> rows) {
    const auto shown = filtered(rows, [](const extreme_row& row) { return row.group == row_group::cases; });
    const auto sums_of = [](const row_list& group) {
        std::set<std::string> cases;
        for (const extreme_row* row : group) cases.insert(row->scene);
        const row_list tests = rows_with(group, &extreme_row::role, candidate_role::triangle_test);
        return std::vector{std::to_string(cases.size()), sum_cell(rows_with(tests, &extreme_row::must_be_exact, true)),
                           sum_cell(rows_with(group, &extreme_row::role, candidate_role::composition))};
    };
    return candidate_table({{"class", /*is_number=*/false}, {"cases"}, {"exact tests"}, {"compositions"}}, shown,
                           &extreme_row::kind, candidates_in(shown, candidate_role::engine), sums_of);
}

/// The errors of inexact triangle tests, one row per class of cases.
table inexact_case_table(std::span<const extreme_row> rows) {
    // Tests with non-default parameters are in the CSV file only.
    const auto shown = filtered(rows, [](const extreme_row& row) {
        return row.group == row_group::cases && row.role == candidate_role::triangle_test && !row.must_be_exact &&
               aabb::parse_strategy(row.candidate).settings.empty();
    });
    return wrong_table("class", shown, &extreme_row::kind);
}

/// One row per scene of a group (boxes or meshes): all compositions in one cell, and a column per engine.
table scene_table(std::span<const extreme_row> rows, row_group group) {
    const auto shown = filtered(
        rows, [&](const extreme_row& row) { return row.group == group && row.role != candidate_role::triangle_test; });
    return candidate_table(
        {{"scene", /*is_number=*/false}, {"compositions"}}, shown, &extreme_row::scene,
        candidates_in(shown, candidate_role::engine), [](const row_list& group) {
            return std::vector{sum_cell(rows_with(group, &extreme_row::role, candidate_role::composition))};
        });
}

table inexact_scene_table(std::span<const extreme_row> rows) {
    return wrong_table("scene", filtered(rows, [](const extreme_row& row) { return row.group == row_group::meshes; }),
                       &extreme_row::scene);
}

/// One row per candidate that may be inexact: its errors in scenes of meshes, by class of the wrong pair.
table class_table(std::span<const extreme_row> rows) {
    table t = empty_table({"candidate"});
    for (const std::string_view name : aabb::difference_class_names) t.columns.push_back({std::string(name)});
    const auto shown =
        filtered(rows, [](const extreme_row& row) { return row.group == row_group::meshes && !row.must_be_exact; });
    for (const auto& [name, of_candidate] : grouped_by(shown, &extreme_row::candidate)) {
        aabb::differences sum;
        for (const extreme_row* row : of_candidate) sum += row->result.classes;
        std::vector<std::string> cells{name};
        for (std::size_t c = 0; c < sum.false_negatives.size(); ++c)
            cells.push_back(counts(sum.false_negatives[c], sum.false_positives[c]));
        t.rows.push_back(std::move(cells));
    }
    return t;
}

/// A sentence for each scene with a memory limit: the most bytes that a composition took, and the limit.
std::vector<std::string> memory_in(std::span<const extreme_row> rows) {
    std::vector<std::string> sentences;
    const auto limited = filtered(
        rows, [](const extreme_row& row) { return row.stated_bytes > 0 && row.role == candidate_role::composition; });
    for (const auto& [scene, of_scene] : grouped_by(limited, &extreme_row::scene)) {
        std::size_t most = 0;
        for (const extreme_row* row : of_scene) most = std::max(most, row->result.bytes);
        sentences.push_back(scene + ", " + of_scene.front()->about + ":\n  compositions: " + grouped(most) +
                            " bytes; limit: 64 per triangle + 64 KiB = " + grouped(of_scene.front()->stated_bytes));
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

/// A sentence for each distinct reason of a rejection, after the scenes in which it occurs.
std::vector<std::string> rejections_in(std::span<const extreme_row> rows) {
    std::vector<std::string> sentences;
    const auto rejected =
        filtered(rows, [](const extreme_row& row) { return row.result.outcome == aabb::verdict::rejected; });
    for (const auto& [sentence, group] :
         grouped_by(rejected, [](const extreme_row& row) { return row.result.reason; })) {
        std::vector<std::string> scenes;
        for (const extreme_row* row : group)
            if (std::ranges::find(scenes, row->scene) == scenes.end()) scenes.push_back(row->scene);
        sentences.push_back(fmt::format("{}: {}", fmt::join(scenes, ", "), sentence));
    }
    return sentences;
}

/// A sentence for each row with a result that is not as expected: the candidate, the scene and the reason.
std::vector<std::string> failures_in(std::span<const extreme_row> rows) {
    std::vector<std::string> sentences;
    for (const extreme_row& row : rows)
        if (!row.as_expected)
            sentences.push_back(row.full_name() + " on " + row.scene + ": " +
                                (row.result.outcome == aabb::verdict::rejected ? "rejects: " : "") + row.result.reason);
    return sentences;
}

}  // namespace aabblab
