module aabblab.trials;

import aabblab.progress;
import aabblab.statistics;

namespace aabblab {

namespace {

/// Of the time that is left nobody takes more, unless that is less than twice what the first takes.
constexpr double greatest_share = 0.25;

bool is_hopeless(const observation& time, const observation& first) {
    return time.whole_ms() > hopeless_ms && time.frame_ms() > hopeless_ratio * first.frame_ms();
}

/// The first of all, who decides how many frames there is time for.
void play_first(turns& played, staged_scene& scene, const contender& who, const time_limits& limits) {
    attempt first = scene.play(who, played.frames, greatest_share * limits.to_play());
    if (first.end == ending::stopped && first.seen.frames > 0) {
        // What is held and left out only a play tells that comes to its end.
        played.frames = first.seen.frames;
        first = scene.play(who, played.frames, 2 * greatest_share * limits.to_play());
    }
    if (first.end != ending::done) {
        played.broken_off[0] = std::move(first);
        return;
    }
    played.frames = first.seen.frames;
    played.times[0].push_back(std::move(first.seen));
}

/// @param first seconds that the first took
void play_once(turns& played, staged_scene& scene, std::size_t at, const contender& who, double first,
               const time_limits& limits) {
    const double left = limits.to_play();
    const double share = std::min(left, std::max(2 * first, greatest_share * left));
    const double hopeless = hopeless_ms / 1000 + hopeless_ratio * first;
    attempt one = scene.play(who, played.frames, std::min(hopeless, share));
    one.is_hopeless = one.end == ending::stopped && hopeless < share;
    if (one.is_hopeless) played.hopeless[at] = true;
    if (one.end == ending::done)
        played.times[at].push_back(std::move(one.seen));
    else if (played.times[at].empty())
        played.broken_off[at] = std::move(one);
}

}  // namespace

turns play_in_turn(staged_scene& scene, std::span<const contender> all, std::size_t frames, std::size_t rounds,
                   const time_limits& limits) {
    progress shown("plays", rounds * all.size());
    turns played{frames, 0, std::vector<std::vector<observation>>(all.size()),
                 std::vector<std::optional<attempt>>(all.size()), std::vector<bool>(all.size())};
    const double before_first = limits.to_play();
    play_first(played, scene, all[0], limits);
    if (played.times[0].empty()) return played;
    const double first = before_first - limits.to_play();
    std::vector<std::size_t> running(all.size());
    std::iota(running.begin(), running.end(), std::size_t{0});
    double longest_round = 0;
    for (; played.rounds < rounds && limits.to_play() > longest_round; ++played.rounds) {
        const double before_round = limits.to_play();
        for (std::size_t k = 0; k < running.size(); ++k) {
            const std::size_t one = running[in_turn(k, played.rounds, running.size())];
            if (one != 0 || played.rounds > 0) play_once(played, scene, one, all[one], first, limits);
            shown.at(played.rounds * all.size() + k + 1);
        }
        longest_round = std::max(longest_round, before_round - limits.to_play());
        for (const std::size_t one : running)
            if (!played.times[one].empty() && is_hopeless(played.times[one][0], played.times[0][0]))
                played.hopeless[one] = true;
        std::erase_if(running, [&](std::size_t one) {
            return played.hopeless[one] || played.times[one].size() <= played.rounds;
        });
    }
    return played;
}

std::vector<std::size_t> who_disagrees(std::span<const std::vector<observation>> times) {
    std::vector<std::size_t> all;
    for (std::size_t i = 1; i < times.size(); ++i)
        if (!times[i].empty() && times[i].front().digest != times[0].front().digest) all.push_back(i);
    return all;
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
