export module aabb.policy:nearest_name;

import aabb.std;

export namespace aabb {

/// The edit distance of two words with transpositions (Damerau 1964): inserting, deleting or replacing a letter, and
/// swapping two adjacent ones, cost 1 each. `row[j]` is the distance of the first i letters of `a` to the first j of
/// `b`; `above` and `before` are the rows of i - 1 and i - 2.
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

/// The known name with the least edit distance to an unknown one, the first of equals, to be suggested to the user.
/// Empty if all distances exceed a third of the longer name's length. A name that contains the unknown one
/// ("uniform_grid" for "grid"), or is contained in it and at least half as long, has the distance 1.
[[nodiscard]] inline std::string nearest_name(std::string_view unknown, std::span<const std::string> known) {
    std::string_view nearest;
    std::size_t least = std::string_view::npos;
    for (const std::string_view name : known) {
        const auto contains = [](std::string_view longer, std::string_view shorter) {
            return shorter.size() > 2 && longer.find(shorter) != std::string_view::npos;  // two letters say little
        };
        const bool one_contains_other =
            contains(name, unknown) || (2 * name.size() >= unknown.size() && contains(unknown, name));
        const std::size_t distance = one_contains_other ? 1 : edit_distance(unknown, name);
        if (distance >= least || (!one_contains_other && distance > std::max(unknown.size(), name.size()) / 3))
            continue;
        least = distance;
        nearest = name;
    }
    return std::string(nearest);
}

/// The error message for an unknown name, with the nearest known name; if none is near, with all names, or with the
/// command that lists them if they do not fit into a line of 120 characters.
/// @param what what the name should denote, such as "sort"
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
