module aabblab.calibrate;

import :trial;
import aabblab.progress;

namespace aabblab {

namespace {

/// What was seen of a group, in scenes to fit to and in others.
struct group_observations {
    std::vector<timed_work> fitted;
    std::vector<timed_work> held_out;
};

double seconds_since(std::chrono::steady_clock::time_point began) {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - began).count();
}

/// Counts, then times round after round, every trial once in each, until the time is over.
std::vector<group_observations> observe(std::vector<trial> trials, double seconds) {
    constexpr std::size_t fewest_repeats = 3;
    constexpr std::size_t most_repeats = 25;
    const auto began = std::chrono::steady_clock::now();
    std::vector<std::pair<trial, std::vector<piece>>> counted;
    for (trial& one : trials) {
        std::vector<piece> pieces = one.count();
        counted.emplace_back(std::move(one), std::move(pieces));
    }
    std::vector<std::vector<std::vector<double>>> times(counted.size());  // by trial, repeat and piece
    progress shown("seconds of measuring", static_cast<std::size_t>(seconds));
    double last = 0;
    for (std::size_t repeat = 0; repeat < most_repeats; ++repeat) {
        const double so_far = seconds_since(began);
        if (repeat >= fewest_repeats && so_far + last > seconds) break;
        for (std::size_t i = 0; i < counted.size(); ++i) {
            times[i].push_back(counted[i].first.time());
            shown.at(static_cast<std::size_t>(std::min(seconds, seconds_since(began))));
        }
        last = seconds_since(began) - so_far;
    }
    std::vector<group_observations> all(cost_groups().size());
    for (std::size_t i = 0; i < counted.size(); ++i) {
        const auto& [what, pieces] = counted[i];
        for (std::size_t p = 0; p < pieces.size(); ++p) {
            timed_work seen{what.scene, pieces[p].work, {}};
            for (const std::vector<double>& repeat : times[i]) seen.ns.push_back(repeat[p]);
            group_observations& group = all[static_cast<std::size_t>(pieces[p].group)];
            (what.held_out ? group.held_out : group.fitted).push_back(std::move(seen));
        }
    }
    return all;
}

}  // namespace

const std::array<cost_group_info, 6>& cost_groups() {
    using m = aabb::cost_model;
    static const std::array<cost_group_info, 6> groups{
        {{"lists of neighbours", {&m::search_box, &m::search_pair, &m::keep_box, &m::watch_box, &m::test_pair}},
         {"axial cut", {&m::list_entry, &m::cut_entry, &m::cut_subset, &m::cut_test}},
         {"columns", {&m::column_entry, &m::column, &m::column_test}},
         {"trees by median", {&m::median_triangle}},
         {"trees by sah", {&m::sah_triangle}},
         {"queries", {&m::node_visit}}}};
    return groups;
}

calibration calibrate(calibration_size size, double seconds) {
    std::vector<trial> trials = box_trials(size);
    std::ranges::move(mesh_trials(size), std::back_inserter(trials));
    const std::vector<group_observations> seen = observe(std::move(trials), seconds);
    // What seems to be free was lost in noise.
    constexpr double least_share = 0.01;
    calibration all;
    for (std::size_t g = 0; g < seen.size(); ++g) {
        const cost_group_info& group = cost_groups()[g];
        std::vector<estimate> costs = fit_costs(seen[g].fitted);
        for (std::size_t k = 0; k < group.costs.size(); ++k) {
            costs[k].value = std::max(costs[k].value, least_share * (aabb::cost_model{}.*group.costs[k]));
            all.costs.*group.costs[k] = costs[k].value;
            const auto info = std::ranges::find(aabb::cost_infos, group.costs[k], &aabb::cost_info::value);
            all.estimates[static_cast<std::size_t>(info - aabb::cost_infos.begin())] = costs[k];
        }
        all.checks.push_back({group.name, accuracy_of(seen[g].held_out, costs)});
    }
    return all;
}

}  // namespace aabblab
