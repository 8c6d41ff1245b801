module;
#include <cassert>

module aabblab.calibrate;

import aabb.extreme;
import aabb.pipeline;
import aabb.registry;
import aabb.simd;
import aabblab.progress;
import aabblab.scenes;
import aabblab.trials;

namespace aabblab {

namespace {

/// Costs that are fitted together, since the same plays tell them.
enum class cost_group : unsigned char { lists, cut, columns, median, sah, queries };

/// A part of a play whose work is all of one group.
struct piece {
    cost_group group;
    std::vector<double> work;  ///< of a play in which it is counted
    double ns;                 ///< of one in which it is not
};

/// One way to play one scene.
struct trial {
    std::string scene;
    bool held_out;  ///< not fitted to, but to check
    std::function<std::vector<piece>(aabb::instrumentation)> play;
    std::vector<std::pair<cost_group, timed_work>> seen = {};  ///< by piece
};

using box_frames = std::shared_ptr<const std::vector<std::vector<aabb::box>>>;

/// They are made once, so that making them takes no time later.
box_frames frames_of(const scene_choice& choice) {
    const auto scene = make_box_scene(choice);
    std::vector<std::vector<aabb::box>> all;
    std::vector<aabb::box> boxes;
    while (scene->next(boxes)) all.push_back(boxes);
    return std::make_unique<const std::vector<std::vector<aabb::box>>>(std::move(all));
}

/// Other costs to plan by, for a while.
class costs_for_a_while {
public:
    explicit costs_for_a_while(const aabb::cost_model& costs) : before_(aabb::machine_costs()) {
        aabb::set_machine_costs(costs);
    }
    costs_for_a_while(const costs_for_a_while&) = delete;
    costs_for_a_while& operator=(const costs_for_a_while&) = delete;
    ~costs_for_a_while() { aabb::set_machine_costs(before_); }

private:
    aabb::cost_model before_;
};

/// What a frame took, in one pass or the other.
struct frame_seen {
    double ns = 0;
    double pairs = 0;
    aabb::work_counters work;

    [[nodiscard]] double count(aabb::work what) const { return static_cast<double>(work[what]); }
};

struct box_play {
    box_frames frames;
    aabb::composition composed;
    aabb::cost_model planned_by;
};

std::vector<frame_seen> frames_seen(const box_play& what, aabb::instrumentation counted) {
    const costs_for_a_while costs(what.planned_by);
    scene_play scene(std::make_unique<aabb::known_boxes>(*what.frames));
    player p(contender_of(what.composed, false), scene, counted);
    aabb::work_counters before;
    std::vector<frame_seen> all;
    play(scene, p, [&](const played_frame& frame) {
        frame_seen seen{
            1e6 * (frame.took.update.cpu_ms + frame.took.search.cpu_ms), static_cast<double>(frame.pairs.size()), {}};
        const aabb::work_counters now = p.counters();
        for (std::size_t k = 0; k < now.counts.size(); ++k) seen.work.counts[k] = now.counts[k] - before.counts[k];
        before = now;
        all.push_back(seen);
    });
    return all;
}

/// Frames before this one are not like the others: nothing is sorted, planned or kept yet.
constexpr std::size_t first_usual = 2;

/// The means over every `step`-th frame from `first` on.
frame_seen mean_of(const std::vector<frame_seen>& frames, std::size_t first, std::size_t step) {
    frame_seen sum;
    std::uint64_t count = 0;
    for (std::size_t i = first; i < frames.size(); i += step, ++count) {
        sum.ns += frames[i].ns;
        sum.pairs += frames[i].pairs;
        for (std::size_t k = 0; k < sum.work.counts.size(); ++k) sum.work.counts[k] += frames[i].work.counts[k];
    }
    sum.ns /= static_cast<double>(count);
    sum.pairs /= static_cast<double>(count);
    for (std::uint64_t& k : sum.work.counts) k /= count;
    return sum;
}

/// A scene whose frames are made.
struct made_scene {
    made_scene(const scene_choice& choice, bool is_held_out)
        : name(choice.kind + " " + settings_text(choice)),
          held_out(is_held_out),
          frames(frames_of(choice)),
          n(static_cast<double>(frames->front().size())) {}

    std::string name;
    bool held_out;
    box_frames frames;
    double n;  // objects
};

/// Work of a mean frame: what there are costs for, then what no strategy plans by, and that it is one frame.
using work_of_frame = std::function<std::vector<double>(const frame_seen&)>;

trial usual_frames(const made_scene& scene, cost_group group, const aabb::composition& c,
                   const aabb::cost_model& planned_by, work_of_frame work) {
    return {
        scene.name, scene.held_out,
        [group, what = box_play{scene.frames, c, planned_by}, work = std::move(work)](aabb::instrumentation counted) {
            const frame_seen seen = mean_of(frames_seen(what, counted), first_usual, 1);
            return std::vector{piece{group, work(seen), seen.ns}};
        }};
}

/// A list that is made anew in every other frame: in those with an even number it is made, in the others it serves.
trial made_and_served(const made_scene& scene) {
    aabb::composition c;
    c[aabb::strategy_kind::prepare] = {"neighbour_list", {{"every", "2"}}};
    return {scene.name, scene.held_out,
            [n = scene.n, what = box_play{scene.frames, c, {}}](aabb::instrumentation counted) {
                const std::vector<frame_seen> all = frames_seen(what, counted);
                const frame_seen made = mean_of(all, first_usual, 2);
                const frame_seen served = mean_of(all, first_usual + 1, 2);
                // That a list serves takes a test of each of its pairs, and no search.
                assert(counted == aabb::instrumentation::none ||
                       (made.work[aabb::work::subsets] > 0 && served.work[aabb::work::subsets] == 0));
                const double listed = served.count(aabb::work::box_tests);
                return std::vector{piece{cost_group::lists, {n, listed, n, n, listed}, made.ns},
                                   piece{cost_group::lists, {0, 0, 0, n, listed}, served.ns}};
            }};
}

void add_list_trials(std::vector<trial>& all, const made_scene& scene) {
    all.push_back(usual_frames(scene, cost_group::lists, {}, {}, [n = scene.n](const frame_seen& seen) {
        return std::vector<double>{n, seen.pairs, 0, 0, 0};
    }));
    all.push_back(made_and_served(scene));
}

/// @param lists that are sorted: of the axes cut, and of the one that is swept
void add_cut_trial(std::vector<trial>& all, const made_scene& scene, const std::string& sort,
                   const aabb::strategy_choice& partition, double lists) {
    aabb::composition c;
    c[aabb::strategy_kind::sort] = {sort, {}};
    c[aabb::strategy_kind::partition] = partition;
    c[aabb::strategy_kind::sweep] = {"one_axis", {}};
    all.push_back(usual_frames(scene, cost_group::cut, c, {}, [listed = scene.n * lists](const frame_seen& seen) {
        return std::vector<double>{listed,
                                   seen.count(aabb::work::subset_copies),
                                   seen.count(aabb::work::subsets),
                                   seen.count(aabb::work::box_tests),
                                   seen.pairs,
                                   1};
    }));
}

void add_cut_trials(std::vector<trial>& all, const made_scene& scene) {
    const auto cut = [](const char* axes, const char* segments) {
        return aabb::strategy_choice{"axial_cut", {{"axes", axes}, {"segments", segments}}};
    };
    add_cut_trial(all, scene, "std", {"none", {}}, 1);
    add_cut_trial(all, scene, "radix", {"none", {}}, 1);
    add_cut_trial(all, scene, "std", cut("1", "24"), 2);
    add_cut_trial(all, scene, "radix", cut("2", "8"), 3);
    add_cut_trial(all, scene, "std", cut("2", "24"), 3);
    add_cut_trial(all, scene, "radix", cut("3", "4"), 3);
    add_cut_trial(all, scene, "radix", cut("3", "16"), 3);
}

void add_column_trial(std::vector<trial>& all, const made_scene& scene, const char* axes,
                      const aabb::cost_model& planned_by) {
    aabb::composition c;
    c[aabb::strategy_kind::partition] = {"columns", {{"axes", axes}}};
    all.push_back(usual_frames(scene, cost_group::columns, c, planned_by, [n = scene.n](const frame_seen& seen) {
        // Copies are not counted where there is one column.
        return std::vector<double>{std::max(n, seen.count(aabb::work::subset_copies)),
                                   seen.count(aabb::work::subsets),
                                   seen.count(aabb::work::box_tests) / double{aabb::simd::width},
                                   n,
                                   seen.pairs,
                                   1};
    }));
}

/// Adds trials with more and with fewer columns than are optimal, so that the fit can separate their costs.
void add_column_trials(std::vector<trial>& all, const made_scene& scene) {
    constexpr double many_times = 8;
    aabb::cost_model more;
    more.column_test *= many_times;
    aabb::cost_model fewer;
    fewer.column_entry *= many_times;
    fewer.column *= many_times;
    add_column_trial(all, scene, "2", {});
    add_column_trial(all, scene, "2", more);
    add_column_trial(all, scene, "2", fewer);
    add_column_trial(all, scene, "1", {});
    add_column_trial(all, scene, "0", {});
}

scene_choice moving(const char* kind, std::size_t objects, const char* displacement, std::size_t frames) {
    return {kind,
            {{"objects", std::to_string(objects)}, {"displacement", displacement}, {"frames", std::to_string(frames)}},
            {}};
}

/// Enough frames for a stable time per frame. The number is odd, so that as many frames reuse a list as build one.
std::size_t frames_for(std::size_t objects) {
    return objects < 1000 ? 41 : objects < 10'000 ? 17 : 9;
}

void add_trial(std::vector<trial>& all, const scene_choice& choice, bool held_out, const std::string& build,
               cost_group group) {
    const auto triangles = static_cast<double>(outlook_of(scene_play(choice)).triangles);
    aabb::composition c;
    c[aabb::strategy_kind::build] = {build, {}};
    all.push_back({choice.kind + " " + settings_text(choice), held_out, [=](aabb::instrumentation counted) {
                       const observation seen = observe(choice, contender_of(c, true), {.counted = counted});
                       const auto visits = static_cast<double>(seen.work[aabb::work::node_visits]);
                       const double queries = seen.first.detect.cpu_ms + seen.rest.detect.cpu_ms;
                       return std::vector{piece{group, {triangles}, 1e6 * seen.build.cpu_ms},
                                          piece{cost_group::queries, {visits}, 1e6 * queries}};
                   }});
}

/// Two meshes, one of which passes through the other.
void add_trials(std::vector<trial>& all, const std::string& standing, const std::string& passing, std::size_t triangles,
                bool held_out) {
    const std::string of = ":triangles=" + std::to_string(triangles);
    const scene_choice choice{"mesh_pair", {{"frames", "10"}}, {standing + of, passing + of}};
    add_trial(all, choice, held_out, "median", cost_group::median);
    add_trial(all, choice, held_out, "sah", cost_group::sah);
}

std::vector<trial> box_trials(calibration_size size) {
    using sizes = std::vector<std::size_t>;
    const bool quick = size == calibration_size::quick;
    std::vector<trial> all;
    const auto add_lists = [&](const std::vector<const char*>& kinds, const sizes& objects,
                               const std::vector<const char*>& displacements, bool held_out) {
        for (const char* kind : kinds)
            for (const std::size_t n : objects)
                for (const char* displacement : displacements)
                    add_list_trials(all, {moving(kind, n, displacement, frames_for(n)), held_out});
    };
    const auto add_searches = [&](const std::vector<const char*>& kinds, const sizes& objects, bool held_out) {
        constexpr std::size_t few_frames = 6;
        for (const char* kind : kinds)
            for (const std::size_t n : objects) {
                const made_scene scene(moving(kind, n, "0.05", few_frames), held_out);
                add_cut_trials(all, scene);
                add_column_trials(all, scene);
            }
    };
    add_lists({"brownian", "mixed_sizes", "needles", "clustered"}, quick ? sizes{100, 2000} : sizes{100, 1000, 10'000},
              {"0.003", "0.1"}, false);
    add_lists({"hollow_sphere", "pile", "one_huge"}, quick ? sizes{300} : sizes{300, 3000}, {"0.003", "0.1"}, true);
    add_searches({"brownian", "mixed_sizes", "clustered"}, quick ? sizes{1000, 5000} : sizes{1000, 5000, 20'000},
                 false);
    add_searches({"needles", "hollow_sphere"}, quick ? sizes{2000} : sizes{2000, 10'000}, true);
    return all;
}

std::vector<trial> mesh_trials(calibration_size size) {
    using sizes = std::vector<std::size_t>;
    const bool quick = size == calibration_size::quick;
    std::vector<trial> all;
    for (const std::size_t triangles : quick ? sizes{3000, 20'000} : sizes{3000, 20'000, 80'000}) {
        add_trials(all, "noise_sphere", "torus_knot", triangles, false);
        add_trials(all, "icosphere", "noise_sphere", triangles, false);
    }
    for (const std::size_t triangles : quick ? sizes{8000} : sizes{8000, 40'000})
        add_trials(all, "torus_knot", "icosphere", triangles, true);
    return all;
}

using m = aabb::cost_model;

struct cost_group_info {
    std::string_view name;
    std::vector<double m::*> costs;  ///< the first kinds of work; others are fitted beside them
};

const std::array<cost_group_info, 6> cost_groups{
    {{"lists of neighbours", {&m::search_box, &m::search_pair, &m::keep_box, &m::watch_box, &m::test_pair}},
     {"axial cut", {&m::list_entry, &m::cut_entry, &m::cut_subset, &m::cut_test}},
     {"columns", {&m::column_entry, &m::column, &m::column_test}},
     {"trees by median", {&m::median_triangle}},
     {"trees by sah", {&m::sah_triangle}},
     {"queries", {&m::node_visit}}}};

/// What was seen of a group, in scenes to fit to and in others.
struct group_observations {
    std::vector<timed_work> fitted;
    std::vector<timed_work> held_out;
};

/// Counts, then times round after round, every trial once in each, until the time is over.
std::vector<group_observations> counted_and_timed(std::vector<trial> trials, double seconds) {
    constexpr std::size_t fewest_repeats = 3;
    constexpr std::size_t most_repeats = 25;
    const auto left = [seconds, began = std::chrono::steady_clock::now()] {
        return seconds - std::chrono::duration<double>(std::chrono::steady_clock::now() - began).count();
    };
    for (trial& one : trials)
        for (piece& p : one.play(aabb::instrumentation::counters))
            one.seen.emplace_back(p.group, timed_work{one.scene, std::move(p.work), {}});
    progress shown("seconds of measuring", static_cast<std::size_t>(seconds));
    const auto time = [&](trial& one, std::size_t) {
        const std::vector<piece> timed = one.play(aabb::instrumentation::none);
        for (std::size_t p = 0; p < timed.size(); ++p) one.seen[p].second.ns.push_back(timed[p].ns);
        shown.at(static_cast<std::size_t>(seconds - std::max(0.0, left())));
    };
    run_rounds(trials, {.end = most_repeats, .fewest = fewest_repeats, .left = left}, time, [](std::size_t) {});
    std::vector<group_observations> all(cost_groups.size());
    for (trial& one : trials)
        for (auto& [group, seen] : one.seen) {
            group_observations& of_group = all[static_cast<std::size_t>(group)];
            (one.held_out ? of_group.held_out : of_group.fitted).push_back(std::move(seen));
        }
    return all;
}

}  // namespace

calibration calibrate(calibration_size size, double seconds) {
    std::vector<trial> trials = box_trials(size);
    std::ranges::move(mesh_trials(size), std::back_inserter(trials));
    const std::vector<group_observations> seen = counted_and_timed(std::move(trials), seconds);
    // What seems to be free was lost in noise.
    constexpr double least_share = 0.01;
    calibration all;
    for (std::size_t g = 0; g < seen.size(); ++g) {
        const cost_group_info& group = cost_groups[g];
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
