module aabblab.claims;

import aabblab.fmt;

namespace aabblab {

namespace {

/// What every machine finds of endpoints that are decided together; where machines differ, nothing is decided.
void settle(std::span<endpoint* const> all, double band) {
    if (all.empty()) return;
    for (std::size_t machine = 0; machine < all.front()->log_ratios.size(); ++machine) {
        std::vector<tested> evidence;
        for (const endpoint* e : all)
            evidence.push_back({e->expected.value_or(expectation::less), tails_of(e->log_ratios[machine], band)});
        const std::vector<double> levels = levels_together(evidence);
        for (std::size_t i = 0; i < all.size(); ++i) {
            endpoint& e = *all[i];
            const support found = support_of(evidence[i].expected, evidence[i].p, levels[i]);
            const outcome direction = direction_of(evidence[i].p, levels[i]);
            e.found = machine == 0 || e.found == found ? found : support::undecided;
            e.direction = machine == 0 || e.direction == direction ? direction : outcome::undecided;
        }
    }
}

std::string word_of(const endpoint& e) {
    if (e.expected == expectation::not_more && e.found == support::favours && e.direction == outcome::undecided)
        return "not more";
    constexpr std::array words{"less", "the same", "more", "open"};
    return words[static_cast<std::size_t>(e.direction)];
}

/// Every primary ratio, and how many others say what.
std::string figures_of(std::span<const endpoint> all) {
    std::string text;
    std::vector<endpoint> others;
    for (const endpoint& e : all) {
        if (!e.is_primary) {
            others.push_back(e);
            continue;
        }
        text += fmt::format("{}{}: {}, {}", text.empty() ? "" : "; ", text_of(e.where), ratio_text(e), word_of(e));
    }
    if (text.empty()) return "There are no measurements that decide it.";
    text = "Primary ratios, each with its 95 % interval: " + text + ".";
    if (others.empty()) return text;
    return text + fmt::format(
                      " Of {} other conditions {} favour the claim, {} contradict it, {} show no difference and "
                      "{} are undecided.",
                      others.size(), count_of(others, support::favours), count_of(others, support::contradicts),
                      count_of(others, support::no_difference), count_of(others, support::undecided));
}

/// Judged.
claim_result finished(const draft& made, const std::vector<endpoint>& all) {
    claim_result claim = made.claim;
    claim.verdict = verdict_of(all);
    claim.sentence = sentence_of(all, claim.lead);
    std::vector<endpoint> of_primary_lines;
    std::ranges::copy_if(all, std::back_inserter(of_primary_lines), [&](const endpoint& e) {
        return std::ranges::any_of(all, [&](const endpoint& p) { return p.is_primary && is_same_line(p, e); });
    });
    claim.brief = sentence_of(of_primary_lines, claim.lead);
    std::vector<endpoint> beside;
    for (const endpoint& e : made.beside)
        if (e.known()) beside.push_back(decided_alone(e));
    if (!beside.empty()) claim.sentence += " " + sentence_of(beside);
    if (!claim.remark.empty()) claim.sentence += " " + claim.remark;
    claim.because = figures_of(all);
    std::vector<endpoint> ordered = all;
    std::ranges::stable_partition(ordered, &endpoint::is_primary);
    claim.has_primary = !ordered.empty() && ordered.front().is_primary;
    if (claim.has_primary) claim.primary = ordered.front();
    claim.secondary.assign(ordered.begin() + (claim.has_primary ? 1 : 0), ordered.end());
    std::string name = claim.id;
    std::ranges::transform(name, name.begin(), [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    claim.tables.insert(claim.tables.begin(),
                        {name,
                         "Every endpoint of " + claim.id + ": " + claim.measured +
                             ". Outcomes are by Holm's rule, of primary ones over all claims, of the others over this "
                             "one; intervals are each one's own.",
                         endpoint_table(ordered, [](const endpoint& e) {
                             return text_of(e.found) + (e.is_primary ? " (primary)" : "");
                         })});
    return claim;
}

/// The drafts of all claims, from one machine.
std::vector<draft> drafts_of(const measurements& m) {
    std::vector<draft> all;
    for (const claim_source& source : claim_sources()) {
        draft& made = all.emplace_back(source.make(m));
        claim_result& claim = made.claim;
        claim.id = source.listed.id;
        claim.expected = source.listed.expected;
        for (std::vector<endpoint>* some : {&made.endpoints, &made.beside})
            for (endpoint& e : *some) e.expected = e.expected.value_or(claim.expected);
        for (const std::string& experiment : claim.experiments)
            std::ranges::move(places_of(m.of(experiment)), std::back_inserter(claim.scenes));
    }
    return all;
}

/// Puts what another machine measured beside it. What it did not measure is not known of all machines.
void add_machine(std::vector<draft>& all, const std::vector<draft>& more) {
    const auto add = [](std::vector<endpoint>& to, const std::vector<endpoint>& from) {
        for (endpoint& e : to) {
            const auto same = std::ranges::find_if(
                from, [&](const endpoint& other) { return other.where == e.where && other.source == e.source; });
            e.log_ratios.push_back(same == from.end() ? estimate{std::nan("")} : same->log_ratios.front());
        }
    };
    for (std::size_t i = 0; i < all.size(); ++i) {
        add(all[i].endpoints, more[i].endpoints);
        add(all[i].beside, more[i].beside);
    }
}

}  // namespace

endpoint decided_alone(endpoint e, double band) {
    const estimate log_ratio = e.log_ratio();
    const interval range = log_ratio.range();
    const tails p = tails_of(log_ratio, band);
    e.ratio = std::exp(log_ratio.value);
    e.range = {std::exp(range.low), std::exp(range.high)};
    e.found = e.alone = support_of(e.expected.value_or(expectation::less), p);
    e.direction = direction_of(p);
    return e;
}

std::vector<std::vector<endpoint>> decided(std::span<const draft> drafts, double band) {
    std::vector<std::vector<endpoint>> all(drafts.size());
    std::vector<endpoint*> primaries;
    for (std::size_t i = 0; i < drafts.size(); ++i) {
        for (const endpoint& e : drafts[i].endpoints)
            if (e.known()) all[i].push_back(decided_alone(e, band));
        std::vector<endpoint*> others;
        for (endpoint& e : all[i]) (e.is_primary ? primaries : others).push_back(&e);
        settle(others, band);
    }
    settle(primaries, band);
    return all;
}

verdict_kind verdict_of(std::span<const endpoint> all) {
    std::vector<support> primary;
    for (const endpoint& e : all)
        if (e.is_primary) primary.push_back(e.found);
    return verdict_of(primary);
}

factors place_of(const endpoint& e) {
    factors place = e.where;
    place.insert(place.end(), e.observed.begin(), e.observed.end());
    return place;
}

std::vector<endpoint> primaries_of(const claim_result& claim) {
    std::vector<endpoint> all;
    if (claim.has_primary) all.push_back(claim.primary);
    std::ranges::copy_if(claim.secondary, std::back_inserter(all), &endpoint::is_primary);
    return all;
}

std::vector<endpoint> secondaries_of(const claim_result& claim) {
    std::vector<endpoint> all;
    std::ranges::remove_copy_if(claim.secondary, std::back_inserter(all), &endpoint::is_primary);
    return all;
}

std::vector<listed_claim> listed_claims() {
    std::vector<listed_claim> all;
    for (const claim_source& source : claim_sources()) all.push_back(source.listed);
    return all;
}

reproduction judged(const measurements& m) {
    return judged({&m, 1});
}

reproduction judged(std::span<const measurements> machines) {
    const measurements& first = machines.front();
    std::vector<draft> drafts = drafts_of(first);
    for (const measurements& m : machines.subspan(1)) add_machine(drafts, drafts_of(m));
    reproduction all;
    const std::vector<std::vector<endpoint>> endpoints = decided(drafts, equivalence_band);
    for (std::size_t i = 0; i < drafts.size(); ++i) all.claims.push_back(finished(drafts[i], endpoints[i]));
    all.headline = headline_of(all.claims);
    all.disturbance = disturbance_of(machines);
    all.choices = open_choices(first);
    all.tables = table1(first);
    all.bands = bands_table(drafts);
    all.null_control = null_control(first);
    return all;
}

}  // namespace aabblab
