module;
#include <algorithm>
#include <cstddef>
#include <numeric>
#include <span>
#include <vector>

module aabblab.race;

import aabblab.play;
import aabblab.progress;
import aabblab.scenes;
import aabblab.statistics;

namespace aabblab {

std::vector<std::vector<race_time>> play_in_turn(const scene_choice& scene, std::span<const contender> all,
                                                 std::size_t frames, std::size_t rounds) {
    progress shown("plays", rounds * all.size());
    std::vector<std::vector<race_time>> times(all.size());
    std::vector<std::size_t> running(all.size());
    std::iota(running.begin(), running.end(), std::size_t{0});
    for (std::size_t round = 0; round < rounds; ++round) {
        for (std::size_t k = 0; k < running.size(); ++k) {
            const std::size_t one = running[in_turn(k, round, running.size())];
            times[one].push_back(time_frames(scene, all[one], frames));
            shown.at(round * all.size() + k + 1);
        }
        if (round == 0)
            std::erase_if(running, [&](std::size_t one) {
                const race_time& time = times[one][0];
                return time.whole_ms() > hopeless_ms && time.frame_ms() > hopeless_ratio * times[0][0].frame_ms();
            });
    }
    return times;
}

std::vector<std::size_t> who_disagrees(std::span<const std::vector<race_time>> times) {
    std::vector<std::size_t> all;
    for (std::size_t i = 1; i < times.size(); ++i)
        if (times[i].front().digest != times[0].front().digest) all.push_back(i);
    return all;
}

std::vector<double> frame_ms_of(std::span<const race_time> times) {
    std::vector<double> ms;
    for (const race_time& t : times) ms.push_back(t.frame_ms());
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
