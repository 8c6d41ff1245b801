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

selection limited(const std::string& limit, const std::string& segments) {
    return {{kind::partition, "axial_cut:axes=2,limit=" + limit + ",segments=" + segments}};
}

/// Where no box would be cut twice, the limit changes nothing.
bool limit_acts(const condition& c, const std::string& segments) {
    const auto with = c.spread(limited("on", segments), measured("segments_got"));
    const auto without = c.spread(limited("off", segments), measured("segments_got"));
    return !with || !without || with->median != without->median;
}

}  // namespace

draft one_cut_a_box(const measurements& m) {
    draft made;
    claim_result& claim = made.claim;
    claim.id = "C10";
    claim.claim = "Cutting a box more than once on an axis does not pay";
    claim.measured = "time a frame of axial_cut with its limit over that without, where the limit acts";
    claim.expected = expectation::not_more;
    claim.experiments = {"c10"};
    figure f{
        "c10",
        "Time of global search with at most one cut of a box on an axis, over that without the limit (the level "
        "1), with the automatic number of segments, against the number of huge objects, by their edge over the side "
        "of the world; 95 % intervals.",
        {"huge objects", true, {}},
        {"time with the limit over that without", true, {}},
        {},
        {}};
    std::map<std::string, series> by_span;
    for (const condition& c : m.of("c10"))
        for (const char* segments : {"auto", "32"}) {
            if (!limit_acts(c, segments)) continue;
            candidate one = candidate_of(c, limited("on", segments), limited("off", segments), "frame_cpu_ms",
                                         {{"segments", segments}});
            const std::string span = value_of(c.of(), "span");
            const bool automatic = std::string(segments) == "auto";
            const std::string wanted = automatic ? "" : " and 32 segments";
            one.primary = span == "0.5" && value_of(c.of(), "huge") == "10";
            if (!span.empty() && automatic && one.known()) {
                series& s = by_span[span];
                s.label = "edge " + span + " of the world";
                s.points.push_back(point_of(number_of(c.of(), "huge"), one));
            }
            made.candidates.push_back(span.empty()
                                          ? told(std::move(one), "with that limit on mixed sizes" + wanted)
                                          : told(std::move(one), "with at most one cut of huge boxes" + wanted));
        }
    for (const auto& [span, s] : by_span) f.lines.push_back(s);
    f.lines.push_back({"any number of cuts", series_style::level, {{1, 1, 1, 1}}});
    claim.figures.push_back(f);
    return made;
}

}  // namespace aabblab
