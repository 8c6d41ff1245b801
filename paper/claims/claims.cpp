module;
#include <cassert>

module aabblab.claims;

import aabblab.fmt;
import aabblab.numbers;

namespace aabblab {

namespace {

/// Decides a family of endpoints together, by Holm's correction for multiple tests (1979): sets `corrected`, the
/// support for the claim, and `direction`. An outcome must be found on every machine, or else it is undecided.
/// @param band as in `tails_of`: ratios from 1 / (1 + band) to 1 + band count as no difference
void decide_family(std::span<endpoint* const> endpoints, double band) {
    if (endpoints.empty()) return;
    for (std::size_t machine = 0; machine < endpoints.front()->log_ratios.size(); ++machine) {
        std::vector<tested> evidence;
        for (const endpoint* e : endpoints)
            // `mark_stated` has set what each endpoint expects.
            evidence.push_back({e->expected.value(), tails_of(e->log_ratios[machine], band)});
        const std::vector<double> levels = levels_together(evidence);  // by Holm's rule
        for (std::size_t i = 0; i < endpoints.size(); ++i) {
            endpoint& e = *endpoints[i];
            const support outcome_here = support_of(evidence[i].expected, evidence[i].p, levels[i]);
            const outcome direction = direction_of(evidence[i].p, levels[i]);
            e.corrected = machine == 0 || e.corrected == outcome_here ? outcome_here : support::undecided;
            e.direction = machine == 0 || e.direction == direction ? direction : outcome::undecided;
        }
    }
}

std::string word_of(const endpoint& e) {
    constexpr std::array words{"less", "no difference", "more", "not more", "not less", "undecided"};
    return words[static_cast<std::size_t>(wording_of(e))];
}

/// How the primary ratios decide the claim.
std::string rule_text(const claim_result& claim) {
    return claim.rule == verdict_rule::every
               ? "It holds if all of them favour it; one that is decided otherwise refutes it."
               : "They are the cases of what is left open: " + claim.left_open +
                     ". It holds in part if some favour it and others are decided otherwise.";
}

/// The ratios behind a verdict: all primary ones, also those that were not measured, and the number of others by
/// outcome.
std::string evidence_text(const claim_result& claim) {
    if (claim.primaries.empty()) return "There are no measurements that decide it.";
    std::string text;
    for (const endpoint& e : claim.primaries)
        text += fmt::format("{}{}: {}, {}", text.empty() ? "" : "; ", text_of(e.where), ratio_text(e), word_of(e));
    text = "Primary ratios, each with its 95 % interval: " + text + ". " + rule_text(claim);
    for (const std::string& where : claim.missing)
        text += (&where == claim.missing.data() ? " Not measured, and so undecided: " : "; ") + where;
    if (!claim.missing.empty()) text += ".";
    const std::vector<endpoint>& others = claim.secondaries;
    if (others.empty()) return text;
    return text + counts_text(" Of " + counted(others.size(), "other ratio"),
                              {{count_of(others, support::favours), "favours the claim", "favour the claim"},
                               {count_of(others, support::contradicts), "contradicts it", "contradict it"},
                               {count_of(others, support::no_difference), "shows no difference", "show no difference"},
                               {count_of(others, support::undecided), "is undecided", "are undecided"}});
}

/// Every ratio of a judged claim with its outcome, the primary ones first.
named_table ratio_table(const claim_result& claim) {
    std::string name = claim.id;
    std::ranges::transform(name, name.begin(), [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    std::vector<endpoint> ordered = claim.primaries;
    ordered.insert(ordered.end(), claim.secondaries.begin(), claim.secondaries.end());
    table ratios = endpoint_table(ordered, [](const endpoint& e) {
        return text_of(e.corrected) + (e.is_primary ? " (primary)" : e.is_earlier ? " (earlier)" : "");
    });
    const bool has_unit = std::ranges::find(ratios.columns, "unit", &column::name) != ratios.columns.end();
    return {name,
            "Every ratio of " + claim.id + ": " + claim.measured +
                ". Primary ratios decide, earlier ones did in previous archives. Outcomes are corrected by Holm's "
                "method: of primary ratios over all claims, of the others over this claim. Intervals are uncorrected." +
                (has_unit ? unit_legend : ""),
            std::move(ratios)};
}

/// Whether the endpoint is the ratio that endpoints.toml states.
bool is_stated(const endpoint& e, const stated_ratio& ratio) {
    return e.source == ratio.source && matches(e.where, ratio.where);
}

/// The primary ratios that endpoints.toml states and no machine, or not every one, has measured.
std::vector<stated_ratio> missing_of(const draft& drafted, std::span<const endpoint> endpoints) {
    std::vector<stated_ratio> missing;
    std::ranges::remove_copy_if(drafted.stated->primary, std::back_inserter(missing), [&](const stated_ratio& ratio) {
        return std::ranges::any_of(endpoints, [&](const endpoint& e) { return is_stated(e, ratio); });
    });
    return missing;
}

/// Judges a draft by its decided endpoints: verdict, sentences and tables, that of all ratios first.
claim_result result_of(const draft& drafted, const std::vector<endpoint>& endpoints) {
    claim_result claim = drafted.claim;
    claim.verdict = verdict_of(drafted, endpoints);
    std::vector<endpoint> primary_clauses, secondary_clauses;
    for (const endpoint& e : endpoints) {
        // A clause of the sentence reports several endpoints; one primary endpoint makes the whole clause primary.
        const auto makes_primary = [&](const endpoint& p) { return p.is_primary && is_same_clause(p, e); };
        const bool is_primary = std::ranges::any_of(endpoints, makes_primary);
        if (is_primary || e.subject) (is_primary ? primary_clauses : secondary_clauses).push_back(e);
    }
    claim.sentence = claim.brief = sentence_of(primary_clauses, claim.lead);
    if (!secondary_clauses.empty()) claim.sentence += " " + sentence_of(secondary_clauses, "secondary ratios");
    if (!claim.remark.empty()) claim.sentence += " " + claim.remark;
    std::ranges::copy_if(endpoints, std::back_inserter(claim.primaries), &endpoint::is_primary);
    std::ranges::remove_copy_if(endpoints, std::back_inserter(claim.secondaries), &endpoint::is_primary);
    for (const stated_ratio& ratio : missing_of(drafted, endpoints))
        claim.missing.push_back(ratio.source + ", on " + text_of(ratio.where));
    claim.evidence = evidence_text(claim);
    claim.tables.insert(claim.tables.begin(), ratio_table(claim));
    return claim;
}

/// Marks the endpoints that endpoints.toml states, and sets what each expects: what is stated there, or by its claim.
void mark_stated(draft& drafted) {
    const stated_claim& stated = *drafted.stated;
    for (endpoint& e : drafted.endpoints) e.expected = e.expected.value_or(stated.expected);
    const auto mark = [&](const std::vector<stated_ratio>& ratios, bool endpoint::* role) {
        for (const stated_ratio& ratio : ratios) {
            const auto is_this = [&](const endpoint& e) { return is_stated(e, ratio); };
            assert(std::ranges::count_if(drafted.endpoints, is_this) <= 1);
            const auto e = std::ranges::find_if(drafted.endpoints, is_this);
            if (e == drafted.endpoints.end()) continue;
            (*e).*role = true;
            e->expected = ratio.expected;
        }
    };
    mark(stated.primary, &endpoint::is_primary);
    mark(stated.earlier, &endpoint::is_earlier);
}

/// The drafts of all claims, which have ratios but no verdicts yet, from the results of one machine.
std::vector<draft> drafts_of(const measurements& m) {
    std::vector<draft> drafts;
    for (const claim_source& source : claim_sources()) {
        draft& added = drafts.emplace_back(source.make(m));
        const auto entry = std::ranges::find(stated().claims, source.id, &stated_claim::id);
        assert(entry != stated().claims.end());
        added.stated = &*entry;
        claim_result& claim = added.claim;
        claim.id = entry->id;
        claim.of = entry->of;
        claim.claim = entry->claim;
        claim.quote = entry->quote;
        claim.regime = entry->regime;
        claim.measured = entry->measured;
        claim.left_open = entry->left_open;
        claim.rule = entry->rule;
        claim.expected = entry->expected;
        mark_stated(added);
        for (const std::string& experiment : claim.experiments)
            std::ranges::move(factors_of(m.conditions_of(experiment)), std::back_inserter(claim.scenes));
    }
    return drafts;
}

/// Adds another machine's ratios to the drafts of the first; both lists are in the order of the claims. A ratio that
/// the other machine did not measure becomes unknown, and is left out later.
void add_machine(std::vector<draft>& drafts, const std::vector<draft>& more) {
    for (std::size_t i = 0; i < drafts.size(); ++i)
        for (endpoint& e : drafts[i].endpoints) {
            const auto same = std::ranges::find_if(more[i].endpoints, [&](const endpoint& other) {
                return other.where == e.where && other.source == e.source;
            });
            e.log_ratios.push_back(same == more[i].endpoints.end() ? estimate{std::nan("")} : same->log_ratios.front());
        }
}

}  // namespace

/// Decides an endpoint by its own 95 % interval, without a correction for the number of decisions.
endpoint decided_alone(endpoint e, double band) {
    const estimate log_ratio = e.log_ratio();
    const interval range = log_ratio.range();
    const tails p = tails_of(log_ratio, band);
    e.ratio = std::exp(log_ratio.value);
    e.range = {std::exp(range.low), std::exp(range.high)};
    // Ratios outside claims (of open choices, in tables) expect nothing; below 1 they count as favourable.
    e.corrected = e.uncorrected = support_of(e.expected.value_or(expectation::less), p);
    e.direction = direction_of(p);
    return e;
}

/// Decides the primary endpoints (ratios) of all claims as one family, and the others of a claim as another. Returns
/// them by claim. Endpoints without a finite ratio are left out: a composition was wrong, or an experiment has not run.
std::vector<std::vector<endpoint>> decided(std::span<const draft> drafts, double band) {
    std::vector<std::vector<endpoint>> by_claim(drafts.size());
    std::vector<endpoint*> primaries;
    for (std::size_t i = 0; i < drafts.size(); ++i) {
        for (const endpoint& e : drafts[i].endpoints)
            if (e.is_known()) by_claim[i].push_back(decided_alone(e, band));
        std::vector<endpoint*> others;
        for (endpoint& e : by_claim[i]) (e.is_primary ? primaries : others).push_back(&e);
        decide_family(others, band);
    }
    decide_family(primaries, band);
    return by_claim;
}

/// Judges a claim by its primary endpoints, by its own rule. An endpoint that was not measured is undecided.
verdict_kind verdict_of(const draft& drafted, std::span<const endpoint> endpoints) {
    std::vector<support> primary(missing_of(drafted, endpoints).size(), support::undecided);
    for (const endpoint& e : endpoints)
        if (e.is_primary) primary.push_back(e.corrected);
    return verdict_of(primary, drafted.stated->rule);
}

factors factors_of(const endpoint& e) {
    factors place = e.where;
    place.insert(place.end(), e.observed.begin(), e.observed.end());
    return place;
}

/// Drafts all claims from every machine's rows, then decides them together, since Holm's correction spans all claims.
/// Tables and open choices are those of the first machine.
reproduction judged(std::span<const measurements> machines) {
    const measurements& first = machines.front();
    std::vector<draft> drafts = drafts_of(first);
    for (const measurements& m : machines.subspan(1)) add_machine(drafts, drafts_of(m));
    reproduction results;
    const std::vector<std::vector<endpoint>> endpoints = decided(drafts, equivalence_band);
    for (std::size_t i = 0; i < drafts.size(); ++i) results.claims.push_back(result_of(drafts[i], endpoints[i]));
    results.headline = headline_of(results.claims);
    results.disturbance = disturbance_of(machines);
    results.choices = open_choices(first);
    results.tables = table1(first);
    results.bands = bands_table(drafts);
    results.null_control = null_control(first);
    return results;
}

}  // namespace aabblab
