module aabblab.claims;

namespace aabblab {

namespace {

selection with_limit(const std::string& limit, const std::string& segments) {
    return {{kind::partition, "axial_cut:axes=2,limit=" + limit + ",segments=" + segments}};
}

/// Whether the limit changes the cut: no box might be cut twice anyway.
bool limit_changes_cut(const condition& c, const std::string& segments) {
    const auto with = median_of(c, with_limit("on", segments), measured("segments_got"));
    const auto without = median_of(c, with_limit("off", segments), measured("segments_got"));
    return !with || !without || *with != *without;
}

}  // namespace

/// Drafts C10: the time with at most one cut per box and axis over that without this limit, per number of segments and
/// scene of huge boxes, which several cuts would cross.
draft c10_claim(const measurements& m) {
    draft c10{
        .claim = {.lead = "With segments widened until no box spans a whole one, compared with segments not widened",
                  .experiments = {"c10"}}};
    for (const condition& c : m.conditions_of("c10"))
        for (const std::string segments : {"auto", "32"}) {
            if (!limit_changes_cut(c, segments)) continue;
            const bool is_mixed = value_of(c.scene(), "scene") == "mixed_sizes";
            c10.add(
                endpoint_of(c, with_limit("on", segments), with_limit("off", segments), "frame_cpu_ms",
                            {{"segments", segments}}),
                std::string(is_mixed ? "on boxes of mixed sizes" : "on huge boxes") +
                    (segments == "auto" ? " with the automatic number of segments" : " with 32 segments requested"));
        }
    c10.claim.figures.push_back(log_log(
        "c10",
        "Time of the broad phase with at most one cut per box and axis, over that without the limit (the line at 1), "
        "with the automatic number of segments, against the number of huge objects, by their edge over the side "
        "of the world; 95 % intervals.",
        "huge objects", "time with the limit over that without",
        lines_by_span(c10.endpoints, {{"segments", "auto"}}, "any number of cuts")));
    return c10;
}

}  // namespace aabblab
