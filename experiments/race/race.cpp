module;
#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <iterator>
#include <limits>
#include <optional>
#include <sstream>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

module aabblab.race;

import :apart;
import aabb.base;
import aabb.pipeline;
import aabb.registry;
import aabb.selection;
import aabb.validation;
import aabblab.numbers;
import aabblab.play;
import aabblab.progress;
import aabblab.scenes;
import aabblab.statistics;
import aabblab.stopwatch;

namespace aabblab {

namespace {

constexpr std::size_t first_frames = 4;
constexpr std::size_t most_finalists = 6;
constexpr std::size_t fewest_finalists = 2;
constexpr std::size_t fewest_repeats = 5;
constexpr std::size_t most_repeats = 15;
constexpr double least_patience = 1;  // seconds
constexpr double final_patience = 600;
/// Who takes so many times as long as the fastest, in the whole and a frame, is dropped; less in every round.
constexpr double first_margin = 2;
constexpr double last_margin = 1.25;

std::string to_line(const race_time& t) {
    std::ostringstream text;
    text.precision(17);
    text << t.build_ms << ' ' << t.first_ms << ' ' << t.rest_ms << ' ' << t.frames << ' ' << t.bytes << ' ' << t.digest;
    return text.str();
}

race_time from_line(const std::string& line) {
    std::istringstream text(line);
    race_time t;
    text >> t.build_ms >> t.first_ms >> t.rest_ms >> t.frames >> t.bytes >> t.digest;
    return t;
}

std::optional<race_time> play_apart(const scene_choice& choice, const contender& who, std::size_t frames,
                                    double seconds) {
    const auto line = done_apart([&] { return to_line(time_frames(choice, who, frames)); }, seconds);
    return line ? std::optional(from_line(*line)) : std::nullopt;
}

class race {
public:
    race(const scene_choice& scene, std::vector<racer> all, double seconds)
        : scene_(scene), running_(std::move(all)), seconds_(seconds) {
        const scene_play made(scene);
        result_.objects = made.objects();
        result_.frames = made.frames();
        result_.of = result_.frames * running_.size();
    }

    race_result run() {
        std::size_t frames = std::min(result_.frames, first_frames);
        double margin = first_margin;
        play_round(frames, margin);
        if (running_.empty())
            throw aabb::input_error(fmt::format("nobody plays {} of this scene to the end in {:.4g} s",
                                                counted(frames, "frame"), least_patience + seconds_));
        while (frames < result_.frames && running_.size() > most_finalists && left() > seconds_ / 2) {
            frames = std::min(result_.frames, 2 * frames);
            margin = std::max(last_margin, std::sqrt(margin));
            play_round(frames, margin);
        }
        for (; running_.size() > most_finalists || (running_.size() > fewest_finalists && !final_fits());
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
    [[nodiscard]] double left() const {
        return seconds_ - std::chrono::duration<double>(std::chrono::steady_clock::now() - began_).count();
    }

    /// For how long one may play frames that the fastest so far takes so many milliseconds for: far longer, but no
    /// longer than the whole race may take, unless it stays within the margin.
    [[nodiscard]] double patience(double least_ms, double margin) const {
        const double least = least_ms / 1000;
        const double longest =
            std::isfinite(least) ? std::min(20 * least, std::max(seconds_, margin * least)) : seconds_;
        return least_patience + reading_s_ + longest;
    }

    /// Plays the first frames with all; who takes far longer than the fastest so far is stopped.
    void play_round(std::size_t frames, double margin) {
        progress shown("racing over " + counted(frames, "frame"), running_.size());
        double least = std::numeric_limits<double>::infinity();
        std::size_t done = 0;
        for (racer& one : running_) {
            const auto began = std::chrono::steady_clock::now();
            one.last = play_apart(scene_, one.who, frames, patience(least, margin));
            const double took = std::chrono::duration<double>(std::chrono::steady_clock::now() - began).count();
            if (one.last) {
                const double own = one.last->whole_ms();
                // Reading the scene takes time as well.
                if (!std::isfinite(least)) reading_s_ = 2 * std::max(0.0, took - own / 1000);
                least = std::min(least, own);
                one.frames = frames;
            }
            shown.at(++done);
        }
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
            if (r.behind <= margin || r.behind > far * margin || left() < seconds_ / 2) continue;
            const auto second = play_apart(scene_, r.who, frames, patience(r.last->whole_ms(), margin));
            if (second && second->whole_ms() < r.last->whole_ms()) r.last = second;
        }
        set_behind();
    }

    /// Drops who is behind both over the whole scene and a frame.
    void judge(double margin) {
        double least_steady = std::numeric_limits<double>::infinity();
        for (const racer& r : running_)
            if (r.last) least_steady = std::min(least_steady, r.last->steady_ms());
        std::ranges::stable_sort(running_, [](const racer& a, const racer& b) {
            return a.last.has_value() && (!b.last || a.behind < b.behind);
        });
        keep([&](const racer& r) {
            return r.last &&
                   (r.behind <= margin || (r.last->frames > 1 && r.last->steady_ms() <= margin * least_steady));
        });
    }

    template <class Stays>
    void keep(Stays stays) {
        const auto first_out = std::stable_partition(running_.begin(), running_.end(), stays);
        for (auto last = running_.end(); last != first_out;) result_.dropped.push_back(std::move(*--last));
        running_.erase(first_out, running_.end());
    }

    [[nodiscard]] bool final_fits() const {
        double ms = 0;
        for (const racer& r : running_) ms += fewest_repeats * whole(r);
        return ms / 1000 <= std::max(left(), seconds_ / 2);
    }

    /// The whole scene, in turn, as often as there is time for. Who does not come to the end each time is dropped.
    void play_final() {
        progress shown("racing to the end", most_repeats);
        for (std::size_t repeat = 0; repeat < most_repeats && (repeat < fewest_repeats || left() > 0); ++repeat) {
            for (std::size_t k = 0; k < running_.size(); ++k) {
                racer& r = running_[in_turn(k, repeat, running_.size())];
                if (const auto time = play_apart(scene_, r.who, result_.frames, final_patience)) {
                    r.times.push_back(*time);
                    r.frames = result_.frames;
                }
            }
            keep([&](const racer& r) { return r.times.size() > repeat; });
            shown.at(repeat + 1);
        }
        if (running_.empty()) throw aabb::input_error("nothing plays this scene to its end");
    }

    /// Who is wrong is no answer to what to use, however fast.
    void hold_against_cgal() {
        const auto cgal = std::ranges::find(aabb::engines(), "cgal", &aabb::engine_info::name);
        const auto exact = play_apart(scene_, *contender_of(*cgal, has_meshes(scene_)), result_.frames,
                                      least_patience + reading_s_ + seconds_);
        result_.held_against_cgal = exact.has_value();
        if (!exact) return;
        const auto right = [&](const racer& r) {
            return std::ranges::all_of(r.times, [&](const race_time& t) { return t.digest == exact->digest; });
        };
        const auto first_wrong = std::stable_partition(running_.begin(), running_.end(), right);
        result_.wrong.assign(std::move_iterator(first_wrong), std::move_iterator(running_.end()));
        running_.erase(first_wrong, running_.end());
        if (running_.empty()) throw std::runtime_error("nobody finds the exact pairs of this scene");
    }

    const scene_choice& scene_;
    std::vector<racer> running_;
    double seconds_;
    std::chrono::steady_clock::time_point began_ = std::chrono::steady_clock::now();
    double reading_s_ = 0;
    race_result result_;
};

}  // namespace

race_time time_frames(const scene_choice& choice, const contender& who, std::size_t frames) {
    scene_play scene(choice);
    std::optional<player> p;
    race_time time;
    time.build_ms = milliseconds_of([&] { p.emplace(who, scene, aabb::instrumentation::none); });
    tally found(scene.meshes() != nullptr);
    play(
        scene, *p,
        [&](const played_frame& frame) {
            found.add(frame.pairs, frame.contacts);
            (frame.number == 0 ? time.first_ms : time.rest_ms) += frame.ms();
            ++time.frames;
        },
        frames);
    time.bytes = p->held_bytes();
    time.digest = found.digest();
    time.left_out = p->left_out();
    return time;
}

std::vector<racer> starters(const scene_choice& choice) {
    const scene_play scene(choice);
    const bool meshes = scene.meshes() != nullptr;
    std::vector<racer> all;
    const auto add = [&](contender who, std::string name) {
        racer& one = all.emplace_back();
        one.who = std::move(who);
        one.name = std::move(name);
    };
    const auto automatic = contender_of(select_composition({}, outlook_of(scene)), meshes).name;
    add(contender_of(aabb::named_strategies(), scene), "auto (= " + text_of(automatic) + ")");
    const auto stage = meshes ? aabb::stage::local_detection : aabb::stage::global_search;
    for (const aabb::composition& c : aabb::every_composition(stage)) {
        if (!is_exact(c, stage) || (!meshes && !needs_meshes(c).empty())) continue;
        // It is the same twice.
        if (contender who = contender_of(c, meshes); who.name != automatic) add(who, text_of(who.name));
    }
    // Whoever may find other pairs is no answer to what to use.
    for (const aabb::engine_info& engine : aabb::engines())
        if (engine.exact && (meshes ? engine.collides_meshes : engine.searches_boxes))
            if (const auto who = contender_of(engine, meshes)) add(*who, text_of(who->name));
    return all;
}

race_result run_race(const scene_choice& scene, std::vector<racer> all, double seconds) {
    return race(scene, std::move(all), seconds).run();
}

}  // namespace aabblab
