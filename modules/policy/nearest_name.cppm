module;
#include <algorithm>
#include <cassert>
#include <cstddef>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

export module aabb.policy:nearest_name;

export namespace aabb {

/// Edit distance (insert, delete, replace, swap of neighbours count 1 each).
[[nodiscard]] inline std::size_t edit_distance(std::string_view a, std::string_view b) {
    std::vector<std::size_t> before(b.size() + 1), above(b.size() + 1), row(b.size() + 1);
    for (std::size_t j = 0; j <= b.size(); ++j) above[j] = j;
    for (std::size_t i = 1; i <= a.size(); ++i) {
        row[0] = i;
        for (std::size_t j = 1; j <= b.size(); ++j) {
            row[j] = std::min({above[j] + 1, row[j - 1] + 1, above[j - 1] + (a[i - 1] != b[j - 1])});
            if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1])
                row[j] = std::min(row[j], before[j - 2] + 1);
        }
        std::swap(before, above);
        std::swap(above, row);
    }
    return above[b.size()];
}

/// The known name closest to an unknown one; the first of equals. A name that holds the unknown one whole ("grid" in
/// "uniform_grid") is as near as a single slip. `known` must not be empty.
[[nodiscard]] inline std::string nearest_name(std::string_view unknown, std::span<const std::string> known) {
    assert(!known.empty());
    return *std::ranges::min_element(known, {}, [&](const std::string& name) {
        const bool holds = unknown.size() > 2 && name.find(unknown) != std::string::npos;
        return holds ? std::size_t{1} : edit_distance(unknown, name);
    });
}

/// The sentence for a name nobody knows: what it was meant to be, and which name is nearest.
[[nodiscard]] inline std::string unknown_name(std::string_view what, std::string_view name,
                                              std::span<const std::string> known) {
    std::string text = "unknown " + std::string(what) + " '" + std::string(name) + "'";
    if (!known.empty()) text += "; did you mean '" + nearest_name(name, known) + "'?";
    return text;
}

}  // namespace aabb
