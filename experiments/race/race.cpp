module;
#include <random>

module aabblab.race;

import aabb.pipeline;
import aabb.registry;
import aabb.selection;
import aabb.validation;
import aabblab.fmt;
import aabblab.numbers;
import aabblab.progress;

namespace aabblab {

namespace {

constexpr std::size_t first_frames = 4, most_repeats = 15;
constexpr std::size_t fewest_finalists = 2, most_finalists = 6;
/// A candidate beyond this ratio to the fastest, in total and per frame, is dropped. The margin shrinks every round.
constexpr double first_margin = 2, last_margin = 1.25;
/// The share of the time that the first round may use, so that some remains for repeats.
constexpr double share_of_first_round = 2.0 / 3;

/// Logarithms of the ratio of two times within the same repeat, which cancels slow and fast phases of the machine.
cells log_ratios(const racer& r, const racer& other) {
    cells ratios(1, 1);
    for (std::size_t i = 0; i < r.times.size(); ++i)
        ratios.add(0, 0, std::log(r.times[i].whole_ms() / other.times[i].whole_ms()));
    return ratios;
}

/// The median log-ratio by which the closest rival is behind; negative if a rival is ahead.
double lead_of(const racer& r, const std::vector<racer>& finalists) {
    const resample as_measured(1, 1, level::none, 0);
    double least = std::numeric_limits<double>::infinity();
    for (const racer& other : finalists)
        if (&other != &r) least = std::min(least, as_measured.mean_of(log_ratios(other, r)));
    return least;
}

observation median_of(std::vector<observation> times) {
    const auto middle = times.begin() + static_cast<std::ptrdiff_t>(times.size() / 2);
    std::ranges::nth_element(times, middle, {}, &observation::whole_ms);
    return *middle;
}

/// A race in three steps. In the first round all candidates run a few frames. Rounds of twice as many frames follow,
/// and each drops slow candidates. In the final, the remaining ones run in interleaved repeats.
class race {
public:
    race(staged_scene& scene, std::vector<racer> candidates, const time_limits& limits)
        : scene_(scene), limits_(limits), budget_(limits.to_run()), running_(std::move(candidates)) {}

    /// Finds the fastest of the candidates `running_`. Rounds drop slow ones while there are too many for a final and
    /// more than half of the time is left. Then the slowest are dropped until the final, in which runs are repeated,
    /// fits into the rest. The pairs that the finalists find are compared with those of CGAL.
    race_result run() {
        result_.objects = scene_.scene().objects();
        result_.frames = scene_.scene().frames();
        result_.frames_of_all = result_.frames * running_.size();  // as if no candidate were stopped early
        std::size_t frames = std::min(result_.frames, first_frames);
        double margin = first_margin;  // the ratio to the fastest beyond which a candidate is dropped
        run_first_round(frames, margin);
        while (frames < result_.frames && running_.size() > most_finalists && seconds_left() > budget_ / 2) {
            frames = std::min(result_.frames, 2 * frames);
            margin = std::max(last_margin, std::sqrt(margin));  // halved on a logarithmic scale
            if (!run_round(frames, margin)) break;
        }
        result_.final_frames = running_.front().last->frames;
        // Each round sorts the candidates by time, so the last one is the slowest.
        for (; running_.size() > most_finalists || (running_.size() > fewest_finalists && !final_fits(result_.frames));
             running_.pop_back())
            result_.dropped.push_back(std::move(running_.back()));
        run_final();
        compare_with_cgal();
        rank(running_);
        std::ranges::reverse(result_.dropped);
        result_.finalists = std::move(running_);
        for (const std::vector<racer>* racers : {&result_.finalists, &result_.dropped, &result_.wrong})
            for (const racer& r : *racers) result_.frames_run += r.frames;
        return std::move(result_);
    }

private:
    [[nodiscard]] double seconds_left() const { return limits_.to_run(); }

    /// The time limit in seconds of a run that may take `margin` times as long as the fastest so far, `least`, infinite
    /// before any. The very first run of the race gets more.
    [[nodiscard]] double time_limit(double least, double margin) const {
        const stopping_rule rule{.grace = std::min(1.0, budget_ / 20), .share = budget_ / 16, .margin = margin};
        return std::isfinite(least) ? rule.longest(least) : rule.grace + budget_ / 4;
    }

    /// Runs a candidate on the first frames of the scene and records its times (`last`), or that it did not finish
    /// (`broken_off`). Returns whether it finished.
    /// @param seconds the time limit of this run
    /// @param time_left the time for all runs together
    bool run_candidate(racer& r, std::size_t frames, double seconds, double time_left) {
        attempt outcome = scene_.run(r.tested, frames, seconds, time_left);
        if (outcome.end != ending::done) {
            r.frames = std::max(r.frames, outcome.seen.frames);
            r.broken_off = std::move(outcome);
            return false;
        }
        r.last = std::move(outcome.seen);
        r.seconds = outcome.seconds;
        r.frames = frames;
        return true;
    }

    /// Runs all candidates on the first frames, and stops those that take much longer than the fastest so far (by more
    /// than the factor `margin`).
    /// @param frames the number of frames. If it is too large for the first round, it becomes the number that a stopped
    /// candidate finished, before any candidate finished all; that one then counts as finished
    /// @returns whether any candidate finished
    bool run_all(std::size_t& frames, double margin, bool is_first_round) {
        progress shown("candidates over " + counted(frames, "frame"), running_.size());
        const double reserved = is_first_round ? (1 - share_of_first_round) * budget_ : 0;  // for later rounds
        double least = std::numeric_limits<double>::infinity();                             // seconds of the fastest
        std::size_t done = 0;
        for (racer& r : running_) {
            bool is_done = run_candidate(r, frames, time_limit(least, margin), seconds_left() - reserved);
            const bool has_too_many_frames = !is_done && is_first_round && !std::isfinite(least) &&
                                             r.broken_off->end == ending::stopped && r.frames > 0;
            if (has_too_many_frames) {
                frames = r.frames;
                r.seconds = r.broken_off->seconds_of_frames;
                r.last = std::move(r.broken_off->seen);
                r.broken_off.reset();
                is_done = true;
            }
            if (is_done) least = std::min(least, r.seconds);
            shown.update(++done);
        }
        return std::isfinite(least);
    }

    /// Runs all candidates on the first frames; if none finishes, the first gets the remaining time for one frame.
    void run_first_round(std::size_t& frames, double margin) {
        if (!run_all(frames, margin, /*is_first_round=*/true)) {
            frames = 1;
            racer& first = running_.front();
            first.broken_off.reset();
            if (!run_candidate(first, frames, limits_.to_end(), limits_.to_end())) reject_all();
        }
        finish_round(frames, margin);
    }

    /// Reports that no candidate finished: by the message of one that rejected the scene, or how the first one ended.
    [[noreturn]] void reject_all() const {
        for (const racer& r : running_)
            if (r.broken_off->end == ending::rejected) throw aabb::input_error(r.broken_off->reason);
        const racer& first = running_.front();
        throw aabb::input_error(fmt::format("no candidate finishes frame 0 of this scene; {}: {}{}", first.name,
                                            text_of(*first.broken_off),
                                            first.broken_off->end == ending::stopped ? "; increase --seconds" : ""));
    }

    /// Runs all candidates on the first frames and drops those slower than the fastest by more than `margin`. If time
    /// is over before all have run, or none finishes, previous runs are restored, and none is dropped.
    /// @returns whether the round counts
    bool run_round(std::size_t frames, double margin) {
        const std::vector<racer> before = running_;
        const bool any_done = run_all(frames, margin, /*is_first_round=*/false);
        const bool is_out_of_time =
            std::ranges::any_of(running_, [](const racer& r) { return r.broken_off && r.broken_off->is_out_of_time; });
        if (!is_out_of_time) require_any_accepted();
        if (is_out_of_time || !any_done) {
            running_ = before;
            return false;
        }
        finish_round(frames, margin);
        return true;
    }

    void finish_round(std::size_t frames, double margin) {
        update_ratios();
        rerun_close_candidates(frames, margin);
        drop_slow(margin);
    }

    [[nodiscard]] double total_ms(const racer& r) const { return r.last->over(static_cast<double>(result_.frames)); }

    void update_ratios() {
        double least = std::numeric_limits<double>::infinity();
        for (const racer& r : running_)
            if (r.last) least = std::min(least, total_ms(r));
        for (racer& r : running_) r.slowdown = r.last ? total_ms(r) / least : 0;
    }

    /// Runs candidates again that were slightly too slow (`slowdown`, the ratio to the fastest, exceeds the margin), as
    /// they may have been disturbed; the faster run counts. Half of the time is kept for the final.
    void rerun_close_candidates(std::size_t frames, double margin) {
        constexpr double far_behind = 2;  // times the margin: a disturbance alone hardly costs that much
        for (racer& r : running_) {
            if (r.broken_off || r.slowdown <= margin || r.slowdown > far_behind * margin ||
                seconds_left() < budget_ / 2)
                continue;
            const attempt second = scene_.run(r.tested, frames, time_limit(r.seconds, margin), seconds_left());
            if (second.end == ending::done && second.seen.whole_ms() < r.last->whole_ms()) r.last = second.seen;
        }
        update_ratios();
    }

    /// Drops candidates that did not finish, or are slower than the fastest by more than the factor `margin` both in
    /// total time (`slowdown`) and per frame after frame 0 (`steady_ms`). Sorts the others from the fastest.
    void drop_slow(double margin) {
        double least_steady = std::numeric_limits<double>::infinity();
        for (const racer& r : running_)
            if (r.last) least_steady = std::min(least_steady, r.last->steady_ms());
        std::ranges::stable_sort(running_, [](const racer& a, const racer& b) {
            return a.last.has_value() && (!b.last || a.slowdown < b.slowdown);
        });
        keep_only([&](const racer& r) {
            return !r.broken_off &&
                   (r.slowdown <= margin || (r.last->frames > 1 && r.last->steady_ms() <= margin * least_steady));
        });
    }

    template <class Stays>
    void keep_only(Stays is_kept) {
        const auto first_out = std::stable_partition(running_.begin(), running_.end(), is_kept);
        for (auto last = running_.end(); last != first_out;) result_.dropped.push_back(std::move(*--last));
        running_.erase(first_out, running_.end());
    }

    /// Estimates the seconds of a run; untimed work, as reading and sorting, is assumed to be constant per frame.
    [[nodiscard]] static double seconds_of(const racer& r, std::size_t frames) {
        const double share = static_cast<double>(frames) / static_cast<double>(r.last->frames);
        return r.last->over(static_cast<double>(frames)) / 1000 +
               share * std::max(0.0, r.seconds - r.last->whole_ms() / 1000);
    }
    [[nodiscard]] double seconds_of_repeat(std::size_t frames) const {
        double seconds = 0;
        for (const racer& r : running_) seconds += seconds_of(r, frames);
        return seconds;
    }
    [[nodiscard]] bool final_fits(std::size_t frames) const {
        return fewest_repeats * seconds_of_repeat(frames) <= seconds_left();
    }

    /// The number of frames of the final: all, or what fits into the time left, but at least those of the last round,
    /// `final_frames`. Each step reduces the difference to these by an eighth.
    [[nodiscard]] std::size_t frames_of_final() const {
        std::size_t frames = result_.frames;
        while (frames > result_.final_frames && !final_fits(frames))
            frames -= std::max<std::size_t>(1, (frames - result_.final_frames) / 8);
        return frames;
    }

    /// Repeats interleaved runs of the finalists, the candidates `running_`, as often as time allows. Finalists that
    /// fail or far exceed their estimated time are dropped. If no repeat is finished, the last round counts as one.
    void run_final() {
        const std::size_t frames = frames_of_final();
        progress shown("repeats of the final", most_repeats);
        const std::vector<racer> before = running_;
        bool is_out_of_time = false;  // time is over within a repeat, which is discarded
        const auto run = [&](racer& r, std::size_t) {
            auto outcome = scene_.run(r.tested, frames, time_limit(seconds_of(r, frames), last_margin), seconds_left());
            if (outcome.is_out_of_time) {
                is_out_of_time = true;
            } else if (outcome.end == ending::done) {
                r.times.push_back(std::move(outcome.seen));
                r.frames = frames;
            } else {
                r.broken_off = std::move(outcome);
            }
        };
        const auto drop = [&](std::size_t repeat) {
            if (is_out_of_time)
                for (racer& r : running_) r.times.resize(std::min(repeat, r.times.size()));
            else
                require_any_accepted();
            keep_only([](const racer& r) { return !r.broken_off; });
            shown.update(repeat + 1);
        };
        const round_limits limits{
            .end = most_repeats, .seconds_left = [&] { return seconds_left(); }, .expected = seconds_of_repeat(frames)};
        run_rounds(running_, limits, run, drop);
        if (!running_.empty() && !running_.front().times.empty()) {
            result_.final_frames = frames;
            return;
        }
        if (running_.empty()) restore(before);
        for (racer& r : running_) r.times.push_back(*r.last);
    }

    /// Restores all finalists if they were dropped only for exceeding their limits.
    void restore(std::vector<racer> before) {
        const auto finalists = std::span(result_.dropped).last(before.size());
        if (std::ranges::any_of(finalists, [](const racer& r) { return r.broken_off->end != ending::stopped; }))
            throw aabb::input_error("no candidate finishes this scene");
        result_.dropped.resize(result_.dropped.size() - before.size());
        running_ = std::move(before);
    }

    /// Rejects the scene if all candidates reject it: its input is invalid.
    void require_any_accepted() const {
        if (std::ranges::all_of(running_,
                                [](const racer& r) { return r.broken_off && r.broken_off->end == ending::rejected; }))
            throw aabb::input_error(running_.front().broken_off->reason);
    }

    /// Moves finalists whose results differ from CGAL's to `wrong`. If CGAL does not finish in time, the frames that it
    /// finished are compared: `digests[i]` is a hash of all pairs up to frame i.
    void compare_with_cgal() {
        const auto cgal = std::ranges::find(aabb::engines(), "cgal", &aabb::engine_info::name);
        const attempt exact = scene_.run(*candidate_of(*cgal, scene_.scene().meshes() != nullptr), result_.final_frames,
                                         limits_.to_end());
        result_.validated = exact.seen.frames;
        if (result_.validated == 0) return;
        const auto agrees = [&](const racer& r) {
            return std::ranges::all_of(
                r.times, [&](const observation& t) { return t.digests[result_.validated - 1] == exact.seen.digest; });
        };
        const auto first_wrong = std::stable_partition(running_.begin(), running_.end(), agrees);
        result_.wrong.assign(std::move_iterator(first_wrong), std::move_iterator(running_.end()));
        running_.erase(first_wrong, running_.end());
        if (running_.empty()) throw std::runtime_error("no candidate finds the exact pairs of this scene");
    }

    staged_scene& scene_;
    const time_limits& limits_;
    double budget_;  // total time for runs, in seconds
    std::vector<racer> running_;
    race_result result_;
};

}  // namespace

/// Sorts finalists from the fastest. The winner is the one with the greatest lead, where the lead of r is the minimum
/// over its rivals s of the median over repeats of log(time of s / time of r). The others are sorted by the median of
/// their log-ratio to the winner, with confidence intervals by bootstrap.
void rank(std::vector<racer>& finalists) {
    if (finalists.empty()) return;
    const auto first = std::ranges::max_element(finalists, {}, [&](const racer& r) { return lead_of(r, finalists); });
    std::rotate(finalists.begin(), first, first + 1);
    for (racer& r : finalists) {
        r.last = median_of(r.times);
        r.log_ratio = bootstrap(log_ratios(r, finalists.front()));
        // Pairwise medians need not be transitive, so a finalist may seem ahead of the winner.
        r.log_ratio->value = std::max(r.log_ratio->value, 0.0);
    }
    std::stable_sort(finalists.begin() + 1, finalists.end(),
                     [](const racer& a, const racer& b) { return a.log_ratio->value < b.log_ratio->value; });
}

/// The candidates for a scene: `auto`, then exact engines (other libraries) and every other exact composition of
/// strategies, for meshes those of the narrow phase.
std::vector<racer> race_candidates(const scene_frames& scene) {
    const bool meshes = scene.meshes() != nullptr;
    std::vector<racer> candidates;
    const auto add = [&](candidate tested, std::string name) {
        candidates.push_back({.tested = std::move(tested), .name = std::move(name)});
    };
    const auto automatic = candidate_of(select_composition({}, traits_of(scene)), meshes).name;
    add(candidate_of(aabb::named_strategies(), scene), "auto (= " + text_of(automatic) + ")");
    // An inexact engine cannot be recommended.
    for (const aabb::engine_info& engine : aabb::engines())
        if (engine.exact && (meshes ? engine.collides_meshes : engine.searches_boxes))
            if (const auto tested = candidate_of(engine, meshes)) add(*tested, text_of(tested->name));
    const auto stage = meshes ? aabb::stage::local_detection : aabb::stage::global_search;
    for (const aabb::composition& c : aabb::every_composition(stage)) {
        if (!is_exact(c, stage) || (!meshes && !needs_meshes(c).empty())) continue;
        // `auto` already is this composition.
        if (candidate tested = candidate_of(c, meshes); tested.name != automatic) add(tested, text_of(tested.name));
    }
    // `auto` stays first. The others are shuffled, since there may be no time for all.
    std::shuffle(candidates.begin() + 1, candidates.end(), std::mt19937_64(1));
    return candidates;
}

race_result run_race(staged_scene& scene, std::vector<racer> candidates, const time_limits& limits) {
    return race(scene, std::move(candidates), limits).run();
}

}  // namespace aabblab
