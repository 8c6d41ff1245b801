module aabblab.extreme;

import :cells;

namespace aabblab {

std::vector<std::pair<std::string, row_list>> by(std::span<const extreme_row> rows, std::string extreme_row::* text) {
    std::vector<std::pair<std::string, row_list>> all;
    for (const extreme_row& row : rows) {
        auto found = std::ranges::find(all, row.*text, &std::pair<std::string, row_list>::first);
        if (found == all.end()) found = all.insert(all.end(), {row.*text, {}});
        found->second.push_back(&row);
    }
    return all;
}

row_list of(const row_list& rows, contender_role role) {
    row_list all = rows;
    std::erase_if(all, [&](const extreme_row* row) { return row->role != role; });
    return all;
}

row_list of(const row_list& rows, const std::string& contender) {
    row_list all = rows;
    std::erase_if(all, [&](const extreme_row* row) { return row->contender != contender; });
    return all;
}

std::vector<std::string> contenders_in(std::span<const extreme_row> rows, contender_role role) {
    std::vector<std::string> names;
    for (const auto& [name, of_contender] : by(rows, &extreme_row::contender))
        if (of_contender.front()->role == role) names.push_back(name);
    return names;
}

std::string counts(std::uint64_t missing, std::uint64_t invented) {
    std::string text = missing > 0 ? "-" + std::to_string(missing) : "";
    if (invented > 0) text += (text.empty() ? "+" : " +") + std::to_string(invented);
    return text.empty() ? "-" : text;
}

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

table wrong_table(const std::string& title, std::span<const extreme_row> rows, std::string extreme_row::* text) {
    table t{{{title, false}}, {}};
    std::vector<std::string> names;
    for (const auto& [name, of_contender] : by(rows, &extreme_row::contender)) {
        names.push_back(name);
        t.columns.push_back({name});
    }
    for (const auto& [value, same] : by(rows, text)) {
        if (std::ranges::none_of(same, [](const extreme_row* row) { return row->made.said == aabb::verdict::wrong; }))
            continue;
        std::vector<std::string> cells{value};
        for (const std::string& name : names) cells.push_back(cell(of(same, name)));
        t.rows.push_back(std::move(cells));
    }
    return t;
}

}  // namespace aabblab
