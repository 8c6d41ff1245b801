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

claim_result fewer_box_tests(const measurements& m) {
    claim_result claim;
    claim.id = "C12";
    claim.claim = "The axial cut avoids needless tests of boxes";
    claim.measured = "tests of two boxes in a frame, axial_cut over none, both with shell and one_axis";
    claim.experiments = {"figure1"};
    const selection uncut{{kind::sort, "shell"}, {kind::partition, "none"}, {kind::sweep, "one_axis"}};
    std::vector<candidate> candidates;
    std::vector<const condition*> drifting;
    for (const condition& c : m.of("figure1")) {
        const bool little = value_of(c.of(), "scene") == "brownian" && value_of(c.of(), "displacement") == "0.1";
        if (little) drifting.push_back(&c);
        candidates.push_back(candidate_of(c, improved, uncut, measured("box_tests")));
        candidates.back().primary = little && value_of(c.of(), "objects") == "10000";
    }
    judge(claim, std::move(candidates));
    figure f{"c12",
             "Tests of two boxes in a frame against the number of objects, with the axial cut and without.",
             {"objects", true, {}},
             {"box tests a frame", true, {}},
             {},
             {}};
    f.lines = {series_of("no cut", drifting, "objects", uncut, measured("box_tests")),
               series_of("axial cut", drifting, "objects", improved, measured("box_tests"))};
    claim.figures.push_back(f);
    return claim;
}

}  // namespace aabblab
