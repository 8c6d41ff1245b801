module aabblab.claims;

import aabblab.fmt;

namespace aabblab {

namespace {

const std::vector<method> methods{{"traditional in both phases", traditional.with(kind::tree, "canonical")},
                                  {"improved broad phase", improved.with(kind::tree, "canonical")},
                                  {"improved narrow phase", traditional.with(kind::tree, compressed)},
                                  {"improved in both", improved.with(kind::tree, compressed)}};

/// The broad phase's share of the traditional method's time, in percent.
std::optional<double> global_share(const condition& c) {
    return median_of(c, methods[0].tested, measured("global_share"));
}

/// One row per condition (a scene of moving meshes): each method's time over that of the traditional one, which shows
/// the gain of each change alone, and the share of the broad phase in the traditional time.
table table_of_changes(const std::vector<condition>& conditions) {
    table t = empty_table({"meshes"}, {"objects"});
    for (const condition& c : conditions) t.rows.push_back({mesh_of(c), number_text(value_of(c.scene(), "objects"))});
    add_ratios(t, conditions, methods);
    t.columns.push_back({"broad phase, % of traditional time"});
    for (std::size_t i = 0; i < conditions.size(); ++i) t.rows[i].push_back(digits_cell(global_share(conditions[i])));
    return t;
}

std::string share_text(const condition& c) {
    const std::optional<double> share = global_share(c);
    return share ? fmt::format("{:.2g} %", *share) : "an unknown share";
}

/// The condition with simple models, which both experiment sizes have.
const factors far_apart{{"density", "0.001"}, {"objects", "100000"}};

}  // namespace

/// Drafts C11: the time with both phases improved over that with both traditional, in three kinds of scenes, which
/// differ in the share of the broad phase. The remark states this share in the two scenes that decide the verdict.
draft c11_claim(const measurements& m) {
    draft c11{.claim = {.lead = "Improved in both phases, compared with traditional in both", .experiments = {"c11"}}};
    claim_result& claim = c11.claim;
    const std::vector<condition>& conditions = m.conditions_of("c11");
    for (const condition& c : conditions) {
        const std::string density = value_of(c.scene(), "density");
        c11.add(endpoint_of(c, methods.back().tested, methods.front().tested, "frame_cpu_ms"),
                density == "0.3"    ? "where detailed models touch"
                : density == "0.05" ? "with many small models"
                                    : "with simple models far apart",
                "objects");
        if (matches(c.scene(), large_crowd))
            claim.remark = "The traditional method spends " + share_text(c) +
                           " of its time in the broad phase where 60 models touch";
        else if (matches(c.scene(), far_apart) && !claim.remark.empty())
            claim.remark += ", and " + share_text(c) + " with 100,000 simple ones far apart";
    }
    if (conditions.empty()) return c11;
    if (!claim.remark.empty()) claim.remark += ".";
    claim.tables.push_back({"c11_stages", "Time per frame of both phases over that of the traditional method.",
                            table_of_changes(conditions)});
    claim.figures.push_back(log_log(
        "c11",
        "Time of both phases against the number of objects, for simple models far apart: traditional, improved, "
        "and each phase improved alone; medians and quartiles.",
        "objects", "time per frame (ms)",
        series_of(methods, matching(conditions, {{"meshes", mesh_of(conditions.back())}}), objects_of,
                  measured("frame_cpu_ms"))));
    return c11;
}

}  // namespace aabblab
