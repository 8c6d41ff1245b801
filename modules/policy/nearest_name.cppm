export module aabb.policy:nearest_name;

import aabb.std;

export namespace aabb {

/// The edit distance with transpositions (Damerau 1964): insert, delete, replace, and swap of neighbours cost 1 each.
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

/// The known name closest to an unknown one, the first of equals; empty if in all of them more than a third of the
/// letters of the longer name differ. A name that contains the unknown one ("grid" in "uniform_grid") counts as one
/// edit, and so does one contained in it with at least half of its length.
[[nodiscard]] inline std::string nearest_name(std::string_view unknown, std::span<const std::string> known) {
    std::string_view nearest;
    std::size_t least = std::string_view::npos;
    for (const std::string_view name : known) {
        const auto holds_other = [](std::string_view longer, std::string_view shorter) {
            return shorter.size() > 2 && longer.find(shorter) != std::string_view::npos;  // two letters say little
        };
        const bool holds =
            holds_other(name, unknown) || (2 * name.size() >= unknown.size() && holds_other(unknown, name));
        const std::size_t distance = holds ? 1 : edit_distance(unknown, name);
        if (distance >= least || (!holds && distance > std::max(unknown.size(), name.size()) / 3)) continue;
        least = distance;
        nearest = name;
    }
    return std::string(nearest);
}

/// The error message for an unknown name, with the nearest name; if none is near, with all names, or with the command
/// that lists them if they do not fit into a line.
/// @param listing the command that lists the names, if there is one
[[nodiscard]] inline std::string unknown_name(std::string_view what, std::string_view name,
                                              std::span<const std::string> known, std::string_view listing = {}) {
    std::string text = "unknown " + std::string(what) + " '" + std::string(name) + "'";
    if (const std::string nearest = nearest_name(name, known); !nearest.empty())
        return text + "; did you mean '" + nearest + "'?";
    std::string names;
    for (const std::string& candidate : known) names += (names.empty() ? "" : ", ") + candidate;
    if (!names.empty() && names.size() <= 120) return text + "; expected one of " + names;
    return listing.empty() ? text : text + "; see " + std::string(listing);
}

}  // namespace aabb
