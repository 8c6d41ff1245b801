module;
#include <fmt/format.h>

#include <algorithm>
#include <string>
#include <vector>

module aabblab.claims;

import aabblab.conditions;
import aabb.registry;
import aabblab.metrics;
import aabblab.tables;
import aabblab.statistics;

namespace aabblab {

namespace {

/// A composition, and the same with a default written out.
struct twins {
    selection plain;
    selection written_out;
};
const std::vector<twins>& compositions() {
    static const std::vector<twins> all{
        {traditional, {{kind::sort, "insertion"}, {kind::partition, "none"}, {kind::sweep, "one_axis:axis=auto"}}},
        {improved,
         {{kind::sort, "shell:gaps=ciura"}, {kind::partition, "axial_cut:axes=2"}, {kind::sweep, "one_axis"}}}};
    return all;
}

}  // namespace

named_table null_control(const measurements& m) {
    std::vector<endpoint> found;
    for (const condition& c : m.of("null_control"))
        for (const auto& [plain, written_out] : compositions()) {
            const candidate ratio = candidate_of(c, written_out, plain, "frame_cpu_ms",
                                                 {{"composition", plain[kind::sort] + " + " + plain[kind::partition]}});
            if (ratio.known()) found.push_back(endpoint_of(ratio, expectation::less));
        }
    // A direction alone is found in one of twenty by chance.
    const auto is_difference = [](const endpoint& e) {
        return e.range.low > 1 + equivalence_band || e.range.high < 1 / (1 + equivalence_band);
    };
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
                    found, [&](const endpoint& e) { return !is_difference(e) && e.found != support::no_difference; })),
            t};
}

}  // namespace aabblab
