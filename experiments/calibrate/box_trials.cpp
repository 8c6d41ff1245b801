module;
#include <cassert>

module aabblab.calibrate;

import :trial;
import aabb.counters;
import aabb.geometry;
import aabb.pipeline;
import aabb.policy;
import aabb.registry;
import aabb.simd;
import aabblab.trials;
import aabblab.scenes;

namespace aabblab {

namespace {

using box_frames = std::shared_ptr<const std::vector<std::vector<aabb::box>>>;

/// Frames that were made once, so that making them takes no time later.
class made_frames final : public aabb::box_scene {
public:
    explicit made_frames(box_frames frames) : frames_(std::move(frames)) {}

    [[nodiscard]] std::size_t objects() const override { return frames_->front().size(); }
    [[nodiscard]] std::size_t frames() const override { return frames_->size(); }
    bool next(std::vector<aabb::box>& boxes) override {
        if (played_ == frames_->size()) return false;
        boxes = (*frames_)[played_++];
        return true;
    }

private:
    box_frames frames_;
    std::size_t played_ = 0;
};

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
};

struct box_play {
    box_frames frames;
    aabb::composition composed;
    aabb::cost_model planned_by;
};

std::vector<frame_seen> frames_seen(const box_play& what, aabb::instrumentation counted) {
    const costs_for_a_while costs(what.planned_by);
    scene_play scene(std::make_unique<made_frames>(what.frames));
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

/// Work of a mean frame: what there are costs for, then what no strategy plans by, and that it is one frame.
using work_of_frame = std::function<std::vector<double>(const frame_seen&)>;

trial usual_frames(std::string scene, bool held_out, cost_group group, box_play what, work_of_frame work) {
    const auto seen = [what = std::move(what)](aabb::instrumentation counted) {
        return mean_of(frames_seen(what, counted), first_usual, 1);
    };
    return {std::move(scene), held_out,
            [seen, group, work = std::move(work)] {
                return std::vector{piece{group, work(seen(aabb::instrumentation::counters))}};
            },
            [seen] { return std::vector{seen(aabb::instrumentation::none).ns}; }};
}

/// A list that is made anew in every other frame: in those with an even number it is made, in the others it serves.
trial made_and_served(std::string scene, bool held_out, box_frames frames) {
    aabb::composition c;
    c[aabb::strategy_kind::prepare] = {"neighbour_list", {{"every", "2"}}};
    const box_play what{std::move(frames), c, {}};
    const auto seen = [what](aabb::instrumentation counted) {
        const std::vector<frame_seen> all = frames_seen(what, counted);
        return std::array{mean_of(all, first_usual, 2), mean_of(all, first_usual + 1, 2)};
    };
    return {std::move(scene), held_out,
            [seen, n = static_cast<double>(what.frames->front().size())] {
                const auto [made, served] = seen(aabb::instrumentation::counters);
                // That a list serves takes a test of each of its pairs, and no search.
                assert(made.work[aabb::work::subsets] > 0 && served.work[aabb::work::subsets] == 0);
                const auto listed = static_cast<double>(served.work[aabb::work::box_tests]);
                return std::vector{piece{cost_group::lists, {n, listed, n, n, listed}},
                                   piece{cost_group::lists, {0, 0, 0, n, listed}}};
            },
            [seen] {
                const auto [made, served] = seen(aabb::instrumentation::none);
                return std::vector{made.ns, served.ns};
            }};
}

std::string name_of_scene(const scene_choice& choice) {
    return choice.kind + " " + settings_text(choice);
}

void add_list_trials(std::vector<trial>& all, const scene_choice& choice, bool held_out) {
    const box_frames frames = frames_of(choice);
    const std::string scene = name_of_scene(choice);
    const auto n = static_cast<double>(frames->front().size());
    all.push_back(usual_frames(scene, held_out, cost_group::lists, {frames, {}, {}},
                               [n](const frame_seen& seen) { return std::vector<double>{n, seen.pairs, 0, 0, 0}; }));
    all.push_back(made_and_served(scene, held_out, frames));
}

/// @param lists that are sorted: of the axes cut, and of the one that is swept
void add_cut_trial(std::vector<trial>& all, const scene_choice& choice, bool held_out, const box_frames& frames,
                   const std::string& sort, const aabb::strategy_choice& partition, double lists) {
    aabb::composition c;
    c[aabb::strategy_kind::sort] = {sort, {}};
    c[aabb::strategy_kind::partition] = partition;
    c[aabb::strategy_kind::sweep] = {"one_axis", {}};
    const auto n = static_cast<double>(frames->front().size());
    all.push_back(usual_frames(name_of_scene(choice), held_out, cost_group::cut, {frames, c, {}},
                               [n, lists](const frame_seen& seen) {
                                   return std::vector<double>{n * lists,
                                                              static_cast<double>(seen.work[aabb::work::subset_copies]),
                                                              static_cast<double>(seen.work[aabb::work::subsets]),
                                                              static_cast<double>(seen.work[aabb::work::box_tests]),
                                                              seen.pairs,
                                                              1};
                               }));
}

void add_cut_trials(std::vector<trial>& all, const scene_choice& choice, bool held_out) {
    const box_frames frames = frames_of(choice);
    const auto cut = [](const char* axes, const char* segments) {
        return aabb::strategy_choice{"axial_cut", {{"axes", axes}, {"segments", segments}}};
    };
    add_cut_trial(all, choice, held_out, frames, "std", {"none", {}}, 1);
    add_cut_trial(all, choice, held_out, frames, "radix", {"none", {}}, 1);
    add_cut_trial(all, choice, held_out, frames, "std", cut("1", "24"), 2);
    add_cut_trial(all, choice, held_out, frames, "radix", cut("2", "8"), 3);
    add_cut_trial(all, choice, held_out, frames, "std", cut("2", "24"), 3);
    add_cut_trial(all, choice, held_out, frames, "radix", cut("3", "4"), 3);
    add_cut_trial(all, choice, held_out, frames, "radix", cut("3", "16"), 3);
}

void add_column_trial(std::vector<trial>& all, const scene_choice& choice, bool held_out, const box_frames& frames,
                      const char* axes, const aabb::cost_model& planned_by) {
    aabb::composition c;
    c[aabb::strategy_kind::partition] = {"columns", {{"axes", axes}}};
    const auto n = static_cast<double>(frames->front().size());
    all.push_back(usual_frames(
        name_of_scene(choice), held_out, cost_group::columns, {frames, c, planned_by}, [n](const frame_seen& seen) {
            // Copies are not counted where there is one column.
            return std::vector<double>{
                std::max(n, static_cast<double>(seen.work[aabb::work::subset_copies])),
                static_cast<double>(seen.work[aabb::work::subsets]),
                static_cast<double>(seen.work[aabb::work::box_tests]) / double{aabb::simd::width},
                n,
                seen.pairs,
                1};
        }));
}

/// With more columns than pay and with fewer too, so that their costs can be told apart.
void add_column_trials(std::vector<trial>& all, const scene_choice& choice, bool held_out) {
    const box_frames frames = frames_of(choice);
    constexpr double many_times = 8;
    aabb::cost_model more;
    more.column_test *= many_times;
    aabb::cost_model fewer;
    fewer.column_entry *= many_times;
    fewer.column *= many_times;
    add_column_trial(all, choice, held_out, frames, "2", {});
    add_column_trial(all, choice, held_out, frames, "2", more);
    add_column_trial(all, choice, held_out, frames, "2", fewer);
    add_column_trial(all, choice, held_out, frames, "1", {});
    add_column_trial(all, choice, held_out, frames, "0", {});
}

scene_choice moving(const char* kind, std::size_t objects, const char* displacement, std::size_t frames) {
    return {kind,
            {{"objects", std::to_string(objects)}, {"displacement", displacement}, {"frames", std::to_string(frames)}},
            {}};
}

/// As many as make a frame's time plain; odd, so that as many lists serve as are made.
std::size_t frames_for(std::size_t objects) {
    return objects < 1000 ? 41 : objects < 10'000 ? 17 : 9;
}

}  // namespace

std::vector<trial> box_trials(calibration_size size) {
    using sizes = std::vector<std::size_t>;
    const bool quick = size == calibration_size::quick;
    std::vector<trial> all;
    const auto add_lists = [&](const std::vector<const char*>& kinds, const sizes& objects,
                               const std::vector<const char*>& displacements, bool held_out) {
        for (const char* kind : kinds)
            for (const std::size_t n : objects)
                for (const char* displacement : displacements)
                    add_list_trials(all, moving(kind, n, displacement, frames_for(n)), held_out);
    };
    const auto add_searches = [&](const std::vector<const char*>& kinds, const sizes& objects, bool held_out) {
        constexpr std::size_t few_frames = 6;
        for (const char* kind : kinds)
            for (const std::size_t n : objects) {
                const scene_choice choice = moving(kind, n, "0.05", few_frames);
                add_cut_trials(all, choice, held_out);
                add_column_trials(all, choice, held_out);
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

}  // namespace aabblab
