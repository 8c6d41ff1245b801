module;
#include <cstddef>
#include <string>
#include <utility>
#include <vector>

module aabblab.claims;

import aabblab.conditions;
import aabb.registry;
import aabblab.metrics;
import aabblab.figures;
import aabblab.tables;
import aabblab.statistics;

namespace aabblab {

namespace {

struct method {
    const char* label;
    selection who;
};
const std::vector<method>& methods() {
    static const std::vector<method> all{
        {"insertion sort (traditional)", traditional},
        {"insertion sort, axial cut",
         {{kind::sort, "insertion"}, {kind::partition, "axial_cut"}, {kind::sweep, "one_axis"}}},
        {"Shell sort", {{kind::sort, "shell"}, {kind::partition, "none"}, {kind::sweep, "one_axis"}}},
        {"Shell sort, axial cut (improved)", improved},
        {"insertion sort, incremental",
         {{kind::sort, "insertion"}, {kind::partition, "none"}, {kind::sweep, "incremental"}}}};
    return all;
}

bool drifts_little(const condition& c) {
    return value_of(c.of(), "scene") == "brownian" && value_of(c.of(), "displacement") == "0.1";
}

/// Which half brings the gain: the ratio of every method to the traditional one.
table half_steps(const std::vector<condition>& conditions) {
    const place_columns places(conditions);
    table t{places.head(), {}};
    for (std::size_t i = 1; i < methods().size(); ++i) t.columns.push_back({methods()[i].label});
    for (const condition& c : conditions) {
        std::vector<std::string>& cells = t.rows.emplace_back(places.cells(c.of()));
        for (std::size_t i = 1; i < methods().size(); ++i) {
            const candidate ratio = candidate_of(c, methods()[i].who, traditional, measured("frame_ms"));
            cells.push_back(!ratio.log_ratio.known() ? "-" : ratio_text(endpoint_of(ratio, expectation::less)));
        }
    }
    return t;
}

}  // namespace

claim_result improved_search(const measurements& m) {
    claim_result claim;
    claim.id = "C1";
    claim.claim = "Shell sort with axial cut takes less time in global search than insertion sort without";
    claim.measured = "time a frame, shell + axial_cut over insertion + none, both swept with one_axis";
    claim.experiments = {"figure1"};
    const std::vector<condition>& conditions = m.of("figure1");
    std::vector<candidate> candidates;
    for (const condition& c : conditions) {
        candidates.push_back(candidate_of(c, improved, traditional, measured("frame_ms")));
        candidates.back().primary = drifts_little(c) && value_of(c.of(), "objects") == "10000";
    }
    judge(claim, std::move(candidates));
    claim.tables.push_back(
        {"figure1", "Time a frame as a ratio to the traditional method, with 95 % intervals.", half_steps(conditions)});
    std::vector<const condition*> drifting;
    for (const condition& c : conditions)
        if (drifts_little(c)) drifting.push_back(&c);
    figure f{"figure1",
             "Time of global search against the number of objects: the traditional method, the improved one, and the "
             "half-steps between. Cubes that drift up to a tenth of their edge in a frame; medians and quartiles.",
             {"objects", true, {}},
             {"time a frame (ms)", true, {}},
             {},
             {}};
    for (const method& one : methods())
        f.lines.push_back(series_of(one.label, drifting, "objects", one.who, measured("frame_ms")));
    claim.figures.push_back(f);
    return claim;
}

}  // namespace aabblab
