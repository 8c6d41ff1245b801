module aabblab.extreme;

import :cells;

namespace aabblab {

namespace {

/// Rows of cases; a test in float and in double is one.
std::vector<extreme_row> case_rows(std::span<const extreme_row> rows) {
    std::vector<extreme_row> all;
    for (const extreme_row& row : rows) {
        if (row.group != row_group::cases) continue;
        all.push_back(row);
        if (row.role == contender_role::triangle_test)
            all.back().contender = row.contender.substr(0, row.contender.find(" in "));
    }
    return all;
}

}  // namespace

table case_table(std::span<const extreme_row> rows) {
    const std::vector<extreme_row> shown = case_rows(rows);
    table t{{{"class", false}, {"cases"}, {"exact tests"}, {"compositions"}}, {}};
    const std::vector<std::string> engines = contenders_in(shown, contender_role::engine);
    for (const std::string& engine : engines) t.columns.push_back({engine});
    for (const auto& [kind, of_kind] : by(shown, &extreme_row::kind)) {
        std::set<std::string> cases;
        for (const extreme_row* row : of_kind) cases.insert(row->scene);
        row_list tests = of(of_kind, contender_role::triangle_test);
        std::erase_if(tests, [](const extreme_row* row) { return !row->must_be_exact; });
        std::vector<std::string> cells{kind, std::to_string(cases.size()), sum_cell(tests),
                                       sum_cell(of(of_kind, contender_role::composition))};
        for (const std::string& engine : engines) cells.push_back(cell(of(of_kind, engine)));
        t.rows.push_back(std::move(cells));
    }
    return t;
}

table inexact_case_table(std::span<const extreme_row> rows) {
    std::vector<extreme_row> shown = case_rows(rows);
    // Those with settings are in the file.
    std::erase_if(shown, [](const extreme_row& row) {
        return row.must_be_exact || row.role != contender_role::triangle_test ||
               row.contender.find(':') != std::string::npos;
    });
    return wrong_table("class", shown, &extreme_row::kind);
}

}  // namespace aabblab
