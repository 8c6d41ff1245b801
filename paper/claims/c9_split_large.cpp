module;
#include <map>
#include <string>
#include <utility>
#include <vector>

module aabblab.claims;

import aabblab.conditions;
import aabb.registry;
import aabblab.metrics;
import aabblab.figures;
import aabblab.statistics;

namespace aabblab {

namespace {

const selection whole{{kind::prepare, "none"}};

selection splitting(const std::string& strategy, const std::string& size) {
    return {{kind::prepare, strategy + ":size=" + size}};
}

/// No box may be as long as that.
bool splits_something(const condition& c, const selection& who) {
    const auto pieces = c.spread(who, measured("pieces"));
    return pieces && pieces->median > 0;
}

}  // namespace

draft large_objects_split(const measurements& m) {
    draft made;
    claim_result& claim = made.claim;
    claim.id = "C9";
    claim.claim = "Splitting large objects before the search pays off";
    claim.measured =
        "time of global search a frame with large objects split over that without, both with axial_cut: their boxes, "
        "or "
        "the geometry of their meshes";
    claim.experiments = {"c9", "c9_geometry"};
    figure f{"c9",
             "Time of global search with boxes split that are longer than four mean extents, over that without (the "
             "level 1), against the number of huge boxes, by their edge over the side of the world; 95 % intervals.",
             {"huge boxes", true, {}},
             {"time over that without splitting", true, {}},
             {},
             {}};
    std::map<std::string, series> by_span;
    for (const condition& c : m.of("c9"))
        for (const char* size : {"4", "8"}) {
            if (!splits_something(c, splitting("split_large", size))) continue;
            candidate one =
                candidate_of(c, splitting("split_large", size), whole, "frame_cpu_ms", {{"split_large", size}});
            const std::string span = value_of(c.of(), "span");
            one.primary = span == "0.5" && value_of(c.of(), "huge") == "10" && std::string(size) == "4";
            if (!span.empty() && std::string(size) == "4" && one.known()) {
                series& s = by_span[span];
                s.label = "edge " + span + " of the world";
                s.points.push_back(point_of(number_of(c.of(), "huge"), one));
            }
            made.candidates.push_back(told(std::move(one), "where boxes are split"));
        }
    for (const condition& c : m.of("c9_geometry"))
        for (const char* size : {"2", "4", "8"}) {
            if (!splits_something(c, splitting("split_mesh", size))) continue;
            const auto add = [&](const std::string& metric, const std::string& of, const std::string& subject) {
                candidate one = candidate_of(c, splitting("split_mesh", size), whole, metric,
                                             {{"split_mesh", size}, {"time of", of}});
                one.primary = metric == "global_cpu_ms" && std::string(size) == "4" && value_of(c.of(), "huge") == "2";
                made.candidates.push_back(told(std::move(one), subject));
            };
            add("global_cpu_ms", "global search", "of global search where meshes are split");
            add("frame_cpu_ms", "both stages", "of both stages there");
        }
    for (const auto& [span, s] : by_span) f.lines.push_back(s);
    f.lines.push_back({"not split", series_style::level, {{1, 1, 1, 1}}});
    claim.figures.push_back(f);
    return made;
}

}  // namespace aabblab
