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
            // `drafts_of` has set what each endpoint expects: its own expectation, or else its claim's.
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
    constexpr std::array words{"less", "no difference", "more", "not more", "undecided"};
    return words[static_cast<std::size_t>(wording_of(e))];
}

/// The ratios behind a verdict: all primary ones, and the number of others by outcome.
std::string evidence_text(std::span<const endpoint> primaries, std::span<const endpoint> others) {
    if (primaries.empty()) return "There are no measurements that decide it.";
    std::string text;
    for (const endpoint& e : primaries)
        text += fmt::format("{}{}: {}, {}", text.empty() ? "" : "; ", text_of(e.where), ratio_text(e), word_of(e));
    text = "Primary ratios, each with its 95 % interval: " + text + ".";
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
    table ratios = endpoint_table(
        ordered, [](const endpoint& e) { return text_of(e.corrected) + (e.is_primary ? " (primary)" : ""); });
    const bool has_unit = std::ranges::find(ratios.columns, "unit", &column::name) != ratios.columns.end();
    return {name,
            "Every ratio of " + claim.id + ": " + claim.measured +
                ". Outcomes are corrected by Holm's method: of primary ratios over all claims, of the "
                "others over this claim. Intervals are uncorrected." +
                (has_unit ? unit_legend : ""),
            std::move(ratios)};
}

/// Judges a draft by its decided endpoints: verdict, sentences and tables, that of all ratios first.
claim_result result_of(const draft& drafted, const std::vector<endpoint>& endpoints) {
    claim_result claim = drafted.claim;
    claim.verdict = verdict_of(endpoints);
    std::vector<endpoint> primary_clauses, secondary_clauses;
    for (const endpoint& e : endpoints) {
        // A clause of the sentence reports several endpoints; one primary endpoint makes the whole clause primary.
        const auto makes_primary = [&](const endpoint& p) { return p.is_primary && is_same_clause(p, e); };
        const bool is_primary = std::ranges::any_of(endpoints, makes_primary);
        if (is_primary || e.subject) (is_primary ? primary_clauses : secondary_clauses).push_back(e);
    }
    claim.sentence = claim.brief = sentence_of(primary_clauses, claim.lead);
    if (!secondary_clauses.empty()) claim.sentence += " " + sentence_of(secondary_clauses, "secondary ratios");
    std::vector<endpoint> unjudged;
    for (const endpoint& e : drafted.unjudged)
        if (e.is_known()) unjudged.push_back(decided_alone(e));
    if (!unjudged.empty()) claim.sentence += " " + sentence_of(unjudged);
    if (!claim.remark.empty()) claim.sentence += " " + claim.remark;
    std::ranges::copy_if(endpoints, std::back_inserter(claim.primaries), &endpoint::is_primary);
    std::ranges::remove_copy_if(endpoints, std::back_inserter(claim.secondaries), &endpoint::is_primary);
    claim.evidence = evidence_text(claim.primaries, claim.secondaries);
    claim.tables.insert(claim.tables.begin(), ratio_table(claim));
    return claim;
}

/// The drafts of all claims, which have ratios but no verdicts yet, from the results of one machine.
std::vector<draft> drafts_of(const measurements& m) {
    std::vector<draft> drafts;
    for (const claim_source& source : claim_sources()) {
        draft& added = drafts.emplace_back(source.make(m));
        claim_result& claim = added.claim;
        claim.id = source.listed.id;
        claim.expected = source.listed.expected;
        // A ratio without an expectation of its own has that of the claim.
        for (std::vector<endpoint>* endpoints : {&added.endpoints, &added.unjudged})
            for (endpoint& e : *endpoints) e.expected = e.expected.value_or(claim.expected);
        for (const std::string& experiment : claim.experiments)
            std::ranges::move(factors_of(m.conditions_of(experiment)), std::back_inserter(claim.scenes));
    }
    return drafts;
}

/// Adds another machine's ratios to the drafts of the first; both lists are in the order of the claims. A ratio that
/// the other machine did not measure becomes unknown, and is left out later.
void add_machine(std::vector<draft>& drafts, const std::vector<draft>& more) {
    const auto add = [](std::vector<endpoint>& endpoints, const std::vector<endpoint>& others) {
        for (endpoint& e : endpoints) {
            const auto same = std::ranges::find_if(
                others, [&](const endpoint& other) { return other.where == e.where && other.source == e.source; });
            e.log_ratios.push_back(same == others.end() ? estimate{std::nan("")} : same->log_ratios.front());
        }
    };
    for (std::size_t i = 0; i < drafts.size(); ++i) {
        add(drafts[i].endpoints, more[i].endpoints);
        add(drafts[i].unjudged, more[i].unjudged);
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

verdict_kind verdict_of(std::span<const endpoint> endpoints) {
    std::vector<support> primary;
    for (const endpoint& e : endpoints)
        if (e.is_primary) primary.push_back(e.corrected);
    return verdict_of(primary);
}

factors factors_of(const endpoint& e) {
    factors place = e.where;
    place.insert(place.end(), e.observed.begin(), e.observed.end());
    return place;
}

std::vector<listed_claim> listed_claims() {
    std::vector<listed_claim> listed;
    for (const claim_source& source : claim_sources()) listed.push_back(source.listed);
    return listed;
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
