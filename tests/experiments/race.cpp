// The race of candidates behind recommend, and the command.

#include <catch2/matchers/catch_matchers.hpp>
#include <csignal>

#include "configs.hpp"
#include "mesh_bytes.hpp"

#include "../altered_search.hpp"

import aabb.registry;
import aabb.validation;
import aabblab.trials;
import aabblab.race;

using aabblab::racer;
using namespace std::chrono_literals;

namespace {

// Long enough that a busy machine does not change which candidate is far behind.
constexpr auto tick = 5ms;

/// The default composition, which calls `before` in each frame and applies `after` to the pairs.
racer delayed(
    const std::string& name, const std::function<void()>& before, const altered_search::change& after = [](auto&) {}) {
    racer r;
    r.tested.name.engine = r.name = name;
    r.tested.make_global = [=](aabb::instrumentation) {
        return std::make_unique<altered_search>(aabb::compose_global_search({}, aabb::instrumentation::none), before,
                                                after);
    };
    return r;
}

auto sleeping(std::chrono::milliseconds time) {
    return [time] { std::this_thread::sleep_for(time); };
}

/// Hangs in that frame, counted from 0, and takes the given time for each of the others.
auto stuck_in(int frame, std::chrono::milliseconds others = 1ms) {
    return [=, i = 0]() mutable { std::this_thread::sleep_for(i++ == frame ? 10min : others); };
}

/// Loses a pair of each frame that has any.
racer lossy(const std::string& name) {
    return delayed(name, sleeping(20ms), [](auto& pairs) {
        if (!pairs.empty()) pairs.pop_back();
    });
}

/// Appends its name to the file each time it is created.
aabblab::candidate logged(const aabblab::candidate& tested, const std::string& name, const std::string& file) {
    aabblab::candidate recording_candidate = tested;
    recording_candidate.make_global = [=, make = tested.make_global](aabb::instrumentation counted) {
        std::ofstream(file, std::ios::app) << name;
        return make(counted);
    };
    return recording_candidate;
}

const aabblab::scene_choice scene{"brownian", {{"objects", "200"}, {"frames", "24"}}, {}, 1, {}};

// Its few frames can take long, so that a busy machine does not change which candidate is far behind.
const aabblab::scene_choice short_scene{"brownian", {{"objects", "200"}, {"frames", "3"}}, {}, 1, {}};

aabblab::race_result race_of(const aabblab::scene_choice& choice, std::vector<racer> racers, double seconds) {
    aabblab::staged_scene staged(choice);
    return aabblab::run_race(staged, std::move(racers), aabblab::time_limits(seconds));
}

std::vector<racer> candidates_for_race(const aabblab::scene_choice& choice) {
    return aabblab::race_candidates(aabblab::scene_frames(choice));
}

bool has_racer(const std::vector<racer>& racers, const std::string& name) {
    return std::ranges::find(racers, name, &racer::name) != racers.end();
}

aabblab::observation observed(double build_ms, double first_ms, double rest_ms, std::size_t frames) {
    aabblab::observation seen;
    seen.build.wall_ms = build_ms;
    seen.first.update.wall_ms = first_ms;
    seen.rest.update.wall_ms = rest_ms;
    seen.frames = frames;
    seen.digest = "answer";
    return seen;
}

/// A finalist with these times of a scene of two frames, by repeat.
racer finalist(const std::string& name, std::initializer_list<double> ms_of_repeats) {
    racer r;
    r.name = name;
    for (const double ms : ms_of_repeats) r.times.push_back(observed(0, 0, ms, 2));
    return r;
}

/// A finalist of a scene of 100 frames, with the noise of a quiet machine.
racer finalist(const std::string& name, double build_ms, double frame_ms, bool alternates = false) {
    racer r;
    r.name = name;
    bool slow = false;
    for (const double noise : {1.0, 1.02, 0.99, 1.01, 0.98, 1.0, 1.01}) {
        slow = !slow;
        const double ms = alternates ? frame_ms * (slow ? 1.1 : 0.9) : frame_ms;
        r.times.push_back(observed(build_ms * noise, ms * noise, 99 * ms * noise, 100));
    }
    return r;
}

aabblab::race_result race_with(std::vector<racer> finalists, std::size_t frames = 100) {
    aabblab::race_result race;
    race.frames = race.final_frames = race.validated = frames;
    rank(finalists);
    race.finalists = std::move(finalists);
    return race;
}

}  // namespace

TEST_CASE("A race finds the fastest candidate and drops those that are far behind or fail") {
    std::vector<racer> racers{delayed("slow", sleeping(20 * tick)),
                              delayed("fast", sleeping(tick)),
                              delayed("stuck", sleeping(10min)),
                              delayed("broken", [] { throw std::runtime_error("no"); }),
                              delayed("gone", [] { std::raise(SIGKILL); }),
                              delayed("late", [i = 0]() mutable {
                                  // It is slow in frame 0, then as fast as any.
                                  std::this_thread::sleep_for(i++ == 0 ? 60 * tick : tick);
                              })};
    const aabblab::race_result race = race_of(scene, std::move(racers), 8);
    REQUIRE(race.frames == 25);
    REQUIRE(race.objects == 200);
    REQUIRE_FALSE(race.finalists.empty());
    CHECK(race.finalists.front().name == "fast");
    CHECK(has_racer(race.finalists, "late"));
    for (const char* name : {"slow", "stuck", "broken", "gone"}) CHECK(has_racer(race.dropped, name));
    CHECK(race.frames_run < race.frames_of_all);
    CHECK(std::exp(race.finalists.front().log_ratio->value) == 1);
    for (const racer& r : race.finalists) {
        CHECK(r.times.size() >= 5);
        CHECK(r.last->digest == race.finalists.front().last->digest);
        CHECK(r.log_ratio->value >= 0);
    }
    // The last to be dropped comes first.
    CHECK(race.dropped.front().name == "slow");
}

TEST_CASE_METHOD(in_folder, "A candidate that was disturbed once is not dropped") {
    const std::string marker = folder / "played";
    std::vector<racer> racers{delayed("fast", sleeping(tick)), delayed("disturbed", sleeping(tick))};
    // It takes three times as long in the first run, which finds no file.
    racers.back().tested.make_global = [=, make = racers.back().tested.make_global,
                                        slow = delayed("", sleeping(3 * tick))](aabb::instrumentation counted) {
        if (std::filesystem::exists(marker)) return make(counted);
        std::ofstream(marker) << "once";
        return slow.tested.make_global(counted);
    };
    CHECK(has_racer(race_of(scene, racers, 5).finalists, "disturbed"));
}

TEST_CASE("A race counts the frames of repeated runs only once") {
    const aabblab::race_result race = race_of(scene, {delayed("one", [] {}), delayed("other", [] {})}, 20);
    REQUIRE(race.finalists.size() + race.dropped.size() == 2);
    CHECK(race.frames_of_all == 50);
    CHECK(race.frames_run == 25 * race.finalists.size() + 4 * race.dropped.size());
}

TEST_CASE("A candidate whose pairs differ from CGAL's does not win a race") {
    const std::vector<racer> racers{delayed("right", sleeping(20ms)), lossy("wrong")};
    const aabblab::race_result race = race_of(short_scene, racers, 2);
    CHECK(race.is_validated());
    REQUIRE(race.finalists.size() == 1);
    CHECK(race.finalists.front().name == "right");
    CHECK(has_racer(race.wrong, "wrong"));
    CHECK(aabblab::advice_of(race).back() == "wrong is rejected: its pairs differ from the ground truth.");
    CHECK_THROWS_WITH(race_of(short_scene, {racers.back()}, 2), "no candidate finds the exact pairs of this scene");
}

TEST_CASE("Interleaved runs identify candidates whose pairs differ from the baseline's") {
    const std::vector<aabblab::candidate> candidates{delayed("a", [] {}).tested, delayed("b", [] {}).tested,
                                                     lossy("c").tested};
    aabblab::staged_scene staged(short_scene);
    const aabblab::interleaved_runs runs = aabblab::run_interleaved(staged, candidates, 4, 2, aabblab::time_limits(20));
    CHECK(aabblab::disagreeing(runs.times) == std::vector<std::size_t>{2});
}

TEST_CASE("A race has as many finalists as time permits, but at least two") {
    std::vector<racer> racers;
    for (const char* name : {"a", "b", "c"}) racers.push_back(delayed(name, sleeping(100ms)));
    CHECK(race_of(short_scene, racers, 20).finalists.size() == 3);
    CHECK(race_of(short_scene, racers, 4).finalists.size() == 2);
}

TEST_CASE_METHOD(in_folder, "Each repeat of a race begins with another candidate") {
    const std::string file = folder / "order";
    std::vector<racer> racers;
    for (const char* name : {"a", "b"}) {
        // Long enough that both become finalists.
        racer& r = racers.emplace_back(delayed(name, sleeping(5ms)));
        r.tested = logged(r.tested, name, file);
    }
    REQUIRE(race_of(scene, racers, 20).finalists.size() == 2);
    const std::string order = bytes_of_file(file);
    // One round is followed by at least five repeats.
    REQUIRE(order.size() >= 2 + 2 * 5);
    for (std::size_t i = 2; i + 2 < order.size(); i += 2) CHECK(order[i] != order[i + 2]);
}

TEST_CASE_METHOD(in_folder, "A child process reports its output so far and how it ended") {
    using aabblab::ending;
    const auto ends = [](const std::function<void()>& work, double seconds) {
        const aabblab::child_result done = aabblab::run_in_child(
            [&](const aabblab::output_sender& send) {
                send("begun;");
                work();
                send("ended");
            },
            seconds);
        CHECK(done.reported.starts_with("begun;"));
        CHECK((done.end == ending::done) == (done.reported == "begun;ended"));
        CHECK(done.seconds > 0);
        CHECK((done.end == ending::rejected) == !done.reason.empty());
        return done.end;
    };
    CHECK(ends([] {}, 60) == ending::done);
    CHECK(ends(sleeping(10min), 0.2) == ending::stopped);
    CHECK(ends([] { throw std::bad_alloc(); }, 60) == ending::out_of_memory);
    CHECK(ends([] { throw std::length_error("no"); }, 60) == ending::out_of_memory);
    CHECK(ends([] { std::raise(SIGKILL); }, 60) == ending::out_of_memory);
    CHECK(ends([] { throw aabb::input_error("it is wrong"); }, 60) == ending::rejected);
    CHECK(ends([] { throw std::runtime_error("no"); }, 60) == ending::failed);
    CHECK(ends([] { std::raise(SIGUSR1); }, 60) == ending::failed);
    const aabblab::child_result rejected =
        aabblab::run_in_child([](const aabblab::output_sender&) { throw aabb::input_error("it is wrong"); }, 60);
    CHECK(rejected.reason == "it is wrong");
    const std::string file = folder / "begun";
    const auto idle = aabblab::run_in_child([&](const aabblab::output_sender&) { std::ofstream(file) << "yes"; }, 0);
    CHECK(idle.end == ending::stopped);
    CHECK(idle.seconds == 0);
    CHECK_FALSE(std::filesystem::exists(file));
}

TEST_CASE("A race of S seconds ends within 2 S, or 2 seconds after the scene is read") {
    double now = 0;
    aabblab::time_limits limits(10, [&] { return now; });
    const auto is_near = [](double a, double b) { return std::abs(a - b) < 1e-9; };
    now = 1;
    limits.note_scene_read();
    CHECK(is_near(limits.to_run(), 9.5 - 1));
    CHECK(is_near(limits.to_end(), 19 - 1));
    now = 30;
    CHECK(limits.to_run() < 0);
    CHECK(limits.to_end() < 0);
    now = 0;
    aabblab::time_limits after_long_read(1, [&] { return now; });
    now = 40;
    after_long_read.note_scene_read();
    CHECK_BETWEEN(0.9, after_long_read.to_run(), 1);
    CHECK(is_near(after_long_read.to_end(), 1.9));
}

TEST_CASE("A race runs fewer frames if the first ones take too long") {
    const aabblab::race_result race = race_of(scene,
                                              {delayed("early", stuck_in(2, 200ms)), delayed("fast", stuck_in(2, 5ms)),
                                               delayed("never", stuck_in(0)), delayed("late", stuck_in(1))},
                                              12);
    CHECK(race.final_frames == 2);
    REQUIRE_FALSE(race.finalists.empty());
    CHECK(race.finalists.front().name == "fast");
    CHECK(race.finalists.front().last->frames == 2);
    CHECK(race.is_validated());
    for (const char* name : {"never", "early", "late"}) CHECK(has_racer(race.dropped, name));
    const std::string use = aabblab::advice_of(race).front();
    CHECK(use.starts_with("Use fast: "));
    CHECK(holds(use, " ms for the first 2 of 25 frames"));
}

TEST_CASE("If no candidate finishes a frame, the first frame also gets the time for validation") {
    const aabblab::race_result race =
        race_of(scene, {delayed("slow", sleeping(1500ms)), delayed("slower", sleeping(10min))}, 3);
    REQUIRE(race.finalists.size() == 1);
    CHECK(race.finalists.front().name == "slow");
    CHECK(race.final_frames == 1);
}

TEST_CASE("A candidate that hangs after the first frames is not recommended if another one finishes") {
    // Both are equally fast until then, so that the other one is not dropped.
    const aabblab::race_result race =
        race_of(scene, {delayed("stuck", stuck_in(5, 10ms)), delayed("ends", sleeping(10ms))}, 20);
    REQUIRE(race.finalists.size() == 1);
    CHECK(race.finalists.front().name == "ends");
    CHECK(race.final_frames == 25);
    CHECK(has_racer(race.dropped, "stuck"));
}

TEST_CASE("Unfinished candidates are not recommended if one finishes, and those without time are counted") {
    std::vector<racer> racers;
    for (int i = 0; i < 12; ++i) racers.push_back(delayed("stuck", sleeping(10min)));
    racers.insert(racers.begin() + 1, delayed("ends", sleeping(2ms)));
    const aabblab::race_result race = race_of(scene, std::move(racers), 1);
    REQUIRE(race.finalists.size() == 1);
    CHECK(race.finalists.front().name == "ends");
    REQUIRE(race.dropped.size() == 12);
    const auto not_run = std::ranges::count_if(
        race.dropped, [](const racer& r) { return text_of(r.broken_off.value()) == "not run: no time was left"; });
    CHECK_BETWEEN(0, not_run, 12);
    CHECK(std::ranges::count(aabblab::advice_of(race), "There was no time for " + std::to_string(not_run) +
                                                           " candidate" + (not_run > 1 ? "s" : "") +
                                                           "; increase --seconds.") == 1);
}

TEST_CASE("A race reports the reason why a frame is invalid") {
    const std::string why = "frame 0: box 3 is inverted";
    const auto reject = [&] { throw aabb::input_error(why); };
    CHECK_THROWS_WITH(race_of(scene, {delayed("one", reject), delayed("other", reject)}, 1), why);
}

TEST_CASE_METHOD(in_folder, "recommend and explain report an invalid frame at any position") {
    const std::string file = folder / "p.aabbs";
    run_well({"scene", "pile", "--n", "60", "--frames", "30", "--out", file});
    std::string bytes = bytes_of_file(file);
    const std::string nan("\x00\x00\xc0\x7f", 4);
    for (const std::size_t frame : {5, 6, 29}) {
        CAPTURE(frame);
        std::string wrong = bytes;
        wrong.replace(wrong.size() - (31 - frame) * 60 * 32 + 3 * 32, 4, nan);
        for (const char* command : {"recommend", "explain"}) {
            const program_result rejected =
                run_program({command, folder.write("wrong.aabbs", wrong), "--seconds", "4"});
            CHECK(rejected.status == 2);
            CHECK(rejected.err.ends_with("frame " + std::to_string(frame) +
                                         ": box 3 has a coordinate that is not finite\n"));
        }
    }
}

TEST_CASE("A candidate that exceeds the time of a race is stopped") {
    const auto hesitant = [] {
        return delayed("hesitant", [i = 0]() mutable {
            if (i++ == 0) std::this_thread::sleep_for(6s);
        });
    };
    const aabblab::race_result race = race_of(scene, {hesitant(), delayed("fast", sleeping(1ms))}, 0.5);
    REQUIRE(race.dropped.size() == 1);
    CHECK(race.dropped.front().name == "hesitant");
    CHECK_FALSE(race.dropped.front().last.has_value());
    CHECK(text_of(race.dropped.front().broken_off.value()).starts_with("stopped after "));
    CHECK_THROWS_AS(race_of(scene, {hesitant()}, 0.5), aabb::input_error);
}

TEST_CASE("Finalists are ranked by ratios of times in the same repeats") {
    // b has the smaller median, but is slower in four of five repeats.
    std::vector<racer> finalists{finalist("b", {1.1, 2.2, 2.9, 4.4, 5.5}), finalist("a", {1, 2, 3, 4, 5})};
    aabblab::rank(finalists);
    CHECK(finalists[0].name == "a");
    CHECK(finalists[0].ratio() == 1);
    CHECK(std::abs(finalists[1].ratio() - 1.1) < 1e-9);
    CHECK(finalists[1].last->whole_ms() == 2.9);
    // Each is faster than the next in two of three repeats.
    std::vector<racer> cycle{finalist("a", {1, 2, 3}), finalist("b", {2, 3, 1}), finalist("c", {3, 1, 2})};
    aabblab::rank(cycle);
    CHECK(cycle[0].ratio() == 1);
    for (const racer& r : cycle) CHECK(r.ratio() >= 1);
}

TEST_CASE("Advice states for which numbers of frames another candidate is shown to be faster") {
    const std::string none_faster = "; extrapolated to fewer or more frames, no other candidate is shown to be faster.";
    // Whether the sentence that says which to use ends with `end`.
    const auto use_ends_with = [](std::vector<racer> finalists, const std::string& end, std::size_t frames = 100) {
        return aabblab::advice_of(race_with(std::move(finalists), frames)).front().ends_with(end);
    };
    const racer winner = finalist("winner", 10, 1);
    // It takes 2 n ms for n frames, and the winner 10 + n.
    CHECK(use_ends_with({winner, finalist("quick", 0, 2)}, "; below about 10 frames, quick would be faster."));
    CHECK(use_ends_with({winner, finalist("quick", 0, 2), finalist("quicker", 5, 1.2)},
                        "; below about 25 frames, quicker would be faster."));
    CHECK(use_ends_with({winner, finalist("patient", 160, 0.5)}, "; above about 300 frames, patient would be faster."));
    CHECK(use_ends_with({winner, finalist("patient", 160, 0.5), finalist("sooner", 130, 0.2)},
                        "; above about 150 frames, sooner would be faster."));
    CHECK(use_ends_with({winner, finalist("slower", 20, 2)}, none_faster));
    // It may be slower per frame or not.
    CHECK(use_ends_with({winner, finalist("noisy", 5, 1.07, true)}, none_faster));
    // There is one frame, or no other candidate.
    for (const std::string& use : {aabblab::advice_of(race_with({winner, finalist("quick", 0, 2)}, 1)).front(),
                                   aabblab::advice_of(race_with({winner})).front()}) {
        CHECK_FALSE(holds(use, " would be faster"));
        CHECK(!use.ends_with(none_faster));
    }
}

TEST_CASE("Advice reports too few repeats for an interval and an incomplete validation") {
    aabblab::race_result race = race_with({finalist("winner", {1, 1}), finalist("other", {2, 2})}, 2);
    CHECK(aabblab::advice_of(race).front() ==
          "Use winner: 1 ms for 2 frames; the next, other, takes 2.00 times as long, in 2 repeats, too few for a "
          "confidence interval.");
    race.validated = 1;
    CHECK(aabblab::advice_of(race).back() ==
          "Only the first of these frames was compared with the ground truth: CGAL did not finish in time.");
    race.validated = 0;
    CHECK(aabblab::advice_of(race).back() ==
          "No candidate was compared with the ground truth: CGAL failed, or did not finish in time.");
}

TEST_CASE("Advice names the options that select the winner") {
    const auto named = [](const aabblab::candidate_name& name) {
        racer winner = finalist("winner", 10, 1);
        winner.tested.name = name;
        return aabblab::advice_of(race_with({winner})).back();
    };
    aabblab::candidate_name ours;
    ours[aabb::strategy_kind::prepare] = "none";
    ours[aabb::strategy_kind::partition] = "axial_cut:axes=3";
    CHECK(named(ours) == "Options that select it: --prepare none --partition axial_cut:axes=3");
    aabblab::candidate_name engine = ours;
    engine.engine = "embree";
    CHECK(named(engine) == "Options that select it: --engine embree");
    aabblab::candidate_name automatic;
    automatic.engine = "auto";
    CHECK(named(automatic).starts_with("Use winner"));
}

TEST_CASE("Advice compares auto with the winner as far as the repeats permit") {
    racer automatic = finalist("auto (= x)", 10, 1.3, true);
    automatic.tested.name.engine = "auto";
    const racer winner = finalist("winner", 10, 1);
    const racer second = finalist("second", 10, 1.01);
    const auto reported = [](const aabblab::race_result& race, const std::string& begin) {
        return std::ranges::any_of(aabblab::advice_of(race), [&](const auto& s) { return s.starts_with(begin); });
    };
    CHECK(reported(race_with({winner, second, automatic}), "auto (= x) takes 1."));
    racer noisy = finalist("auto (= x)", {1, 3, 1, 3, 1, 3, 2.1});
    noisy.tested.name = automatic.tested.name;
    const racer even = finalist("even", {2, 2, 2, 2, 2, 2, 2});
    const racer odd = finalist("odd", {2.01, 2.01, 2.01, 2.01, 2.01, 2.01, 2.01});
    CHECK(reported(race_with({even, odd, noisy}, 2), "auto (= x) is as fast within the noise of 7 repeats ("));
    aabblab::race_result without = race_with({winner, second});
    automatic.last = automatic.times.front();
    automatic.last->frames = 8;
    automatic.slowdown = 1.5;
    without.dropped.push_back(automatic);
    CHECK(reported(without, "auto (= x) was dropped after 8 frames: it had taken 1.50 times as long as the fastest."));
    without.dropped.back().broken_off = aabblab::attempt{aabblab::ending::stopped, {}, "", 2.1};
    CHECK(reported(without, "auto (= x): stopped after 2.1 s."));
}

TEST_CASE("In rounds each candidate runs once, begins in turn and follows the others about equally often") {
    for (std::size_t candidates = 1; candidates <= 12; ++candidates) {
        INFO(candidates << " candidates");
        std::vector<std::vector<int>> follows(candidates, std::vector<int>(candidates));
        // For odd numbers exact balance needs twice as many rounds, half of them reversed.
        for (std::size_t round = 0; round < candidates; ++round) {
            std::vector<bool> has_run(candidates);
            for (std::size_t place = 0; place < candidates; ++place) {
                const std::size_t candidate = aabblab::index_in_round(place, round, candidates);
                REQUIRE(candidate < candidates);
                CHECK_FALSE(has_run[candidate]);
                has_run[candidate] = true;
                if (place > 0) ++follows[candidate][aabblab::index_in_round(place - 1, round, candidates)];
            }
            CHECK(aabblab::index_in_round(0, round, candidates) == round);
        }
        for (std::size_t a = 0; a < candidates; ++a)
            for (std::size_t b = 0; b < candidates; ++b)
                if (a != b) CHECK((candidates % 2 == 0 ? follows[a][b] == 1 : follows[a][b] <= 2));
    }
}

TEST_CASE("Rounds run while there is time for another, and a minimum number in any case") {
    std::vector<char> names{'a', 'b', 'c'};
    std::string order;
    double left = 10;
    const auto run = [&](char name, std::size_t round) {
        order += name + std::to_string(round);
        left -= 2;
    };
    const auto after = [&](std::size_t) { std::erase(names, 'c'); };
    CHECK(aabblab::run_rounds(names, {.end = 9, .fewest = 2, .seconds_left = [&] { return left; }}, run, after) == 2);
    CHECK(order == "a0b0c0b1a1");
}

TEST_CASE("The stopping rule limits the time of a candidate by grace, ratio, share and margin") {
    const aabblab::stopping_rule rule{.grace = 1, .share = 10, .margin = 2};
    CHECK(rule.longest(0.25) == 6);
    CHECK(rule.longest(1) == 11);
    CHECK(rule.longest(8) == 17);
}

TEST_CASE_METHOD(in_folder, "Interleaved candidates begin in turn, and a hopeless one runs once") {
    const std::string file = folder / "order";
    std::vector<aabblab::candidate> candidates;
    for (const char* name : {"a", "b", "c"})
        candidates.push_back(logged(delayed(name, sleeping(*name == 'c' ? 250ms : 0ms)).tested, name, file));
    aabblab::staged_scene staged(scene);
    const aabblab::interleaved_runs runs = aabblab::run_interleaved(staged, candidates, 4, 3, aabblab::time_limits(60));
    CHECK(bytes_of_file(file) == "abcbaab");
    REQUIRE(runs.times.size() == 3);
    CHECK(runs.times[0].size() == 3);
    CHECK(runs.times[1].size() == 3);
    CHECK(runs.times[2].size() <= 1);
    CHECK(runs.hopeless == std::vector<bool>{false, false, true});
}

TEST_CASE("Interleaved runs have as many frames and rounds as time permits") {
    const auto runs_of = [](const std::vector<racer>& racers, double seconds) {
        std::vector<aabblab::candidate> candidates;
        for (const racer& r : racers) candidates.push_back(r.tested);
        aabblab::staged_scene staged(scene);
        return aabblab::run_interleaved(staged, candidates, 4, 3, aabblab::time_limits(seconds));
    };
    const aabblab::interleaved_runs short_runs =
        runs_of({delayed("first", stuck_in(2)), delayed("stuck", stuck_in(1)), delayed("fast", stuck_in(4))}, 3);
    CHECK(short_runs.frames == 2);
    CHECK(short_runs.times[0].size() == short_runs.rounds);
    CHECK(short_runs.times[1].empty());
    REQUIRE(short_runs.broken_off[1].has_value());
    CHECK(short_runs.broken_off[1]->seen.frames == 1);
    CHECK_FALSE(short_runs.times[2].empty());
    const aabblab::interleaved_runs no_runs = runs_of({delayed("first", stuck_in(0)), delayed("fast", stuck_in(4))}, 1);
    CHECK(no_runs.rounds == 0);
    CHECK(no_runs.times[0].empty());
    CHECK(text_of(no_runs.broken_off[0].value()).starts_with("stopped after "));
    CHECK_FALSE(no_runs.broken_off[1].has_value());
}

TEST_CASE("A paired ratio has the median, minimum and maximum over the rounds") {
    const auto of = [](const std::vector<double>& ms, const std::vector<double>& of_other) {
        return aabblab::paired_ratio_of(ms, of_other);
    };
    const aabblab::paired_ratio ratio = of({2, 8, 4.5}, {1, 2, 3});
    CHECK(ratio.median == 2);
    CHECK(ratio.least == 1.5);
    CHECK(ratio.greatest == 4);
    CHECK_FALSE(ratio.may_be_same());
    CHECK(of({2}, {1}).may_be_same());
    CHECK(of({1.02, 1.3}, {1, 1}).may_be_same());
    CHECK(of({0.7, 0.98}, {1, 1}).may_be_same());
    CHECK(of({0.7, 1.3}, {1, 1}).may_be_same());
    CHECK_FALSE(of({1.04, 1.3}, {1, 1}).may_be_same());
    CHECK_FALSE(of({0.7, 0.96}, {1, 1}).may_be_same());
}

TEST_CASE("Every exact candidate starts in a race, engines included") {
    std::vector<racer> racers = candidates_for_race(scene);
    CHECK(racers.front().name == "auto (= neighbour_list + bucket + columns + simd)");
    CHECK_FALSE(has_racer(racers, "neighbour_list + bucket + columns + simd"));
    for (const char* name : {"bucket + columns + simd", "insertion + none + incremental", "std + uniform_grid + simd"})
        CHECK(has_racer(racers, name));
    CHECK_FALSE(has_racer(racers, "split_mesh + bucket + columns + simd"));
    for (const aabb::engine_info& engine : aabb::engines())
        CHECK(has_racer(racers, engine.name) == (engine.exact && engine.searches_boxes));
    // The composition that auto selects does not start twice.
    aabblab::scene_choice still = scene;
    still.settings[1].value = "1";
    racers = candidates_for_race(still);
    CHECK(racers.front().name == "auto (= bucket + columns + simd)");
    CHECK_FALSE(has_racer(racers, "bucket + columns + simd"));
    const aabblab::scene_choice meshes{"mesh_pair", {}, {"icosphere:triangles=80"}, 1, {}};
    racers = candidates_for_race(meshes);
    for (const char* name :
         {"bucket + columns + simd + sah + implicit + exact", "bucket + columns + simd + canonical + exact"})
        CHECK(has_racer(racers, name));
    CHECK_FALSE(has_racer(racers, "bucket + columns + simd + canonical + moller"));
    for (const aabb::engine_info& engine : aabb::engines())
        if (engine.collides_meshes)
            CHECK(std::ranges::any_of(racers, [&](const racer& r) { return r.name.starts_with(engine.name); }) ==
                  engine.exact);
}

TEST_CASE_METHOD(in_folder, "recommend ranks candidates, says which to use and writes a page") {
    const std::string file = folder / "p.aabbs";
    const std::string page = folder / "p.html";
    run_well({"scene", "pile", "--n", "300", "--frames", "8", "--out", file});
    const program_result reported = run_well({"recommend", file, "--seconds", "1", "--report", page});
    CHECK(holds(reported.out, "\nUse "));
    CHECK(holds(reported.out, "300 objects, 9 frames\n"));
    CHECK_FALSE(holds(reported.out, "finds other pairs"));
    const std::string html = bytes_of_file(page);
    for (const char* part : {"<p>Use ", "overlapping pairs per object", "dropped", "all_axes", "<p>aabblab "})
        CHECK(holds(html, part));
    for (const char* part : {"\nratio: all ms divided by that of candidate 1", "\nms/frame: the mean time per frame",
                             "\nbuild ms: the time to create"})
        CHECK(holds(reported.out, part));
    check_narrow(reported.out.substr(reported.out.find("\nUse ") + 1));
    for (const char* seconds : {"0", "-1", "inf", "nan", "1e7", "x", ""}) {
        CHECK(holds(
            run_refused({"recommend", file, "--seconds", seconds}).err,
            "--seconds is how long to run: a number above 0, at most 1,000,000, not '" + std::string(seconds) + "'"));
    }
    CHECK(run_program({"recommend", folder / "none.aabbs"}).status == 2);
    const std::string single = folder / "one.aabbs";
    run_well({"scene", "pile", "--n", "1", "--frames", "2", "--out", single});
    CHECK(holds(run_refused({"recommend", single}).err, "nothing to search: the scene has 1 object"));
    CHECK(holds(run_refused({"recommend", "still.toml"}).err,
                "still.toml is a config, which explain and run take as their only argument"));
}

TEST_CASE_METHOD(in_folder, "recommend never overwrites its input and rejects an unwritable page before it runs") {
    const std::string mesh = folder.write("t.off", tetrahedron);
    const std::string file = folder / "p.aabbs";
    run_well({"scene", "pile", "--n", "30", "--frames", "2", "--out", file});
    const std::string recording = bytes_of_file(file);
    const auto rejected = [&](const std::vector<std::string>& what, const std::string& report) {
        CHECK(run_refused(joined(joined({"recommend"}, what), {"--report", report})).out.empty());
    };
    rejected({file}, file);
    rejected({mesh}, mesh);
    rejected({mesh + ":order=sah"}, mesh);
    rejected({file}, folder / "no" / "p.html");
    setenv("AABBLAB_DATA", folder.path().c_str(), 1);
    rejected({"t.off"}, mesh);
    rejected({"icosphere:triangles=80", "t.off"}, mesh);
    unsetenv("AABBLAB_DATA");
    CHECK(bytes_of_file(mesh) == tetrahedron);
    CHECK(bytes_of_file(file) == recording);
    CHECK(folder.files() == 2);
}
