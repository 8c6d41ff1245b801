/// What rows come to in a cell of a table.
module aabblab.extreme:cells;

import :row;
import aabb.std;
import aabblab.tables;

namespace aabblab {

using row_list = std::vector<const extreme_row*>;

/// The rows that have the same text there, in the order in which the texts come first.
[[nodiscard]] std::vector<std::pair<std::string, row_list>> by(std::span<const extreme_row> rows,
                                                               std::string extreme_row::* text);

[[nodiscard]] row_list of(const row_list& rows, contender_role role);
[[nodiscard]] row_list of(const row_list& rows, const std::string& contender);
/// Each once.
[[nodiscard]] std::vector<std::string> contenders_in(std::span<const extreme_row> rows, contender_role role);

/// "-12 +3" are missing and invented; "-" where nothing is.
[[nodiscard]] std::string counts(std::uint64_t missing, std::uint64_t invented);
/// Of those that must be exact: "312 exact", "312 refused", "3 WRONG"; the number is of contenders.
[[nodiscard]] std::string sum_cell(const row_list& rows);
/// Of one contender: "exact", "refused", "WRONG", or what it misses and invents where that is allowed; "-" where it has
/// no part.
[[nodiscard]] std::string cell(const row_list& rows);

/// A row for each text, a column a contender; rows that all get right are left out.
[[nodiscard]] table wrong_table(const std::string& title, std::span<const extreme_row> rows,
                                std::string extreme_row::* text);

}  // namespace aabblab
