module;
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

draft fewer_box_tests(const measurements& m) {
    draft made;
    claim_result& claim = made.claim;
    claim.id = "C12";
    claim.claim = "The axial cut avoids needless tests of boxes";
    claim.measured = "tests of two boxes in a frame, axial_cut over none, both with shell";
    claim.experiments = {"figure1", "three_lists"};
    const selection uncut{{kind::sort, "shell"}, {kind::partition, "none"}, {kind::sweep, "one_axis"}};
    std::vector<const condition*> drifting;
    for (const condition& c : m.of("figure1")) {
        const bool drifts = is_brownian(c);
        if (drifts && value_of(c.of(), "displacement") == "0.1") drifting.push_back(&c);
        made.candidates.push_back(told(candidate_of(c, improved, uncut, "box_tests"),
                                       drifts ? "on drifting boxes" : "in other scenes", "", quantity::box_tests));
        made.candidates.back().primary = is_drifting(c);
    }
    for (const condition& c : m.of("three_lists")) {
        made.candidates.push_back(
            told(candidate_of(c, improved.with(kind::sweep, "all_axes"), uncut.with(kind::sweep, "all_axes"),
                              "box_tests", {{"sweep", "all_axes"}}),
                 "with three sorted lists", "", quantity::box_tests));
        made.candidates.back().primary = is_drifting(c);
    }
    figure f{"c12",
             "Tests of two boxes in a frame against the number of objects, with the axial cut and without.",
             {"objects", true, {}},
             {"box tests a frame", true, {}},
             {},
             {}};
    f.lines = {series_of("no cut", drifting, "objects", uncut, measured("box_tests")),
               series_of("axial cut", drifting, "objects", improved, measured("box_tests"))};
    claim.figures.push_back(f);
    return made;
}

}  // namespace aabblab
