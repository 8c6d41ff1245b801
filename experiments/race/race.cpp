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

constexpr std::size_t first_frames = 4;
constexpr std::size_t most_finalists = 6;
constexpr std::size_t fewest_finalists = 2;
constexpr std::size_t most_repeats = 15;
/// Who takes so many times as long as the fastest, in the whole and a frame, is dropped; less in every round.
constexpr double first_margin = 2;
constexpr double last_margin = 1.25;
/// Of the time to play, what the first round may take, so that there is some for repeats.
constexpr double share_of_first_round = 2.0 / 3;

/// The logarithms of one's time over the other's in the same repeat, which the machine's slow and fast moments leave
/// alone.
cells log_ratios(const racer& one, const racer& other) {
    cells ratios(1, 1);
    for (std::size_t i = 0; i < one.times.size(); ++i)
        ratios.add(0, 0, std::log(one.times[i].whole_ms() / other.times[i].whole_ms()));
    return ratios;
}

/// How far the nearest of the others is behind, in the median; below 0 where one is ahead.
double lead_of(const racer& one, const std::vector<racer>& all) {
    const resample as_measured(1, 1, level::none, 0);
    double least = std::numeric_limits<double>::infinity();
    for (const racer& other : all)
        if (&other != &one) least = std::min(least, as_measured.mean_of(log_ratios(other, one)));
    return least;
}

observation median_of(std::vector<observation> times) {
    const auto middle = times.begin() + static_cast<std::ptrdiff_t>(times.size() / 2);
    std::ranges::nth_element(times, middle, {}, &observation::whole_ms);
    return *middle;
}

class race {
public:
    race(staged_scene& scene, std::vector<racer> all, const time_limits& limits)
        : scene_(scene), limits_(limits), whole_(limits.to_play()), running_(std::move(all)) {
        result_.objects = scene.scene().objects();
        result_.frames = scene.scene().frames();
        result_.of = result_.frames * running_.size();
    }

    race_result run() {
        std::size_t frames = std::min(result_.frames, first_frames);
        double margin = first_margin;
        play_first_round(frames, margin);
        while (frames < result_.frames && running_.size() > most_finalists && left() > whole_ / 2) {
            frames = std::min(result_.frames, 2 * frames);
            margin = std::max(last_margin, std::sqrt(margin));
            if (!play_round(frames, margin)) break;
        }
        result_.final_frames = running_.front().last->frames;
        for (; running_.size() > most_finalists || (running_.size() > fewest_finalists && !final_fits(result_.frames));
             running_.pop_back())
            result_.dropped.push_back(std::move(running_.back()));
        play_final();
        hold_against_cgal();
        rank(running_);
        std::ranges::reverse(result_.dropped);
        result_.finalists = std::move(running_);
        for (const std::vector<racer>* some : {&result_.finalists, &result_.dropped, &result_.wrong})
            for (const racer& r : *some) result_.played += r.frames;
        return std::move(result_);
    }

private:
    [[nodiscard]] double left() const { return limits_.to_play(); }

    /// For how long one may play frames that the fastest so far takes so many seconds for; the first of all has more.
    [[nodiscard]] double longest(double least, double margin) const {
        const stopping_rule rule{.grace = std::min(1.0, whole_ / 20), .share = whole_ / 16, .margin = margin};
        return std::isfinite(least) ? rule.longest(least) : rule.grace + whole_ / 4;
    }

    /// One plays the first frames; it is out where it does not come to their end, unless all time is over.
    /// @returns whether it did
    bool plays(racer& one, std::size_t frames, double seconds, double time_left) {
        attempt tried = scene_.play(one.who, frames, seconds, time_left);
        if (tried.end != ending::done) {
            one.frames = std::max(one.frames, tried.seen.frames);
            one.broken_off = std::move(tried);
            return false;
        }
        one.last = std::move(tried.seen);
        one.seconds = tried.seconds;
        one.frames = frames;
        return true;
    }

    /// All play the first frames; who takes far longer than the fastest so far is stopped. Where those of the first
    /// round take too long, those are raced over that the first who came to the end of any came to the end of.
    /// @returns whether anybody came to their end
    bool play_all(std::size_t& frames, double margin, bool is_first_round) {
        progress shown("racing over " + counted(frames, "frame"), running_.size());
        const double kept = is_first_round ? (1 - share_of_first_round) * whole_ : 0;
        double least = std::numeric_limits<double>::infinity();
        std::size_t done = 0;
        for (racer& one : running_) {
            bool ends = plays(one, frames, longest(least, margin), left() - kept);
            if (!ends && is_first_round && !std::isfinite(least) && one.broken_off->end == ending::stopped &&
                one.frames > 0) {
                frames = one.frames;
                one.seconds = one.broken_off->seconds_of_frames;
                one.last = std::move(one.broken_off->seen);
                one.broken_off.reset();
                ends = true;
            }
            if (ends) least = std::min(least, one.seconds);
            shown.at(++done);
        }
        return std::isfinite(least);
    }

    void play_first_round(std::size_t& frames, double margin) {
        if (!play_all(frames, margin, true)) {
            // Pairs that nobody found need not be compared: that time is the first one's, for a frame.
            frames = 1;
            racer& first = running_.front();
            first.broken_off.reset();
            if (!plays(first, frames, limits_.to_end(), limits_.to_end())) refuse_all();
        }
        finish_round(frames, margin);
    }

    /// Nobody came to the end of any frame.
    [[noreturn]] void refuse_all() const {
        for (const racer& r : running_)
            if (r.broken_off->end == ending::refused) throw aabb::input_error(r.broken_off->reason);
        const racer& first = running_.front();
        throw aabb::input_error(fmt::format("no candidate finishes frame 0 of this scene; {}: {}{}", first.name,
                                            text_of(*first.broken_off),
                                            first.broken_off->end == ending::stopped ? "; increase --seconds" : ""));
    }

    /// Where all time is over before all have played, or none finishes, the round does not count.
    /// @returns whether it does
    bool play_round(std::size_t frames, double margin) {
        const std::vector<racer> before = running_;
        const bool any_ends = play_all(frames, margin, false);
        const bool is_cut =
            std::ranges::any_of(running_, [](const racer& r) { return r.broken_off && r.broken_off->is_out_of_time; });
        if (!is_cut) require_any_unrefused();
        if (is_cut || !any_ends) {
            running_ = before;
            return false;
        }
        finish_round(frames, margin);
        return true;
    }

    void finish_round(std::size_t frames, double margin) {
        set_behind();
        play_again(frames, margin);
        judge(margin);
    }

    [[nodiscard]] double whole(const racer& r) const { return r.last->over(static_cast<double>(result_.frames)); }

    void set_behind() {
        double least = std::numeric_limits<double>::infinity();
        for (const racer& r : running_)
            if (r.last) least = std::min(least, whole(r));
        for (racer& r : running_) r.behind = r.last ? whole(r) / least : 0;
    }

    /// One play may have been disturbed: of two, the faster counts for who is behind, but not far.
    void play_again(std::size_t frames, double margin) {
        constexpr double far = 2;
        for (racer& r : running_) {
            if (r.broken_off || r.behind <= margin || r.behind > far * margin || left() < whole_ / 2) continue;
            const attempt second = scene_.play(r.who, frames, longest(r.seconds, margin), left());
            if (second.end == ending::done && second.seen.whole_ms() < r.last->whole_ms()) r.last = second.seen;
        }
        set_behind();
    }

    /// Drops who did not come to the end, and who is behind both over the whole scene and a frame.
    void judge(double margin) {
        double least_steady = std::numeric_limits<double>::infinity();
        for (const racer& r : running_)
            if (r.last) least_steady = std::min(least_steady, r.last->steady_ms());
        std::ranges::stable_sort(running_, [](const racer& a, const racer& b) {
            return a.last.has_value() && (!b.last || a.behind < b.behind);
        });
        keep([&](const racer& r) {
            return !r.broken_off &&
                   (r.behind <= margin || (r.last->frames > 1 && r.last->steady_ms() <= margin * least_steady));
        });
    }

    template <class Stays>
    void keep(Stays stays) {
        const auto first_out = std::stable_partition(running_.begin(), running_.end(), stays);
        for (auto last = running_.end(); last != first_out;) result_.dropped.push_back(std::move(*--last));
        running_.erase(first_out, running_.end());
    }

    /// About how many seconds a play takes: what is not timed, as reading and sorting, takes as long in each frame.
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
        return fewest_repeats * seconds_of_repeat(frames) <= left();
    }

    /// All frames in turn, or as many as there is time for, as often as there is. Who fails, or takes far longer than
    /// it seemed, is dropped. Where there is no time for any repeat, or nobody ends one, the last round counts as one.
    void play_final() {
        std::size_t frames = result_.frames;
        while (frames > result_.final_frames && !final_fits(frames))
            frames -= std::max<std::size_t>(1, (frames - result_.final_frames) / 8);
        progress shown("racing to the end", most_repeats);
        const std::vector<racer> before = running_;
        bool is_cut = false;  // all time is over within a repeat, of which nothing is kept
        const auto play = [&](racer& r, std::size_t) {
            attempt tried = scene_.play(r.who, frames, longest(seconds_of(r, frames), last_margin), left());
            if (tried.is_out_of_time) {
                is_cut = true;
            } else if (tried.end == ending::done) {
                r.times.push_back(std::move(tried.seen));
                r.frames = frames;
            } else {
                r.broken_off = std::move(tried);
            }
        };
        const auto drop = [&](std::size_t repeat) {
            if (is_cut)
                for (racer& r : running_) r.times.resize(std::min(repeat, r.times.size()));
            else
                require_any_unrefused();
            keep([](const racer& r) { return !r.broken_off; });
            shown.at(repeat + 1);
        };
        const round_limits limits{
            .end = most_repeats, .left = [&] { return left(); }, .expected = seconds_of_repeat(frames)};
        run_rounds(running_, limits, play, drop);
        if (!running_.empty() && !running_.front().times.empty()) {
            result_.final_frames = frames;
            return;
        }
        if (running_.empty()) take_back(before);
        for (racer& r : running_) r.times.push_back(*r.last);
    }

    /// Those whom the final dropped, where all were only too slow.
    void take_back(std::vector<racer> before) {
        const auto finalists = std::span(result_.dropped).last(before.size());
        if (std::ranges::any_of(finalists, [](const racer& r) { return r.broken_off->end != ending::stopped; }))
            throw aabb::input_error("nothing plays this scene to its end");
        result_.dropped.resize(result_.dropped.size() - before.size());
        running_ = std::move(before);
    }

    /// A frame that is wrong is so for all.
    void require_any_unrefused() const {
        if (std::ranges::all_of(running_,
                                [](const racer& r) { return r.broken_off && r.broken_off->end == ending::refused; }))
            throw aabb::input_error(running_.front().broken_off->reason);
    }

    /// Who is wrong is no answer to what to use, however fast. CGAL's first frames tell something too.
    void hold_against_cgal() {
        const auto cgal = std::ranges::find(aabb::engines(), "cgal", &aabb::engine_info::name);
        const attempt exact = scene_.play(*contender_of(*cgal, scene_.scene().meshes() != nullptr),
                                          result_.final_frames, limits_.to_end());
        result_.validated = exact.seen.frames;
        if (result_.validated == 0) return;
        const auto right = [&](const racer& r) {
            return std::ranges::all_of(
                r.times, [&](const observation& t) { return t.digests[result_.validated - 1] == exact.seen.digest; });
        };
        const auto first_wrong = std::stable_partition(running_.begin(), running_.end(), right);
        result_.wrong.assign(std::move_iterator(first_wrong), std::move_iterator(running_.end()));
        running_.erase(first_wrong, running_.end());
        if (running_.empty()) throw std::runtime_error("nobody finds the exact pairs of this scene");
    }

    staged_scene& scene_;
    const time_limits& limits_;
    double whole_;  // time to play, in seconds
    std::vector<racer> running_;
    race_result result_;
};

}  // namespace

void rank(std::vector<racer>& finalists) {
    if (finalists.empty()) return;
    const auto first =
        std::ranges::max_element(finalists, {}, [&](const racer& one) { return lead_of(one, finalists); });
    std::rotate(finalists.begin(), first, first + 1);
    for (racer& one : finalists) {
        one.last = median_of(one.times);
        one.log_ratio = bootstrap(log_ratios(one, finalists.front()));
        // Three may be ahead of each other in a circle: none is then.
        one.log_ratio->value = std::max(one.log_ratio->value, 0.0);
    }
    std::stable_sort(finalists.begin() + 1, finalists.end(),
                     [](const racer& a, const racer& b) { return a.log_ratio->value < b.log_ratio->value; });
}

std::vector<racer> starters(const scene_play& scene) {
    const bool meshes = scene.meshes() != nullptr;
    std::vector<racer> all;
    const auto add = [&](contender who, std::string name) {
        racer& one = all.emplace_back();
        one.who = std::move(who);
        one.name = std::move(name);
    };
    const auto automatic = contender_of(select_composition({}, outlook_of(scene)), meshes).name;
    add(contender_of(aabb::named_strategies(), scene), "auto (= " + text_of(automatic) + ")");
    // Whoever may find other pairs is no answer to what to use.
    for (const aabb::engine_info& engine : aabb::engines())
        if (engine.exact && (meshes ? engine.collides_meshes : engine.searches_boxes))
            if (const auto who = contender_of(engine, meshes)) add(*who, text_of(who->name));
    const auto stage = meshes ? aabb::stage::local_detection : aabb::stage::global_search;
    for (const aabb::composition& c : aabb::every_composition(stage)) {
        if (!is_exact(c, stage) || (!meshes && !needs_meshes(c).empty())) continue;
        // It is the same twice.
        if (contender who = contender_of(c, meshes); who.name != automatic) add(who, text_of(who.name));
    }
    std::shuffle(all.begin() + 1, all.end(), std::mt19937_64(1));
    return all;
}

race_result run_race(staged_scene& scene, std::vector<racer> all, const time_limits& limits) {
    return race(scene, std::move(all), limits).run();
}

}  // namespace aabblab
