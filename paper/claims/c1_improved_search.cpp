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

/// The classic sort and sweep, which keeps its pairs from frame to frame.
const selection incremental{{kind::sort, "insertion"}, {kind::partition, "none"}, {kind::sweep, "incremental"}};

struct method {
    const char* label;
    selection who;
};
const std::vector<method>& methods() {
    static const std::vector<method> all{
        {"insertion sort (traditional)", traditional},
        {"insertion sort, axial cut",
         {{kind::sort, "insertion"}, {kind::partition, "axial_cut:axes=2"}, {kind::sweep, "one_axis"}}},
        {"Shell sort", {{kind::sort, "shell"}, {kind::partition, "none"}, {kind::sweep, "one_axis"}}},
        {"Shell sort, axial cut (improved)", improved},
        {"insertion sort, incremental", incremental}};
    return all;
}

/// Both arms with the paper's three lists, each sorted and swept.
const selection traditional_lists = traditional.with(kind::sweep, "all_axes");
const selection improved_lists = improved.with(kind::sweep, "all_axes");

bool drifts_little(const condition& c) {
    return is_brownian(c) && value_of(c.of(), "displacement") == "0.1";
}
bool is_large(const condition& c) {
    return value_of(c.of(), "objects") == "10000";
}

/// Where a scene that is not the drifting one is told.
std::string subject_of(const condition& c) {
    const std::string scene = value_of(c.of(), "scene");
    return scene == "clustered"     ? "in clusters"
           : scene == "mixed_sizes" ? "on boxes of mixed sizes"
           : scene == "one_huge"    ? "beside one huge box"
           : scene == "still"       ? "where nothing moves"
                                    : "where every box jumps";
}

/// Which half brings the gain: the ratio of every method to the traditional one.
table half_steps(const std::vector<condition>& conditions) {
    const place_columns places(conditions);
    table t{places.head(), {}};
    for (std::size_t i = 1; i < methods().size(); ++i) t.columns.push_back({methods()[i].label});
    for (const condition& c : conditions) {
        std::vector<std::string>& cells = t.rows.emplace_back(places.cells(c.of()));
        for (std::size_t i = 1; i < methods().size(); ++i) {
            const candidate ratio = candidate_of(c, methods()[i].who, traditional, "frame_cpu_ms");
            cells.push_back(!ratio.known() ? "-" : ratio_text(endpoint_of(ratio, expectation::less)));
        }
    }
    return t;
}

}  // namespace

draft improved_search(const measurements& m) {
    draft made;
    claim_result& claim = made.claim;
    claim.id = "C1";
    claim.claim = "Shell sort with axial cut takes less time in global search than insertion sort without";
    claim.measured =
        "time a frame of shell + axial_cut over that of insertion + none, both swept with one_axis, or both with "
        "all_axes; and over that of insertion + incremental";
    claim.experiments = {"figure1", "three_lists"};
    const std::vector<condition>& conditions = m.of("figure1");
    const auto add = [&](candidate c, bool primary) {
        c.primary = primary;
        made.candidates.push_back(std::move(c));
    };
    for (const condition& c : conditions)
        if (drifts_little(c))
            add(told(candidate_of(c, improved, traditional, "frame_cpu_ms"), "on drifting boxes", "objects"),
                is_large(c));
    for (const condition& c : conditions)
        if (is_brownian(c) && is_large(c) && !drifts_little(c))
            add(told(candidate_of(c, improved, traditional, "frame_cpu_ms"), "on 10,000 drifting boxes",
                     "displacement"),
                false);
    for (const condition& c : m.of("three_lists"))
        add(told(candidate_of(c, improved_lists, traditional_lists, "frame_cpu_ms", {{"sweep", "all_axes"}}),
                 "with three sorted lists", "displacement"),
            is_drifting(c));
    for (const condition& c : conditions)
        if (is_brownian(c) && is_large(c))
            add(told(candidate_of(c, improved, incremental, "frame_cpu_ms", {{"over", "incremental"}}),
                     "against the classic incremental sweep", "displacement"),
                value_of(c.of(), "displacement") == "0.001");
    for (const condition& c : conditions)
        if (!is_brownian(c)) add(told(candidate_of(c, improved, traditional, "frame_cpu_ms"), subject_of(c)), false);
    for (const condition& c : conditions)
        if (is_drifting(c))
            made.beside = {
                told(candidate_of(c, methods()[1].who, traditional, "frame_cpu_ms"),
                     "with the cut alone at 10,000 boxes"),
                told(candidate_of(c, methods()[2].who, traditional, "frame_cpu_ms"), "with Shell sort alone")};
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
        f.lines.push_back(series_of(one.label, drifting, "objects", one.who, measured("frame_cpu_ms")));
    claim.figures.push_back(f);
    return made;
}

}  // namespace aabblab
