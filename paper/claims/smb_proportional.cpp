module aabblab.claims;

namespace aabblab {

namespace {

/// The composition of SMB: lists sorted by diminishing increments, every axis cut.
const selection smb{{kind::sort, "shell"}, {kind::partition, "axial_cut:axes=3"}, {kind::sweep, "one_axis"}};

/// SMB's cost per box (Li, Feng and Owen 2006), in time or bytes, where a factor is large over that where it is small.
/// Two conditions share no repeats, so the means are divided, instead of times pair by pair.
endpoint cost_ratio(const condition& large, const condition& small, const std::string& factor, quantity what) {
    const bool is_time = what == quantity::time;
    const row_value cost_per_box =
        per_object(is_time ? measured("frame_cpu_ms") : bytes_of({"projections", "partition", "sweep"}));
    endpoint ratio;
    ratio.where = large.scene();
    ratio.where.emplace_back("quantity", is_time ? "time" : "memory");
    ratio.where.emplace_back("over", factor + " " + value_of(small.scene(), factor));
    ratio.log_ratios = {difference_of_means(large.logs(smb, cost_per_box), small.logs(smb, cost_per_box))};
    ratio.source = large.experiment() + (is_time ? ": frame_cpu_ms" : ": bytes") + " an object of " + text_of(smb);
    return ratio;
}

}  // namespace

/// Drafts SMB's claim: the cost per box over that at the least value of a factor. A cost in O(N) has the ratio 1.
draft smb_claim(const measurements& m) {
    draft drafted{.claim = {.lead = "Per box", .experiments = {"smb_objects", "smb_density", "smb_sizes"}}};
    const std::array<std::string, 4> varied[] = {
        {"smb_objects", "objects", "with 100,000 boxes, ",
         "compared with 1,000 boxes, in a world that grows with their number"},
        {"smb_density", "density", "at a volume fraction of 0.1, ",
         "compared with a volume fraction of 0.01, on 10,000 boxes"},
        {"smb_sizes", "ratio", "at an edge ratio of 10, ",
         "compared with an edge ratio (longest over shortest edge) of 1.01, on 10,000 boxes"}};
    for (const auto& [experiment, factor, greatest, compared] : varied) {
        const std::vector<condition>& conditions = m.conditions_of(experiment);
        // The outcomes of several conditions state the values of the factor; that of a single one does not.
        const std::string subject = conditions.size() == 2 ? greatest + compared : compared;
        const auto least =
            std::ranges::min_element(conditions, {}, [&](const condition& c) { return number_of(c.scene(), factor); });
        for (const quantity what : {quantity::time, quantity::bytes})
            for (const condition& c : conditions)
                if (&c != &*least) drafted.add(cost_ratio(c, *least, factor, what), subject, factor, what);
    }
    figure& f = drafted.claim.figures.emplace_back(
        log_log("smb",
                "Time of the broad phase per box against the number of boxes, with every axis cut and without a cut. "
                "A horizontal line is O(N). Medians and quartiles.",
                "objects", "time per frame and box (ms)"));
    const method methods[] = {{"every axis cut", smb}, {"no cut", uncut}};
    if (const std::vector<condition>& conditions = m.conditions_of("smb_objects"); !conditions.empty())
        f.lines = series_of(methods, matching(conditions, {}), objects_of, per_object(measured("frame_cpu_ms")));
    return drafted;
}

}  // namespace aabblab
