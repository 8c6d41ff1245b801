module aabblab.claims;

namespace aabblab {

namespace {

const selection unsplit{{kind::prepare, "none"}};

selection split_by(const std::string& strategy, const std::string& size) {
    return {{kind::prepare, strategy + ":size=" + size}};
}

/// Whether any object is split; all may be shorter than the limit.
bool has_pieces(const condition& c, const selection& split) {
    return median_of(c, split, measured("pieces")).value_or(0) > 0;
}

}  // namespace

/// Drafts C9: the time with objects, boxes or meshes, larger than a limit in mean extents split over that without, per
/// scene and limit that an object exceeds.
draft c9_claim(const measurements& m) {
    draft c9{.claim = {.lead = "Compared with no splitting", .experiments = {"c9", "c9_geometry"}}};
    for (const condition& c : m.conditions_of("c9"))
        for (const char* size : {"4", "8"})
            if (const selection split = split_by("split_large", size); has_pieces(c, split))
                c9.add(endpoint_of(c, split, unsplit, "frame_cpu_ms", {{"split_large", size}}),
                       "in the broad phase where boxes are split");
    for (const condition& c : m.conditions_of("c9_geometry"))
        for (const char* size : {"2", "4", "8"}) {
            const selection split = split_by("split_mesh", size);
            if (!has_pieces(c, split)) continue;
            const auto add = [&](const std::string& metric, const std::string& part, const std::string& subject) {
                c9.add(endpoint_of(c, split, unsplit, metric, {{"split_mesh", size}, {"time of", part}}), subject);
            };
            add("global_cpu_ms", "global search", "in the broad phase where meshes are split");
            add("frame_cpu_ms", "both stages", "in both phases together where meshes are split");
        }
    c9.claim.figures.push_back(
        log_log("c9",
                "Time of the broad phase with boxes longer than four mean edges split, over that without (the line "
                "at 1), against the number of huge boxes, by their edge over the side of the world; 95 % intervals.",
                "huge boxes", "time over that without splitting",
                lines_by_span(c9.endpoints, {{"split_large", "4"}}, "not split")));
    return c9;
}

}  // namespace aabblab
