module aabblab.claims;

namespace aabblab {

namespace {

expectation expected_of(const draft& of, const candidate& c) {
    return c.expected.value_or(of.claim.expected);
}

/// A candidate and where its endpoint goes.
struct entry {
    const draft* of;
    const candidate* one;
    endpoint* decided;
};

/// What one machine finds of several that are decided together.
struct findings {
    std::vector<support> supports;
    std::vector<outcome> directions;
};
findings found_by(std::span<const entry> all, std::size_t machine, double band) {
    std::vector<tested> evidence;
    for (const entry& e : all)
        evidence.push_back({expected_of(*e.of, *e.one), tails_of(e.one->log_ratios[machine], band)});
    const std::vector<double> levels = levels_together(evidence);
    findings found;
    for (std::size_t i = 0; i < all.size(); ++i) {
        found.supports.push_back(support_of(evidence[i].expected, evidence[i].p, levels[i]));
        found.directions.push_back(direction_of(evidence[i].p, levels[i]));
    }
    return found;
}

/// What every machine finds of endpoints that are decided together; where machines differ, nothing is decided.
void settle(std::span<const entry> all, double band) {
    if (all.empty()) return;
    for (std::size_t machine = 0; machine < all.front().one->log_ratios.size(); ++machine) {
        const findings found = found_by(all, machine, band);
        for (std::size_t i = 0; i < all.size(); ++i) {
            endpoint& e = *all[i].decided;
            e.found = machine == 0 || e.found == found.supports[i] ? found.supports[i] : support::undecided;
            e.direction = machine == 0 || e.direction == found.directions[i] ? found.directions[i] : outcome::undecided;
        }
    }
}

}  // namespace

bool candidate::known() const {
    return !log_ratios.empty() && std::ranges::all_of(log_ratios, &estimate::known);
}

estimate candidate::log_ratio() const {
    return mean_of(log_ratios);
}

endpoint endpoint_of(const candidate& c, expectation expected, double band) {
    const estimate log_ratio = c.log_ratio();
    const interval range = log_ratio.range();
    const expectation own = c.expected.value_or(expected);
    const tails p = tails_of(log_ratio, band);
    const support alone = support_of(own, p);
    return {c.where,
            c.observed,
            std::exp(log_ratio.value),
            {std::exp(range.low), std::exp(range.high)},
            own,
            alone,
            direction_of(p),
            alone,
            c.primary,
            c.compared,
            c.subject,
            c.along,
            c.source};
}

std::vector<std::vector<endpoint>> decided(std::span<const draft> drafts, double band) {
    std::vector<std::vector<endpoint>> all(drafts.size());
    for (std::size_t i = 0; i < drafts.size(); ++i)
        for (const candidate& c : drafts[i].candidates)
            if (c.known()) all[i].push_back(endpoint_of(c, drafts[i].claim.expected, band));
    std::vector<entry> primaries;
    for (std::size_t i = 0; i < drafts.size(); ++i) {
        std::vector<entry> others;
        auto made = all[i].begin();
        for (const candidate& c : drafts[i].candidates)
            if (c.known()) (c.primary ? primaries : others).push_back({&drafts[i], &c, &*made++});
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

}  // namespace aabblab
