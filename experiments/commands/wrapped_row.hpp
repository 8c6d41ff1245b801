#pragma once

#include <algorithm>
#include <cstddef>
#include <sstream>
#include <string>
#include <vector>

import aabblab.output;
import aabblab.tables;

namespace aabblab {

/// Adds a row of which one cell is broken into lines of at most so many bytes; the others stand in the first of them.
inline void add_wrapped_row(table& t, std::vector<std::string> cells, std::size_t column, std::size_t room) {
    std::istringstream lines(wrapped(cells[column], room));
    while (std::getline(lines, cells[column])) {
        t.rows.push_back(cells);
        std::ranges::fill(cells, "");
    }
}

}  // namespace aabblab
