module;
#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <string>
#include <utility>
#include <vector>

module aabblab.claims;

import aabblab.conditions;
import aabb.registry;
import aabblab.metrics;
import aabblab.figures;
import aabblab.numbers;
import aabblab.tables;
import aabblab.statistics;

namespace aabblab {

namespace {

constexpr const char* compressed = "compressed:leaf_test=triangle_box";

struct method {
    const char* label;
    selection who;
};
const std::vector<method>& methods() {
    static const std::vector<method> all{{"traditional in both stages", traditional.with(kind::tree, "canonical")},
                                         {"improved global search", improved.with(kind::tree, "canonical")},
                                         {"improved local detection", traditional.with(kind::tree, compressed)},
                                         {"improved in both", improved.with(kind::tree, compressed)}};
    return all;
}

table half_steps(const std::vector<condition>& conditions) {
    table t{{{"meshes", false}, {"objects"}}, {}};
    for (std::size_t i = 1; i < methods().size(); ++i) t.columns.push_back({methods()[i].label});
    t.columns.push_back({"global search, % of traditional time"});
    for (const condition& c : conditions) {
        std::vector<std::string>& cells = t.rows.emplace_back(std::vector{mesh_of(c), value_of(c.of(), "objects")});
        for (std::size_t i = 1; i < methods().size(); ++i) {
            const candidate ratio = candidate_of(c, methods()[i].who, methods()[0].who, "frame_cpu_ms");
            cells.push_back(!ratio.known() ? "-" : ratio_text(endpoint_of(ratio, expectation::less)));
        }
        const auto share = c.spread(methods()[0].who, measured("global_share"));
        cells.push_back(share ? three_digits(share->median) : "-");
    }
    return t;
}

}  // namespace

/// Simple models far apart, as many as there are in both sizes.
static bool is_far_apart(const condition& c) {
    return value_of(c.of(), "density") == "0.001" && value_of(c.of(), "objects") == "100000";
}

bool is_primary_of_c11(const condition& c) {
    // The larger crowd of models that touch.
    const std::string objects = value_of(c.of(), "objects");
    return value_of(c.of(), "density") == "0.3" && objects == "60";
}

draft whole_algorithm(const measurements& m) {
    draft made;
    claim_result& claim = made.claim;
    claim.id = "C11";
    claim.claim = "The whole improved algorithm takes less time than the traditional one on the same models";
    claim.measured = "time a frame of both stages, shell + axial_cut + compressed over insertion + none + canonical";
    claim.experiments = {"c11"};
    const std::vector<condition>& conditions = m.of("c11");
    for (const condition& c : conditions) {
        const std::string density = value_of(c.of(), "density");
        made.candidates.push_back(told(candidate_of(c, methods()[3].who, methods()[0].who, "frame_cpu_ms"),
                                       density == "0.3"    ? "where detailed models touch"
                                       : density == "0.05" ? "with many small models"
                                                           : "with simple models far apart",
                                       "objects"));
        made.candidates.back().primary = is_primary_of_c11(c) || is_far_apart(c);
    }
    if (conditions.empty()) return made;
    const auto share_of = [](const condition& c) {
        const auto share = c.spread(methods()[0].who, measured("global_share"));
        return share ? fmt::format("{:.2g} %", share->median) : "an unknown share";
    };
    for (const condition& c : conditions)
        if (is_primary_of_c11(c))
            claim.remark =
                "Of the traditional method's time global search takes " + share_of(c) + " where models touch";
        else if (is_far_apart(c) && !claim.remark.empty())
            claim.remark += ", and " + share_of(c) + " with 100,000 simple ones far apart";
    if (!claim.remark.empty()) claim.remark += ".";
    claim.tables.push_back(
        {"c11_stages", "Time a frame of both stages over that of the traditional method.", half_steps(conditions)});
    std::vector<const condition*> sparse;
    for (const condition& c : conditions)
        if (mesh_of(c) == mesh_of(conditions.back())) sparse.push_back(&c);
    figure f{"c11",
             "Time of both stages against the number of objects, simple models far apart: traditional, improved, and "
             "each stage improved alone; medians and quartiles.",
             {"objects", true, {}},
             {"time a frame (ms)", true, {}},
             {},
             {}};
    for (const method& one : methods())
        f.lines.push_back(series_of(one.label, sparse, "objects", one.who, measured("frame_cpu_ms")));
    claim.figures.push_back(f);
    return made;
}

}  // namespace aabblab
