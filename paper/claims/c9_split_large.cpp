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

selection splitting(const std::string& size) {
    return {{kind::prepare, "split_large:size=" + size}};
}

/// No box may be as long as that.
bool splits_something(const condition& c, const std::string& size) {
    const auto pieces = c.spread(splitting(size), measured("pieces"));
    return pieces && pieces->median > 0;
}

}  // namespace

claim_result large_objects_split(const measurements& m) {
    claim_result claim;
    claim.id = "C9";
    claim.claim = "Splitting large objects before the search pays off";
    claim.measured = "time a frame with split_large, where it splits something, over that without, both with axial_cut";
    claim.experiments = {"c9"};
    std::vector<candidate> candidates;
    figure f{"c9",
             "Time of global search with objects split that are longer than four mean extents, over that without (the "
             "level 1), against the number of huge objects, by their edge over the side of the world; 95 % intervals.",
             {"huge objects", true, {}},
             {"time over that without splitting", true, {}},
             {},
             {}};
    std::map<std::string, series> by_span;
    for (const condition& c : m.of("c9"))
        for (const char* size : {"4", "8"}) {
            if (!splits_something(c, size)) continue;
            candidates.push_back(
                candidate_of(c, splitting(size), whole, measured("frame_ms"), {{"split_large", size}}));
            candidate& one = candidates.back();
            const std::string span = value_of(c.of(), "span");
            one.primary = span == "0.5" && value_of(c.of(), "huge") == "10" && std::string(size) == "4";
            if (span.empty() || std::string(size) != "4" || !one.log_ratio.known()) continue;
            series& s = by_span[span];
            s.label = "edge " + span + " of the world";
            s.points.push_back(point_of(number_of(c.of(), "huge"), one));
        }
    judge(claim, std::move(candidates));
    for (const auto& [span, s] : by_span) f.lines.push_back(s);
    f.lines.push_back({"not split", series_style::level, {{1, 1, 1, 1}}});
    claim.figures.push_back(f);
    return claim;
}

}  // namespace aabblab
