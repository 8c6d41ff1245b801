module aabblab.race;

import aabb.registry;
import aabblab.fmt;
import aabblab.numbers;
import aabblab.results;

namespace aabblab {

namespace {

/// How much slower a finalist is than the winner, with the 95 % confidence interval: "takes 1.31 times as long
/// (1.25-1.36)". An interval that contains 1 does not show that it is slower.
std::string ratio_text(const racer& r) {
    if (!r.has_range())
        return fmt::format("takes {:.2f} times as long, in {}, too few for a confidence interval", r.ratio(),
                           counted(r.times.size(), "repeat"));
    const auto [low, high] = r.ratio_range();
    const std::string range = fmt::format("({:.2f}-{:.2f})", low, high);
    return low > 1 ? fmt::format("takes {:.2f} times as long {}", r.ratio(), range)
                   : fmt::format("is as fast within the noise of {} repeats {}", r.times.size(), range);
}

/// A sentence on the time of the default, `auto`; empty if it is first or second, as other sentences describe it.
std::string sentence_about_auto(const race_result& race) {
    const auto is_automatic = [](const racer& r) { return r.tested.name.is_automatic(); };
    if (const auto ended = std::ranges::find_if(race.finalists, is_automatic); ended != race.finalists.end())
        return ended - race.finalists.begin() < 2 ? "" : ended->name + " " + ratio_text(*ended) + ".";
    const auto dropped = std::ranges::find_if(race.dropped, is_automatic);
    if (dropped == race.dropped.end()) return "";
    if (dropped->broken_off) return fmt::format("{}: {}.", dropped->name, text_of(*dropped->broken_off));
    return fmt::format("{} was dropped after {}: it had taken {:.2f} times as long as the fastest.", dropped->name,
                       counted(dropped->last->frames, "frame"), dropped->slowdown);
}

/// The median over the repeats of the difference in `value`, an observation's time; empty if its confidence interval
/// contains 0, since then the repeats do not show which candidate is faster.
template <class Value>
std::optional<double> significant_difference(const racer& r, const racer& other, Value value) {
    cells differences(1, 1);
    for (std::size_t i = 0; i < r.times.size(); ++i) differences.add(0, 0, value(r.times[i]) - value(other.times[i]));
    const estimate difference = bootstrap(differences);
    const auto [low, high] = difference.range();
    return low > 0 || high < 0 ? std::optional(difference.value) : std::nullopt;
}

/// The number of frames for which two candidates take equally long.
struct break_even {
    double frames;
    bool faster_before;  ///< the other candidate is faster for fewer frames
};

/// The number n of frames for which two candidates take equally long, t1 + (n - 1) s, with t1 up to frame 0 and s per
/// further frame: n = 1 - (difference of t1) / (difference of s). Empty if not significant.
std::optional<break_even> break_even_of(const racer& other, const racer& winner) {
    if (!other.has_range()) return std::nullopt;
    const auto begin = significant_difference(other, winner, [](const observation& t) { return t.over(1); });
    const auto steady = significant_difference(other, winner, [](const observation& t) { return t.steady_ms(); });
    if (!begin || !steady || (*begin > 0) == (*steady > 0)) return std::nullopt;
    return break_even{1 - *begin / *steady, *begin < 0};
}

/// The options that select a candidate; none for `auto`, which is the default.
std::string options_of(const candidate_name& name) {
    if (name.is_automatic()) return "";
    std::string text;
    for (const aabb::strategy_kind kind : aabb::strategy_kinds)
        if (!name[kind].empty()) text += fmt::format(" --{} {}", name_of(kind), name[kind]);
    return "Options that select it:" + (name.engine.empty() ? text : " --engine " + name.engine);
}

/// "25 frames", "the first 4 of 1,000 frames", "the first of 61 frames"
std::string frames_text(const race_result& race) {
    if (race.final_frames == race.frames) return counted(race.frames, "frame");
    return fmt::format("the first {}of {}", race.final_frames == 1 ? "" : grouped(race.final_frames) + " ",
                       counted(race.frames, "frame"));
}

/// The candidate that would be faster than the winner with fewer or more frames, by the nearest break-even: "below
/// about 12 frames, NAME would be faster".
std::vector<std::string> faster_at_other_lengths(const race_result& race) {
    const racer& winner = race.finalists.front();
    if (race.final_frames < 2 || race.finalists.size() < 2 || !winner.has_range()) return {};  // nothing to compare
    std::vector<std::string> parts;
    for (const bool is_fewer : {true, false}) {
        const auto frames = static_cast<double>(race.final_frames);
        // The interval in which a break-even is searched; each that is found shortens it.
        double low = is_fewer ? 1.5 : frames;   // fewer than 2 frames would be a single one
        double high = is_fewer ? frames : 1e6;  // an estimate that far ahead is of no use
        const racer* faster = nullptr;
        for (const racer& other : std::span(race.finalists).subspan(1)) {
            const std::optional<break_even> point = break_even_of(other, winner);
            if (!point || point->faster_before != is_fewer || point->frames <= low || point->frames >= high) continue;
            (is_fewer ? low : high) = point->frames;
            faster = &other;
        }
        if (faster)
            parts.push_back(fmt::format("{} about {:.0f} frames, {} would be faster", is_fewer ? "below" : "above",
                                        is_fewer ? low : high, faster->name));
    }
    if (parts.empty())
        parts.emplace_back("extrapolated to fewer or more frames, no other candidate is shown to be faster");
    return parts;
}

/// Caveats: candidates that did not run, and results that were not compared or differ between finalists.
std::vector<std::string> caveats_of(const race_result& race) {
    std::vector<std::string> sentences;
    const auto not_run =
        std::ranges::count_if(race.dropped, [](const racer& r) { return r.broken_off && r.broken_off->seconds == 0; });
    if (not_run > 0)
        sentences.push_back(fmt::format("There was no time for {}; increase --seconds.",
                                        counted(static_cast<std::size_t>(not_run), "candidate")));
    if (race.is_validated()) return sentences;
    const racer& winner = race.finalists.front();
    sentences.push_back(
        race.validated > 0
            ? fmt::format(
                  "Only the first {} compared with the ground truth: CGAL did not finish in time.",
                  race.validated == 1 ? "of these frames was" : grouped(race.validated) + " of these frames were")
            : "No candidate was compared with the ground truth: CGAL failed, or did not finish in time.");
    for (const racer& other : race.finalists)
        if (other.last->digest != winner.last->digest)
            sentences.push_back(fmt::format("{} finds other pairs than {}.", other.name, winner.name));
    return sentences;
}

}  // namespace

/// The recommendation, a sentence each: the winner, other numbers of frames, `auto`, options, wrong results, caveats.
std::vector<std::string> advice_of(const race_result& race) {
    const racer& winner = race.finalists.front();
    std::string use = fmt::format("Use {}: {:.4g} ms for {}", winner.name, winner.last->whole_ms(), frames_text(race));
    if (race.finalists.size() > 1)
        use += fmt::format("; the next, {}, {}", race.finalists[1].name, ratio_text(race.finalists[1]));
    for (const std::string& part : faster_at_other_lengths(race)) use += "; " + part;
    std::vector<std::string> sentences{use + "."};
    if (std::string sentence = sentence_about_auto(race); !sentence.empty()) sentences.push_back(std::move(sentence));
    if (std::string options = options_of(winner.tested.name); !options.empty()) sentences.push_back(std::move(options));
    for (const racer& r : race.wrong)
        sentences.push_back(fmt::format("{} is rejected: its pairs differ from the ground truth.", r.name));
    for (std::string& sentence : caveats_of(race)) sentences.push_back(std::move(sentence));
    return sentences;
}

}  // namespace aabblab
