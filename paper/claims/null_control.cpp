module;
#include <fmt/format.h>

module aabblab.claims;

namespace aabblab {

namespace {

/// From here on a direction is a difference: alone, it is found in one of twenty by chance.
bool is_difference(const endpoint& e) {
    return e.range.low > 1 + equivalence_band || e.range.high < 1 / (1 + equivalence_band);
}

}  // namespace

named_table null_control(const measurements& m) {
    // A composition, and the same with a default written out.
    const std::pair<selection, selection> twins[] = {{traditional, traditional.with(kind::sweep, "one_axis:axis=auto")},
                                                     {improved, improved.with(kind::sort, "shell:gaps=ciura")}};
    std::vector<endpoint> found;
    for (const condition& c : m.of("null_control"))
        for (const auto& [plain, written_out] : twins) {
            const candidate ratio = candidate_of(c, written_out, plain, "frame_cpu_ms",
                                                 {{"composition", plain[kind::sort] + " + " + plain[kind::partition]}});
            if (ratio.known()) found.push_back(endpoint_of(ratio, expectation::less));
        }
    const table t = endpoint_table(found, [&](const endpoint& e) {
        return is_difference(e)                    ? std::string("a difference")
               : e.found == support::no_difference ? text_of(e.found)
                                                   : "undecided";
    });
    if (found.empty()) return {"null_control", "There are no measurements of a null control.", t};
    const auto without_one =
        std::ranges::count_if(found, [](const endpoint& e) { return e.range.low > 1 || e.range.high < 1; });
    return {"null_control",
            fmt::format(
                "Null control: time a frame of a composition under two names. Of {} intervals {} miss 1, where one in "
                "twenty would be expected to. Each taken alone, {} are decided as a difference, {} as none, "
                "and {} are undecided.",
                found.size(), without_one, std::ranges::count_if(found, is_difference),
                std::ranges::count(found, support::no_difference, &endpoint::found),
                std::ranges::count_if(
                    found, [](const endpoint& e) { return !is_difference(e) && e.found != support::no_difference; })),
            t};
}

}  // namespace aabblab
