module;
#include <algorithm>
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

/// As SMB has it: lists sorted by diminishing increments, every axis cut.
const selection smb{{kind::sort, "shell"}, {kind::partition, "axial_cut:axes=3"}, {kind::sweep, "one_axis"}};
const selection uncut{{kind::sort, "shell"}, {kind::partition, "none"}, {kind::sweep, "one_axis"}};

/// A box's share in one condition over that in another, both with the same method.
/// @param what "frame_cpu_ms", or "bytes" of all parts
candidate compared(const condition& large, const condition& small, const std::string& factor, const std::string& what) {
    const bool is_time = what == "frame_cpu_ms";
    const row_value a_box = an_object(is_time ? measured(what) : bytes_of({"projections", "partition", "sweep"}));
    candidate made;
    made.where = large.of();
    made.where.emplace_back("quantity", is_time ? "time" : "memory");
    made.where.emplace_back("over", factor + " " + value_of(small.of(), factor));
    made.log_ratios = {between(large.logs(smb, a_box), small.logs(smb, a_box))};
    made.compared = is_time ? quantity::time : quantity::bytes;
    made.source = large.experiment() + ": " + what + " an object of " + text_of(smb);
    return made;
}

}  // namespace

draft insensitive_search(const measurements& m) {
    draft made;
    claim_result& claim = made.claim;
    claim.id = "C13";
    claim.claim =
        "Sorted and cut lists take time and memory in proportion to N, whatever sizes, space and density, up to ten "
        "times";
    claim.measured =
        "time a frame and box, and bytes a box, of shell + axial_cut on three axes with more boxes, denser ones, or "
        "sizes more unlike, over those with the least (SMB: Li, Feng and Owen 2006)";
    claim.expected = expectation::not_more;
    claim.lead = "For each box";
    claim.experiments = {"smb_objects", "smb_density", "smb_sizes"};
    const struct {
        const char* experiment;
        const char* factor;
        const char* subject;
    } lines[] = {{"smb_objects", "objects", "with more boxes"},
                 {"smb_density", "density", "in a denser world"},
                 {"smb_sizes", "ratio", "with sizes more unlike"}};
    figure f{"c13",
             "Time of global search a box against the number of boxes, with every axis cut and without a cut; a level "
             "line is O(N). Medians and quartiles.",
             {"objects", true, {}},
             {"time a frame and box (ms)", true, {}},
             {},
             {}};
    for (const auto& [experiment, factor, subject] : lines) {
        const std::vector<condition>& conditions = m.of(experiment);
        if (conditions.empty()) continue;
        const condition& least =
            *std::ranges::min_element(conditions, {}, [&](const condition& c) { return number_of(c.of(), factor); });
        const condition& most =
            *std::ranges::max_element(conditions, {}, [&](const condition& c) { return number_of(c.of(), factor); });
        for (const char* what : {"frame_cpu_ms", "bytes"})
            for (const condition& c : conditions) {
                if (&c == &least) continue;
                candidate one = compared(c, least, factor, what);
                if (!one.known()) continue;
                // What is allocated grows in steps, so that ratios of bytes say less.
                one.primary = &c == &most && one.compared == quantity::time;
                const quantity compared_here = one.compared;
                made.candidates.push_back(told(std::move(one), subject, factor, compared_here));
            }
        if (std::string(factor) != "objects") continue;
        std::vector<const condition*> all;
        for (const condition& c : conditions) all.push_back(&c);
        f.lines = {series_of("every axis cut", all, "objects", smb, an_object(measured("frame_cpu_ms"))),
                   series_of("no cut", all, "objects", uncut, an_object(measured("frame_cpu_ms")))};
    }
    claim.figures.push_back(f);
    return made;
}

}  // namespace aabblab
