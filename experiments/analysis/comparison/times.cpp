module aabblab.comparison;

import aabblab.metrics;

namespace aabblab {

namespace {

std::optional<double> log_ms(const row& r) {
    static const row_value& frame = measured("frame_ms");
    if (!r.first_ms || !r.search_ms || !r.detect_ms) return std::nullopt;
    const double ms = frame(r).value_or(0);
    return std::isfinite(ms) && ms > 0 ? std::optional(std::log(ms)) : std::nullopt;
}

std::optional<double> log_ms_in(const played_scenes::repeats& all, const row& same_repeat) {
    for (const row* r : all)
        if (r->repeat == same_repeat.repeat)
            if (const std::optional<double> ms = log_ms(*r)) return ms;
    return std::nullopt;
}

std::size_t size_of(const cells& all) {
    std::size_t count = 0;
    for (std::size_t process = 0; process < all.processes(); ++process)
        for (std::size_t seed = 0; seed < all.seeds(); ++seed) count += all.at(process, seed).size();
    return count;
}

/// The chance that n values all lie above m others of the same distribution: no test may be surer than that. The
/// bootstrap of a few values would be, as it knows no others; of a single one it knows no noise at all.
double least_chance(std::size_t n, std::size_t m) {
    double chance = 1;
    for (std::size_t i = 1; i <= n; ++i) chance *= static_cast<double>(i) / static_cast<double>(m + i);
    return chance;
}

}  // namespace

cells log_times(const played_scenes& run, const shared_scene& in, const contender_name& who,
                const contender_name* base) {
    std::vector<std::uint64_t> processes;
    for (const played_scene& seed : in.seeds)
        for (const row* r : run.of(seed, who)) processes.push_back(r->process);
    std::ranges::sort(processes);
    const auto twice = std::ranges::unique(processes);
    processes.erase(twice.begin(), twice.end());
    cells all(processes.size(), in.seeds.size());
    for (std::size_t seed = 0; seed < in.seeds.size(); ++seed)
        for (const row* r : run.of(in.seeds[seed], who)) {
            const std::optional<double> own = log_ms(*r);
            const std::optional<double> other = base ? log_ms_in(run.of(in.seeds[seed], *base), *r) : 0;
            if (!own || !other) continue;
            const auto process = std::ranges::lower_bound(processes, r->process) - processes.begin();
            all.add(static_cast<std::size_t>(process), seed, *own - *other);
        }
    return all;
}

std::optional<contender_name> base_of(const shared_scene& in, const played_scenes& a, const played_scenes& b) {
    for (const contender_name& name : in.names)
        if (!log_times(a, in, name, nullptr).empty() && !log_times(b, in, name, nullptr).empty()) return name;
    return std::nullopt;
}

std::vector<compared_time> judged(std::span<const two_sides> all) {
    std::vector<compared_time> times;
    std::vector<evidence> evidences;
    for (const two_sides& line : all) {
        const estimate a = bootstrap(line.a);
        const estimate b = bootstrap(line.b);
        const estimate change = difference_of(b, a);
        const interval around = change.range();
        const double least = least_chance(size_of(line.a), size_of(line.b));
        evidence& shown = evidences.emplace_back(evidence_of(change));
        shown.p = std::max(shown.p, least);
        compared_time& time = times.emplace_back();
        time.in_a = std::exp(a.value);
        time.in_b = std::exp(b.value);
        time.change = std::exp(change.value);
        time.around = {std::exp(around.low), std::exp(around.high)};
        time.too_few = decide({outcome::more, least * static_cast<double>(all.size())}) == outcome::undecided;
    }
    const std::vector<outcome> outcomes = decide_together(evidences);
    // Only a change needs the correction: hundreds of lines without one would else all be undecided.
    for (std::size_t i = 0; i < times.size(); ++i)
        times[i].found =
            outcomes[i] == outcome::undecided && decide(evidences[i]) == outcome::same ? outcome::same : outcomes[i];
    return times;
}

}  // namespace aabblab
