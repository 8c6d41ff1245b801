module;
#include <cassert>

module aabblab.calibrate;

import aabb.collision_filter;
import aabb.extreme;
import aabb.pipeline;
import aabb.registry;
import aabb.simd;
import aabblab.progress;
import aabblab.scenes;
import aabblab.trials;

namespace aabblab {

namespace {

/// Costs that are fitted together, since the same runs determine them.
enum class cost_group : unsigned char { lists, cut, columns, rest, indices, median, sah, queries };

/// A part of a run whose work belongs to one group.
struct measured_part {
    cost_group group;
    std::vector<double> work;  ///< valid if the run counts it
    double ns;                 ///< valid if the run does not count
};

/// One scene with one composition.
struct trial {
    std::string scene;
    bool held_out;  ///< used to check the fit, not for it
    std::function<std::vector<measured_part>(aabb::instrumentation)> run;
    std::vector<std::pair<cost_group, timed_work>> observations = {};  ///< by part
};

using box_frames = std::shared_ptr<const std::vector<std::vector<aabb::box>>>;

/// Generates all frames in advance, so that this takes no time during measurements.
box_frames frames_of(const scene_choice& choice) {
    const auto scene = make_box_scene(choice);
    std::vector<std::vector<aabb::box>> frames;
    std::vector<aabb::box> boxes;
    while (scene->next(boxes)) frames.push_back(boxes);
    return std::make_unique<const std::vector<std::vector<aabb::box>>>(std::move(frames));
}

/// Makes strategies plan by other costs, until it is destroyed.
class costs_in_scope {
public:
    explicit costs_in_scope(const aabb::cost_model& costs) : before_(aabb::machine_costs()) {
        aabb::set_machine_costs(costs);
    }
    costs_in_scope(const costs_in_scope&) = delete;
    costs_in_scope& operator=(const costs_in_scope&) = delete;
    ~costs_in_scope() { aabb::set_machine_costs(before_); }

private:
    aabb::cost_model before_;
};

/// Measurements of a frame, or their means over several frames.
struct frame_sample {
    double ns = 0, pairs = 0;
    aabb::work_counters work;

    [[nodiscard]] double count(aabb::work what) const { return static_cast<double>(work[what]); }
};

struct box_run {
    box_frames frames;
    aabb::composition composed;
    aabb::cost_model planned_by;
    std::shared_ptr<const aabb::collision_filter> filter = nullptr;
};

/// Runs the broad phase and measures each frame: its work if the run counts it, otherwise its time.
std::vector<frame_sample> sample_frames(const box_run& run, aabb::instrumentation counted) {
    const costs_in_scope costs(run.planned_by);
    scene_frames scene(std::make_unique<aabb::known_boxes>(*run.frames));
    scene.filter_by(run.filter);
    stage_runner runner(candidate_of(run.composed, /*meshes=*/false), scene, counted);
    aabb::work_counters before;
    std::vector<frame_sample> samples;
    run_frames(scene, runner, [&](const searched_frame& frame) {
        frame_sample sample{.ns = 1e6 * (frame.took.update.cpu_ms + frame.took.search.cpu_ms),
                            .pairs = static_cast<double>(frame.pairs.size()),
                            .work = {}};
        const aabb::work_counters work = runner.counters();
        for (std::size_t k = 0; k < work.counts.size(); ++k) sample.work.counts[k] = work.counts[k] - before.counts[k];
        before = work;
        samples.push_back(sample);
    });
    return samples;
}

/// Earlier frames are not representative: nothing is sorted, planned or kept between frames yet.
constexpr std::size_t warm_up_frames = 2;

/// The mean time, pairs and work of frames first, first + step, first + 2 step, ...
frame_sample mean_of(const std::vector<frame_sample>& frames, std::size_t first, std::size_t step) {
    frame_sample mean;
    std::uint64_t count = 0;
    for (std::size_t i = first; i < frames.size(); i += step, ++count) {
        mean.ns += frames[i].ns;
        mean.pairs += frames[i].pairs;
        for (std::size_t k = 0; k < mean.work.counts.size(); ++k) mean.work.counts[k] += frames[i].work.counts[k];
    }
    mean.ns /= static_cast<double>(count);
    mean.pairs /= static_cast<double>(count);
    for (std::uint64_t& k : mean.work.counts) k /= count;
    return mean;
}

/// A scene with frames that are generated in advance.
struct generated_scene {
    generated_scene(const scene_choice& choice, bool is_held_out)
        : name(choice.kind + " " + settings_text(choice)),
          held_out(is_held_out),
          frames(frames_of(choice)),
          n(static_cast<double>(frames->front().size())) {}

    std::string name;
    bool held_out;
    box_frames frames;
    double n;  // objects
};

/// The work of a mean frame: first the kinds with a cost, then kinds that no strategy plans by, with a constant 1.
using work_of_frame = std::function<std::vector<double>(const frame_sample&)>;

/// A trial that measures the mean frame after the warm-up; `work` computes its work from the counters.
trial frames_trial(const generated_scene& scene, cost_group group, const box_run& run, work_of_frame work) {
    const auto measure = [group, run, work = std::move(work)](aabb::instrumentation counted) {
        const frame_sample mean = mean_of(sample_frames(run, counted), warm_up_frames, /*step=*/1);
        return std::vector{measured_part{group, work(mean), mean.ns}};
    };
    return {scene.name, scene.held_out, measure};
}

/// The work of a frame, in the order of the costs of `cost_group::lists`.
struct list_work {
    double searched_boxes = 0, searched_pairs = 0, kept_boxes = 0, watched_boxes = 0, tested_pairs = 0;

    [[nodiscard]] std::vector<double> by_cost() const {
        return {searched_boxes, searched_pairs, kept_boxes, watched_boxes, tested_pairs};
    }
};

/// Adds two trials for the costs of Verlet lists: a plain search in every frame; and a list that is rebuilt in every
/// even frame and reused in every odd one, with a measurement for each of the two.
void add_list_trials(std::vector<trial>& trials, const generated_scene& scene) {
    trials.push_back(
        frames_trial(scene, cost_group::lists, {scene.frames, {}, {}}, [n = scene.n](const frame_sample& mean) {
            return list_work{.searched_boxes = n, .searched_pairs = mean.pairs}.by_cost();
        }));
    aabb::composition c;
    c[aabb::strategy_kind::prepare] = {"neighbour_list", {{"every", "2"}}};
    const auto measure = [n = scene.n, run = box_run{scene.frames, c, {}}](aabb::instrumentation counted) {
        const std::vector<frame_sample> samples = sample_frames(run, counted);
        static_assert(warm_up_frames % 2 == 0, "the first frame after the warm-up builds the list");
        const frame_sample built = mean_of(samples, warm_up_frames, /*step=*/2);
        const frame_sample reused = mean_of(samples, warm_up_frames + 1, /*step=*/2);
        // Reuse of a list tests each of its pairs and does not search.
        assert(counted == aabb::instrumentation::none ||
               (built.work[aabb::work::subsets] > 0 && reused.work[aabb::work::subsets] == 0));
        // A build searches, then watches the boxes and tests the pairs of its list in the same frame.
        const list_work reuse{.watched_boxes = n, .tested_pairs = reused.count(aabb::work::box_tests)};
        list_work build = reuse;
        build.searched_boxes = build.kept_boxes = n;
        build.searched_pairs = reuse.tested_pairs;
        return std::vector{measured_part{cost_group::lists, build.by_cost(), built.ns},
                           measured_part{cost_group::lists, reuse.by_cost(), reused.ns}};
    };
    trials.push_back({scene.name, scene.held_out, measure});
}

/// Adds a trial of a search with this sort and with an axial cut of the world into subsets, or with none.
/// @param lists how many lists it sorts: one for each cut axis, and one for the swept axis if that is not cut
void add_cut_trial(std::vector<trial>& trials, const generated_scene& scene, const std::string& sort,
                   const aabb::strategy_choice& partition, double lists) {
    aabb::composition c;
    c[aabb::strategy_kind::sort] = {sort, {}};
    c[aabb::strategy_kind::partition] = partition;
    c[aabb::strategy_kind::sweep] = {"one_axis", {}};
    trials.push_back(frames_trial(scene, cost_group::cut, {scene.frames, c, {}},
                                  [listed = scene.n * lists](const frame_sample& mean) {
                                      return std::vector<double>{listed,
                                                                 mean.count(aabb::work::subset_copies),
                                                                 mean.count(aabb::work::subsets),
                                                                 mean.count(aabb::work::box_tests),
                                                                 mean.pairs,
                                                                 /*constant term=*/1};
                                  }));
}

/// Adds trials of axial cuts with one, few and many subsets: work in different ratios lets the fit separate the costs.
void add_cut_trials(std::vector<trial>& trials, const generated_scene& scene) {
    const auto cut = [](const char* axes, const char* segments) {
        return aabb::strategy_choice{"axial_cut", {{"axes", axes}, {"segments", segments}}};
    };
    add_cut_trial(trials, scene, "std", {"none", {}}, /*lists=*/1);
    add_cut_trial(trials, scene, "radix", {"none", {}}, /*lists=*/1);
    add_cut_trial(trials, scene, "std", cut("1", "24"), /*lists=*/2);
    add_cut_trial(trials, scene, "radix", cut("2", "8"), /*lists=*/3);
    add_cut_trial(trials, scene, "std", cut("2", "24"), /*lists=*/3);
    add_cut_trial(trials, scene, "radix", cut("3", "4"), /*lists=*/3);
    add_cut_trial(trials, scene, "radix", cut("3", "16"), /*lists=*/3);
}

/// Adds a trial of a search by columns. Its number of columns is planned by `planned_by`, which need not be true costs.
/// @param axes number of axes along which the world is divided
void add_column_trial(std::vector<trial>& trials, const generated_scene& scene, const char* axes,
                      const aabb::cost_model& planned_by) {
    aabb::composition c;
    c[aabb::strategy_kind::partition] = {"columns", {{"axes", axes}}};
    trials.push_back(frames_trial(
        scene, cost_group::columns, {scene.frames, c, planned_by}, [n = scene.n](const frame_sample& mean) {
            // Copies are not counted if there is a single column.
            return std::vector<double>{std::max(n, mean.count(aabb::work::subset_copies)),
                                       mean.count(aabb::work::subsets),
                                       mean.count(aabb::work::box_tests) / double{aabb::simd::width},
                                       n,
                                       mean.pairs,
                                       /*constant term=*/1};
        }));
}

/// Adds trials with as many columns as are optimal, with more and with fewer, so that the fit can separate the costs.
/// If the plan is given too high a cost of tests, it has more columns; if too high a cost of columns, fewer.
void add_column_trials(std::vector<trial>& trials, const generated_scene& scene) {
    constexpr double exaggeration = 8;
    aabb::cost_model more;
    more.column_test *= exaggeration;
    aabb::cost_model fewer;
    fewer.column_entry *= exaggeration;
    fewer.column *= exaggeration;
    add_column_trial(trials, scene, "2", {});
    add_column_trial(trials, scene, "2", more);
    add_column_trial(trials, scene, "2", fewer);
    add_column_trial(trials, scene, "1", {});
    add_column_trial(trials, scene, "0", {});
}

/// Adds trials of boxes of which a share moves among others at rest.
void add_rest_trials(std::vector<trial>& trials, std::size_t objects, const char* ratio, bool held_out) {
    aabb::cost_model never_all;
    never_all.active_box = 1e-9;
    for (const double moving : {0.02, 0.1, 0.3}) {
        const scene_choice choice{"cloud",
                                  {{"objects", std::to_string(objects)},
                                   {"moving", std::to_string(moving)},
                                   {"ratio", ratio},
                                   {"displacement", "0.5"},
                                   {"frames", "60"}},
                                  {}};
        const generated_scene scene(choice, held_out);
        trials.push_back(frames_trial(scene, cost_group::rest, {scene.frames, {}, never_all},
                                      [n = scene.n, moving](const frame_sample& mean) {
                                          return std::vector<double>{moving * n, n, mean.pairs, /*constant term=*/1};
                                      }));
    }
}

/// Adds trials of two sets that are joined by an index, with a half, a quarter and a sixteenth of the boxes looked up.
void add_index_trials(std::vector<trial>& trials, const generated_scene& scene) {
    aabb::cost_model always_joins;
    always_joins.refit_box = always_joins.open_node = 1e-9;
    for (const std::uint32_t one_in : {2U, 4U, 16U}) {
        auto sets = std::make_unique<aabb::collision_filter>();
        for (std::uint32_t id = 0; id < scene.frames->front().size(); ++id)
            sets->set(id, {.set = id % one_in == 0 ? aabb::object_set::a : aabb::object_set::b});
        const box_run run{scene.frames, {}, always_joins, std::move(sets)};
        trials.push_back(frames_trial(scene, cost_group::indices, run, [n = scene.n, one_in](const frame_sample& mean) {
            return std::vector<double>{n, mean.count(aabb::work::box_tests) / 8, n / one_in, mean.pairs,
                                       /*constant term=*/1};
        }));
    }
}

scene_choice moving_boxes(const char* kind, std::size_t objects, const char* displacement, std::size_t frames) {
    return {kind,
            {{"objects", std::to_string(objects)}, {"displacement", displacement}, {"frames", std::to_string(frames)}},
            {}};
}

/// Enough frames for a stable time per frame. The number is odd, so that as many frames reuse a list as build one.
std::size_t frames_for(std::size_t objects) {
    return objects < 1000 ? 41 : objects < 10'000 ? 17 : 9;
}

/// Adds a trial of the narrow phase with two measurements: building the trees, whose work is the number of triangles,
/// and all queries, whose work is the number of node visits.
/// @param held_out whether it serves to check the fit, and not for the fit
/// @param group of the costs of this build
void add_mesh_trial(std::vector<trial>& trials, const scene_choice& choice, bool held_out, const std::string& build,
                    cost_group group) {
    const auto triangles = static_cast<double>(traits_of(scene_frames(choice)).triangles);
    aabb::composition c;
    c[aabb::strategy_kind::build] = {build, {}};
    trials.push_back({choice.kind + " " + settings_text(choice), held_out, [=](aabb::instrumentation counted) {
                          const auto result = observe(choice, candidate_of(c, /*meshes=*/true), {.counted = counted});
                          const auto visits = static_cast<double>(result.work[aabb::work::node_visits]);
                          const double queries = result.first.detect.cpu_ms + result.rest.detect.cpu_ms;
                          return std::vector{measured_part{group, {triangles}, 1e6 * result.build.cpu_ms},
                                             measured_part{cost_group::queries, {visits}, 1e6 * queries}};
                      }});
}

/// Adds trials of two meshes; one passes through the other.
void add_mesh_trials(std::vector<trial>& trials, const std::string& standing, const std::string& passing,
                     std::size_t triangles, bool held_out) {
    const std::string size = ":triangles=" + std::to_string(triangles);
    const scene_choice choice{"mesh_pair", {{"frames", "10"}}, {standing + size, passing + size}};
    add_mesh_trial(trials, choice, held_out, "median", cost_group::median);
    add_mesh_trial(trials, choice, held_out, "sah", cost_group::sah);
}

using sizes = std::vector<std::size_t>;

/// Trials of Verlet lists, axial cuts, columns, boxes at rest and indices; the held-out ones, which check the fit, use
/// other kinds of scenes.
std::vector<trial> box_trials(calibration_size size) {
    const bool quick = size == calibration_size::quick;
    std::vector<trial> trials;
    const auto add_lists = [&](const std::vector<const char*>& kinds, const sizes& objects,
                               const std::vector<const char*>& displacements, bool held_out) {
        for (const char* kind : kinds)
            for (const std::size_t n : objects)
                for (const char* displacement : displacements)
                    add_list_trials(trials, {moving_boxes(kind, n, displacement, frames_for(n)), held_out});
    };
    const auto add_searches = [&](const std::vector<const char*>& kinds, const sizes& objects, bool held_out) {
        constexpr std::size_t few_frames = 6;
        for (const char* kind : kinds)
            for (const std::size_t n : objects) {
                const generated_scene scene(moving_boxes(kind, n, "0.05", few_frames), held_out);
                add_cut_trials(trials, scene);
                add_column_trials(trials, scene);
                add_index_trials(trials, scene);
            }
    };
    add_lists({"brownian", "mixed_sizes", "needles", "clustered"}, quick ? sizes{100, 2000} : sizes{100, 1000, 10'000},
              {"0.003", "0.1"}, /*held_out=*/false);
    add_lists({"hollow_sphere", "pile", "one_huge"}, quick ? sizes{300} : sizes{300, 3000}, {"0.003", "0.1"},
              /*held_out=*/true);
    add_searches({"brownian", "mixed_sizes", "clustered"}, quick ? sizes{1000, 5000} : sizes{1000, 5000, 20'000},
                 /*held_out=*/false);
    for (const std::size_t n : quick ? sizes{1000, 5000} : sizes{1000, 5000, 20'000})
        for (const char* ratio : {"1", "3"}) add_rest_trials(trials, n, ratio, /*held_out=*/false);
    for (const std::size_t n : quick ? sizes{2000} : sizes{2000, 10'000})
        add_rest_trials(trials, n, "2", /*held_out=*/true);
    add_searches({"needles", "hollow_sphere"}, quick ? sizes{2000} : sizes{2000, 10'000}, /*held_out=*/true);
    return trials;
}

/// Trials of builds and queries of trees, on pairs of shapes. The held-out ones, which check the fit, use another pair.
std::vector<trial> mesh_trials(calibration_size size) {
    const bool quick = size == calibration_size::quick;
    std::vector<trial> trials;
    for (const std::size_t triangles : quick ? sizes{3000, 20'000} : sizes{3000, 20'000, 80'000}) {
        add_mesh_trials(trials, "noise_sphere", "torus_knot", triangles, /*held_out=*/false);
        add_mesh_trials(trials, "icosphere", "noise_sphere", triangles, /*held_out=*/false);
    }
    for (const std::size_t triangles : quick ? sizes{8000} : sizes{8000, 40'000})
        add_mesh_trials(trials, "torus_knot", "icosphere", triangles, /*held_out=*/true);
    return trials;
}

using m = aabb::cost_model;

struct cost_group_info {
    std::string_view name;
    std::vector<double m::*> costs;  ///< of the first kinds of work; further kinds are fitted as well
};

const std::array<cost_group_info, 8> cost_groups{
    {{"Verlet lists", {&m::search_box, &m::search_pair, &m::keep_box, &m::watch_box, &m::test_pair}},
     {"axial cut", {&m::list_entry, &m::cut_entry, &m::cut_subset, &m::cut_test}},
     {"columns", {&m::column_entry, &m::column, &m::column_test}},
     {"boxes at rest", {&m::active_box}},
     {"indices of a filter", {&m::refit_box, &m::open_node}},
     {"median builds", {&m::median_triangle}},
     {"SAH builds", {&m::sah_triangle}},
     {"queries", {&m::node_visit}}}};

/// The observations of a group, of scenes used for the fit and of held-out scenes.
struct group_observations {
    std::vector<timed_work> fitted, held_out;
};

/// Runs every trial once with its work counted, then times all trials in interleaved rounds until the time is over,
/// with 3 to 25 repeats. @returns work and times by group of costs
std::vector<group_observations> observe_trials(std::vector<trial> trials, double seconds) {
    constexpr std::size_t fewest_repeats = 3, most_repeats = 25;
    const auto remaining = [seconds, began = std::chrono::steady_clock::now()] {
        return seconds - std::chrono::duration<double>(std::chrono::steady_clock::now() - began).count();
    };
    for (trial& t : trials)
        for (measured_part& p : t.run(aabb::instrumentation::counters))
            t.observations.emplace_back(p.group, timed_work{t.scene, std::move(p.work), {}});
    progress shown("seconds of measurement", static_cast<std::size_t>(seconds));
    const auto time = [&](trial& t, std::size_t) {
        const std::vector<measured_part> timed = t.run(aabb::instrumentation::none);
        for (std::size_t p = 0; p < timed.size(); ++p) t.observations[p].second.ns.push_back(timed[p].ns);
        shown.update(static_cast<std::size_t>(seconds - std::max(0.0, remaining())));
    };
    run_rounds(trials, {.end = most_repeats, .fewest = fewest_repeats, .seconds_left = remaining}, time, [](auto) {});
    std::vector<group_observations> by_group(cost_groups.size());
    for (trial& t : trials)
        for (auto& [group, timed] : t.observations) {
            group_observations& of_group = by_group[static_cast<std::size_t>(group)];
            (t.held_out ? of_group.held_out : of_group.fitted).push_back(std::move(timed));
        }
    return by_group;
}

}  // namespace

/// Fits the costs of operations on this machine to work and times of trials, and checks them on held-out scenes.
calibration calibrate(calibration_size size, double seconds) {
    std::vector<trial> trials = box_trials(size);
    std::ranges::move(mesh_trials(size), std::back_inserter(trials));
    const std::vector<group_observations> observed = observe_trials(std::move(trials), seconds);
    // A cost of nearly 0 means that noise hid it, for nothing is free: it becomes a hundredth of the shipped cost.
    constexpr double least_share = 0.01;
    calibration result;
    for (std::size_t g = 0; g < observed.size(); ++g) {
        const cost_group_info& group = cost_groups[g];
        std::vector<estimate> costs = fit_costs(observed[g].fitted);
        for (std::size_t k = 0; k < group.costs.size(); ++k) {
            costs[k].value = std::max(costs[k].value, least_share * (aabb::cost_model{}.*group.costs[k]));
            result.costs.*group.costs[k] = costs[k].value;
            const auto info = std::ranges::find(aabb::cost_infos, group.costs[k], &aabb::cost_info::value);
            result.estimates[static_cast<std::size_t>(info - aabb::cost_infos.begin())] = costs[k];
        }
        result.checks.push_back({group.name, accuracy_of(observed[g].held_out, costs)});
    }
    return result;
}

}  // namespace aabblab
