module;
#include <algorithm>
#include <cstddef>
#include <set>
#include <span>
#include <string>
#include <vector>

module aabblab.tables;

import aabblab.results;

namespace aabblab {

std::vector<name_part> differing_parts(std::span<const contender_name> names) {
    std::vector<name_part> parts;
    for (const name_part& part : composition_parts) {
        std::set<std::string> values;
        for (const contender_name& name : names)
            if (name.engine.empty()) values.insert(name.*part.field);
        if (values.size() > 1) parts.push_back(part);
    }
    return parts;
}

std::vector<column> name_columns_of(std::span<const name_part> differing) {
    std::vector<column> columns{{row_number}};
    for (const name_part& part : differing) columns.push_back({std::string(part.kind), false});
    if (differing.empty()) columns.push_back({"composition", false});
    return columns;
}

std::vector<std::string> name_cells_of(std::span<const name_part> differing, const contender_name& name,
                                       std::size_t rank) {
    std::vector<std::string> cells{std::to_string(rank)};
    if (name.engine.empty())
        for (const name_part& part : differing) cells.push_back(name.*part.field);
    else
        cells.push_back(name.engine);
    if (cells.size() == 1) cells.emplace_back("this composition");
    cells.resize(1 + std::max<std::size_t>(differing.size(), 1));
    return cells;
}

}  // namespace aabblab
