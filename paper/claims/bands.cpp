module;
#include <fmt/format.h>

module aabblab.claims;

namespace aabblab {

namespace {

constexpr std::array<double, 4> bands{0, 0.03, 0.05, 0.1};

}  // namespace

named_table bands_table(std::span<const draft> drafts) {
    table t{{{"", false}, {"claim", false}}, {}};
    for (const draft& d : drafts) t.rows.push_back({d.claim.id, d.claim.claim});
    for (const double band : bands) {
        t.columns.push_back({fmt::format("band {:.0f} %", 100 * band), false});
        const std::vector<std::vector<endpoint>> endpoints = decided(drafts, band);
        for (std::size_t i = 0; i < drafts.size(); ++i) {
            claim_result claim;
            claim.verdict = verdict_of(endpoints[i]);
            t.rows[i].push_back(text_of(claim));
        }
    }
    return {"bands", "The verdicts, if ratios that differ from 1 by no more than so much were no difference.", t};
}

}  // namespace aabblab
