module;
#include <fmt/format.h>

module aabblab.claims;

namespace aabblab {

namespace {

const claim_result* claim_named(std::span<const claim_result> claims, const std::string& id) {
    const auto found = std::ranges::find(claims, id, &claim_result::id);
    return found != claims.end() ? &*found : nullptr;
}

/// What the classic sweep makes of the paper's own premise, that objects hardly move.
std::string against_classic_sweep(std::span<const claim_result> claims) {
    const claim_result* claim = claim_named(claims, "C1");
    if (!claim) return "";
    for (const endpoint& e : primaries_of(*claim))
        if (value_of(e.where, "over") == "incremental") return "; where objects hardly move, " + clause_of({&e, 1}, e);
    return "";
}

/// The clause on the line of a claim's first primary endpoint.
std::string first_clause(std::span<const claim_result> claims, const std::string& id) {
    const claim_result* claim = claim_named(claims, id);
    if (!claim || !claim->has_primary || !claim->primary.subject) return "not measured";
    std::vector<endpoint> all{claim->primary};
    all.insert(all.end(), claim->secondary.begin(), claim->secondary.end());
    return clause_of(all, claim->primary);
}

std::size_t count_of(std::span<const claim_result> claims, verdict_kind verdict) {
    return static_cast<std::size_t>(std::ranges::count(claims, verdict, &claim_result::verdict));
}

/// "Of 14 claims 2 hold, 6 hold in part, 5 do not hold and 1 is undecided."
std::string counts_of(std::span<const claim_result> claims) {
    std::vector<std::string> parts;
    const auto add = [&](verdict_kind verdict, const char* one, const char* many) {
        if (const std::size_t count = count_of(claims, verdict); count > 0)
            parts.push_back(fmt::format("{} {}", count, count == 1 ? one : many));
    };
    add(verdict_kind::holds, "holds", "hold");
    add(verdict_kind::in_part, "holds in part", "hold in part");
    add(verdict_kind::does_not_hold, "does not hold", "do not hold");
    add(verdict_kind::no_difference, "shows no difference", "show no difference");
    add(verdict_kind::undecided, "is undecided", "are undecided");
    std::string text = fmt::format("Of {} claims", claims.size());
    for (std::size_t i = 0; i < parts.size(); ++i)
        text += (i == 0 ? " " : i + 1 == parts.size() ? " and " : ", ") + parts[i];
    return text + ".";
}

}  // namespace

std::vector<std::string> headline_of(std::span<const claim_result> claims) {
    return {
        "To find which boxes overlap, the paper sorts them with Shell sort and cuts the axes; compared with insertion "
        "sort without cuts: " +
            first_clause(claims, "C1") + against_classic_sweep(claims) + ".",
        "To find which triangles meet, it compresses the tree of boxes; compared with the tree as it was: " +
            first_clause(claims, "C7a") + ", and to search it " + first_clause(claims, "C7b") + ".",
        counts_of(claims)};
}

}  // namespace aabblab
