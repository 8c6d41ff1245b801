module aabblab.tables;

import aabblab.text;

namespace aabblab {

std::vector<aabb::strategy_kind> differing_kinds(std::span<const contender_name> names) {
    std::vector<aabb::strategy_kind> kinds;
    for (const aabb::strategy_kind kind : aabb::strategy_kinds) {
        std::set<std::string> values;
        for (const contender_name& name : names)
            if (name.engine.empty()) values.insert(name[kind]);
        if (values.size() > 1) kinds.push_back(kind);
    }
    return kinds;
}

std::vector<column> name_columns_of(std::span<const aabb::strategy_kind> differing) {
    std::vector<column> columns{{row_number}};
    for (const aabb::strategy_kind kind : differing) columns.push_back({std::string(name_of(kind)), false});
    if (differing.empty()) columns.push_back({"composition", false});
    return columns;
}

std::vector<std::string> name_cells_of(std::span<const aabb::strategy_kind> differing, const contender_name& name,
                                       std::size_t rank) {
    std::vector<std::string> cells{std::to_string(rank)};
    if (name.engine.empty())
        for (const aabb::strategy_kind kind : differing) cells.push_back(name[kind]);
    else
        cells.push_back(name.engine);
    if (cells.size() == 1) cells.push_back(only_name_of(name));
    cells.resize(1 + std::max<std::size_t>(differing.size(), 1));
    return cells;
}

std::string only_name_of(const contender_name& name) {
    constexpr std::size_t most = 32;  // beside all columns of numbers, in a line of 80
    std::string text;
    for (const aabb::strategy_kind kind : aabb::strategy_kinds)
        if (const std::string one = text_in_line(kind, name[kind]); !one.empty())
            text += (text.empty() ? "" : " + ") + one;
    return text.empty() || characters(text) > most ? "this composition" : text;
}

}  // namespace aabblab
