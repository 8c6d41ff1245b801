#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "commands.hpp"
#include "output.hpp"

// Imports, so it comes last.
#include "scene_arguments.hpp"

import aabb.base;
import aabblab.files;
import aabblab.measures;
import aabblab.numbers;
import aabblab.race;
import aabblab.results;
import aabblab.scenes;
import aabblab.statistics;
import aabblab.tables;

namespace aabblab {

namespace {

struct recommend_request {
    std::vector<std::string> what;
    std::optional<std::string> report;
    double seconds = 60;
};

std::string ratio_text(const racer& r) {
    return fmt::format("{:.2f}", std::exp(r.log_ratio->value));
}

std::string interval_of(const racer& r) {
    const auto [low, high] = r.log_ratio->range();
    return fmt::format("{:.2f}-{:.2f}", std::exp(low), std::exp(high));
}

table table_of(const race_result& race) {
    table t{{{row_number},
             {"finalist", false},
             {"all ms"},
             {"ratio"},
             {"95 %"},
             {"ms/frame"},
             {"first ms", true, 1},
             {"build ms", true, 2},
             {"KiB"}},
            {}};
    for (const racer& r : race.finalists) {
        const race_time& time = *r.last;
        t.rows.push_back({std::to_string(t.rows.size() + 1), r.name,
                          fmt::format("{:.4g}", time.over(static_cast<double>(race.frames))), ratio_text(r),
                          &r == &race.finalists.front() ? "-" : interval_of(r), fmt::format("{:.4g}", time.steady_ms()),
                          fmt::format("{:.3g}", time.first_ms), fmt::format("{:.3g}", time.build_ms),
                          grouped(time.bytes / 1024)});
    }
    return t;
}

table dropped_table_of(const race_result& race) {
    table t{{{"dropped", false}, {"after frames"}, {"times"}}, {}};
    for (const racer& r : race.dropped)
        t.rows.push_back({r.name, r.last ? std::to_string(r.last->frames) : "-",
                          r.last ? fmt::format("{:.3g}", r.behind) : "stopped"});
    return t;
}

/// From how many frames on, or below how many, somebody else is faster than the winner.
std::string what_would_change_it(const race_result& race) {
    const racer& winner = race.finalists.front();
    std::string text;
    for (const racer& r : race.finalists) {
        const double sooner = r.last->over(1) - winner.last->over(1);
        const double slower = r.last->steady_ms() - winner.last->steady_ms();
        // Only what is more than noise.
        if (&r == &winner || sooner * slower >= 0 || std::abs(slower) < 0.03 * winner.last->steady_ms()) continue;
        const double frames = 1 - sooner / slower;
        if (frames < 2 || frames > 1e6) continue;
        text += fmt::format("With {} than about {:.0f} frames it would be {}. ", sooner < 0 ? "fewer" : "more", frames,
                            r.name);
        break;
    }
    if (text.empty()) text = "Of those that ended, none would be faster over fewer frames, nor over more. ";
    return text;
}

/// How auto does, where it is neither first nor second, which is told already.
std::string of_automatic(const race_result& race) {
    for (std::size_t i = 0; i < race.finalists.size(); ++i) {
        const racer& r = race.finalists[i];
        if (!r.who.name.is_automatic()) continue;
        return i < 2 ? "" : fmt::format("auto takes {} times as long ({}). ", ratio_text(r), interval_of(r));
    }
    return "auto was dropped. ";
}

std::string sentence_of(const race_result& race) {
    const racer& winner = race.finalists.front();
    std::string text = fmt::format("Use {}: {:.4g} ms for all {} frames", winner.name,
                                   winner.last->over(static_cast<double>(race.frames)), race.frames);
    if (race.finalists.size() > 1) {
        const racer& next = race.finalists[1];
        text += next.log_ratio->range().low > 0 ? fmt::format("; {}, the next, takes {} times as long ({})", next.name,
                                                              ratio_text(next), interval_of(next))
                                                : fmt::format("; {} is as fast, as far as {} plays tell ({})",
                                                              next.name, winner.times.size(), interval_of(next));
    }
    return text + ". " + of_automatic(race) + what_would_change_it(race);
}

/// An answer that is not the others' is told, whoever gives it.
std::string other_answers(const race_result& race) {
    std::string text;
    const std::string& digest = race.finalists.front().last->digest;
    for (const racer& r : race.finalists)
        if (r.last->digest != digest)
            text += fmt::format("{} finds other pairs than {}. ", r.name, race.finalists.front().name);
    return text;
}

void write_report(const std::string& file, const std::string& scene, const race_result& race,
                  const std::vector<told_measure>& measured) {
    table measures{{{"measured", false}, {"", false}}, {}};
    for (const told_measure& one : measured) measures.rows.push_back({one.name, one.value});
    write_file(file, "<!DOCTYPE html>\n<html lang=\"en\"><head><meta charset=\"utf-8\"><title>" + html_text(scene) +
                         "</title>\n<style>body{font-family:sans-serif;max-width:60em;margin:2em auto}td,th{padding:"
                         "0 .6em;text-align:left}</style></head><body>\n<h1>" +
                         html_text(scene) + "</h1>\n<p>" + html_text(sentence_of(race) + other_answers(race)) +
                         "</p>\n" + to_html(table_of(race)) + to_html(measures) + to_html(dropped_table_of(race)) +
                         "</body></html>\n");
}

void recommend(const recommend_request& request) {
    if (!(request.seconds > 0)) throw aabb::input_error("--seconds is how long to race, so a number above 0");
    const scene_choice scene = scene_of_arguments(request.what);
    if (request.report) require_other_file(*request.report, request.what);
    const std::vector<told_measure> measured = told(measure_scene(scene));
    const race_result race = run_race(scene, starters(scene), request.seconds);
    const std::string name = scene.kind + " (" + visible(parameters_text(scene)) + ")";
    print(fmt::format("{}: {} objects, {} frames\n", name, race.objects, race.frames));
    print(fmt::format("{} of {} raced to the end; {:.0f} % of the frames that all would have played\n\n",
                      race.finalists.size(), race.finalists.size() + race.dropped.size(),
                      100 * static_cast<double>(race.played) / static_cast<double>(race.of)));
    print(to_text(table_of(race), output_width()) + "\n");
    print(sentence_of(race) + other_answers(race) + "\n");
    if (request.report) write_report(*request.report, name, race, measured);
}

}  // namespace

void add_recommend(CLI::App& program, int&) {
    auto* command = program.add_subcommand(
        "recommend",
        "Which composition or engine is the fastest in a scene, from a race that drops the hopeless early");
    auto request = std::make_shared<recommend_request>();
    command->add_option("WHAT", request->what, scene_arguments_help)->required()->type_name("");
    command
        ->add_option("--seconds", request->seconds,
                     "About how long to race (default 60); the last rounds may take longer")
        ->type_name("S");
    command->add_option("--report", request->report, "Write all of it as a page, too")->type_name("FILE.html");
    command->callback([request] { recommend(*request); });
}

}  // namespace aabblab
