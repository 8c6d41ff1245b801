module aabblab.trials;

import aabblab.progress;
import aabblab.statistics;

namespace aabblab {

namespace {

/// A run may use this share of the remaining time, or more if it stays within twice the time of the baseline.
constexpr double greatest_share = 0.25;
/// A run shorter than this is never hopeless: it costs too little to matter.
constexpr double hopeless_ms = 100;

bool is_hopeless(const observation& run, const observation& baseline) {
    return run.whole_ms() > hopeless_ms && run.frame_ms() > hopeless_ratio * baseline.frame_ms();
}

/// Runs the baseline, and if time is over, again with the frames that it finished: only finished runs report bytes.
attempt run_baseline(staged_scene& scene, const candidate& baseline, std::size_t frames, const time_limits& limits) {
    attempt first = scene.run(baseline, frames, greatest_share * limits.to_run());
    if (first.end != ending::stopped || first.seen.frames == 0) return first;
    return scene.run(baseline, first.seen.frames, 2 * greatest_share * limits.to_run());
}

}  // namespace

/// Runs candidates in interleaved rounds until time is over. The first run of the baseline, `candidates[0]`, decides
/// how many frames all runs have (those that it finishes in time) and how long another run may take. A candidate is
/// dropped when a run does not finish within that limit, or takes `hopeless_ratio` times as long as the baseline.
interleaved_runs run_interleaved(staged_scene& scene, std::span<const candidate> candidates, std::size_t frames,
                                 std::size_t rounds, const time_limits& limits) {
    progress shown("runs", rounds * candidates.size());
    interleaved_runs result{frames, /*rounds=*/0, std::vector<std::vector<observation>>(candidates.size()),
                            std::vector<std::optional<attempt>>(candidates.size()),
                            std::vector<bool>(candidates.size())};
    const double seconds_before = limits.to_run();
    attempt baseline = run_baseline(scene, candidates[0], frames, limits);
    const double baseline_seconds = seconds_before - limits.to_run();
    if (baseline.end != ending::done) {
        result.broken_off[0] = std::move(baseline);
        return result;
    }
    result.frames = baseline.seen.frames;
    result.times[0].push_back(std::move(baseline.seen));
    std::vector<std::size_t> running(candidates.size());
    std::iota(running.begin(), running.end(), std::size_t{0});
    std::size_t finished_runs = 0;  // for the progress bar
    const auto run = [&](std::size_t index, std::size_t round) {
        shown.update(finished_runs++);
        if (index == 0 && round == 0) return;  // the baseline's first run is done already
        const double remaining = limits.to_run();
        const stopping_rule rule{.grace = hopeless_ms / 1000, .share = greatest_share * remaining, .margin = 2};
        const double limit = rule.longest(baseline_seconds);
        attempt outcome = scene.run(candidates[index], result.frames, limit, remaining);
        // The limit may be too short to show that a candidate is hopeless, since it is a share of the remaining time.
        if (outcome.end == ending::stopped && !outcome.is_out_of_time)
            result.hopeless[index] = limit >= rule.hopeless_after(baseline_seconds);
        if (outcome.end == ending::done)
            result.times[index].push_back(std::move(outcome.seen));
        else if (result.times[index].empty())
            result.broken_off[index] = std::move(outcome);
    };
    const auto stop_early = [&](std::size_t round) {
        for (const std::size_t index : running)
            if (!result.times[index].empty() && is_hopeless(result.times[index][0], result.times[0][0]))
                result.hopeless[index] = true;
        std::erase_if(running,
                      [&](std::size_t index) { return result.hopeless[index] || result.times[index].size() <= round; });
        finished_runs = (round + 1) * candidates.size();
    };
    result.rounds =
        run_rounds(running, {.end = rounds, .seconds_left = [&] { return limits.to_run(); }}, run, stop_early);
    return result;
}

std::vector<std::size_t> disagreeing(std::span<const std::vector<observation>> times) {
    std::vector<std::size_t> indices;
    for (std::size_t i = 1; i < times.size(); ++i)
        if (!times[i].empty() && times[i].front().digest != times[0].front().digest) indices.push_back(i);
    return indices;
}

std::vector<double> frame_ms_of(std::span<const observation> times) {
    std::vector<double> ms;
    for (const observation& t : times) ms.push_back(t.frame_ms());
    return ms;
}

paired_ratio paired_ratio_of(std::span<const double> ms, std::span<const double> of_other) {
    std::vector<double> ratios;
    for (std::size_t round = 0; round < std::min(ms.size(), of_other.size()); ++round)
        ratios.push_back(ms[round] / of_other[round]);
    const auto [least, greatest] = std::ranges::minmax(ratios);
    return {quartiles_of(ratios).median, least, greatest};
}

}  // namespace aabblab
