module;
#include <fmt/format.h>

#include <algorithm>
#include <cstddef>
#include <span>
#include <string>
#include <vector>

module aabblab.claims;

import aabblab.statistics;

namespace aabblab {

namespace {

const claim_result* claim_named(std::span<const claim_result> claims, const std::string& id) {
    const auto found = std::ranges::find(claims, id, &claim_result::id);
    return found != claims.end() ? &*found : nullptr;
}

/// The clause on the line of a claim's first primary endpoint.
std::string first_clause(std::span<const claim_result> claims, const std::string& id) {
    const claim_result* claim = claim_named(claims, id);
    if (!claim || !claim->has_primary || !claim->primary.subject) return "not measured";
    std::vector<endpoint> all{claim->primary};
    all.insert(all.end(), claim->secondary.begin(), claim->secondary.end());
    return clause_of(all, *claim->primary.subject);
}

std::size_t count_of(std::span<const claim_result> claims, verdict_kind verdict) {
    return static_cast<std::size_t>(std::ranges::count(claims, verdict, &claim_result::verdict));
}

}  // namespace

std::vector<std::string> headline_of(std::span<const claim_result> claims) {
    const std::size_t others =
        count_of(claims, verdict_kind::no_difference) + count_of(claims, verdict_kind::undecided);
    return {
        "To find which boxes overlap, the paper sorts them with Shell sort and cuts the axes; over insertion sort "
        "without cuts that is " +
            first_clause(claims, "C1") + ".",
        "To find which triangles meet, it compresses the tree of boxes; that is " + first_clause(claims, "C7a") +
            "; in searching it, " + first_clause(claims, "C7b") + ".",
        fmt::format("Of {} claims {} hold, {} hold in part, {} do not hold, and {} show no difference or are open.",
                    claims.size(), count_of(claims, verdict_kind::holds), count_of(claims, verdict_kind::in_part),
                    count_of(claims, verdict_kind::does_not_hold), others)};
}

}  // namespace aabblab
