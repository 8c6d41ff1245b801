module aabblab.race;

import aabb.base;
import aabblab.configs;
import aabblab.files;
import aabblab.fmt;
import aabblab.inputs;
import aabblab.measures;
import aabblab.numbers;
import aabblab.output;
import aabblab.page;
import aabblab.stopwatch;
import aabblab.tables;

namespace aabblab {

namespace {

/// The ranking of the finalists. If the output is too narrow, columns with the greatest `spare` are left out first.
table table_of(const race_result& race) {
    table t{{{row_number}, {"candidate", /*is_number=*/false}, {"all ms"}, {"ratio"}, {"95 %"}, {"ms/frame"}}, {}};
    t.columns.push_back({.name = "first ms", .spare = 1});
    t.columns.push_back({.name = "build ms", .spare = 2});
    t.columns.push_back({"KiB"});
    for (const racer& r : race.finalists) {
        const observation& time = *r.last;
        const auto [low, high] = r.ratio_range();
        t.rows.push_back(
            {std::to_string(t.rows.size() + 1), r.name, fmt::format("{:.4g}", time.whole_ms()),
             fmt::format("{:.2f}", r.ratio()),
             &r == &race.finalists.front() || !r.has_range() ? "-" : fmt::format("{:.2f}-{:.2f}", low, high),
             fmt::format("{:.4g}", time.frame_ms()), fmt::format("{:.3g}", time.first.wall_ms()),
             fmt::format("{:.3g}", time.build.wall_ms), time.bytes > 0 ? grouped(time.bytes / 1024) : "-"});
    }
    return t;
}

/// How far behind a dropped candidate was, or how its run ended.
std::string reason_for_drop(const racer& r) {
    return r.broken_off ? text_of(*r.broken_off) : fmt::format("{:.3g}", r.slowdown);
}

table dropped_table_of(const race_result& race) {
    table t = empty_table({"dropped"}, {"after frames", "times"});
    for (const racer& r : race.dropped)
        t.rows.push_back({r.name, r.last ? std::to_string(r.last->frames) : "-", reason_for_drop(r)});
    return t;
}

/// Unfinished runs, without candidates that never ran.
table unfinished_table_of(const race_result& race) {
    table t = empty_table({"not finished", ""});
    for (const racer& r : race.dropped)
        if (r.broken_off && r.broken_off->seconds > 0) t.rows.push_back({r.name, reason_for_drop(r)});
    return t;
}

/// Explains the columns of the ranking.
std::vector<std::string> legend() {
    constexpr const char* all_ms_text =
        "all ms: build ms, first ms (frame 0) and all further frames. Times are those of the repeat whose all ms is "
        "the median.";
    constexpr const char* ratio_text =
        "ratio: all ms divided by that of candidate 1 in the same repeat, the median over repeats, with its 95 % "
        "confidence interval; -: candidate 1 itself, or too few repeats.";
    return {all_ms_text, ratio_text, ms_per_frame_text, build_ms_text, "KiB: memory without meshes."};
}

/// The report as HTML: the advice, then the ranking, measures of the scene, dropped candidates, and the machine.
std::string page_of(const std::string& scene, const race_result& race, const std::string& measures_html) {
    page report(scene);
    report.title(scene);
    report.paragraph(fmt::format("{}", fmt::join(advice_of(race), " ")));
    report.add(table_of(race));
    report.paragraph(fmt::format("{}", fmt::join(legend(), " ")));
    report.add_html(measures_html);
    report.add(dropped_table_of(race));
    report.paragraph(
        "Dropped: a candidate was stopped after this many frames, since it took this many times as long as the "
        "fastest, both in total and per frame after the first; or its run did not finish. Strategies have their "
        "default parameters.");
    const calibrated_costs here = label_costs(/*costs=*/{});  // for its label: program, date and machine
    report.paragraph(fmt::format("aabblab {}, {}, {}, {}", here.version, here.date, here.processor, here.instructions));
    return report.html();
}

/// The measures of the scene as HTML, or a note that there was no time for them.
std::string measures_page(staged_scene& scene, double seconds) {
    const child_result measured = scene.in_child(
        [](scene_frames& run, const output_sender& send) { send(to_html(measures_table(measure_scene(run)))); },
        seconds);
    return measured.end == ending::done ? measured.reported : "<p>There was no time to measure the scene.</p>\n";
}

}  // namespace

/// Times the compositions and engines, prints the ranking and recommends the fastest. The page is opened first, so that
/// invalid input is reported without delay. Returns the exit status: 1 if results differ.
int recommend(const recommend_request& request) {
    require_fine_clock();
    time_limits limits(request.seconds);
    scene_choice choice = scene_of_arguments(request.what);
    add_filter(request.filter, choice);
    staged_scene scene(choice);
    limits.note_scene_read();
    std::optional<output_file> page;
    if (request.report) {
        require_no_mesh(*request.report, request.what);
        for (const std::optional<std::string>& file : {request.filter.groups, request.filter.except})
            if (file) require_other_file(*request.report, *file);
        page.emplace(*request.report);
    }
    if (scene.scene().objects() < 2)
        throw aabb::input_error("nothing to search: the scene has " + counted(scene.scene().objects(), "object"));
    const race_result race = run_race(scene, race_candidates(scene.scene()), limits);
    const std::string name = heading_of(scene.choice());
    print_paragraph(name + ": " + counted(race.objects, "object") + ", " + counted(race.frames, "frame"));
    print_paragraph(
        fmt::format("{} of {} compositions and engines ran to the end; early stopping saved {:.0f} % of the frames",
                    race.finalists.size(), race.finalists.size() + race.dropped.size() + race.wrong.size(),
                    100 - 100 * static_cast<double>(race.frames_run) / static_cast<double>(race.frames_of_all)));
    print("\n" + to_text(table_of(race), output_width()) + "\n");
    for (const std::string& line : legend()) print_paragraph(line);
    print("\n");
    if (const table unfinished = unfinished_table_of(race); !unfinished.rows.empty())
        print(to_text(unfinished, output_width()) + "\n");
    for (const std::string& sentence : advice_of(race)) print_paragraph(sentence);
    if (page) {
        page->write(page_of(name, race, measures_page(scene, limits.to_end())));
        page->commit();
    }
    const std::string& digest = race.finalists.front().last->digest;
    const bool agree = std::ranges::all_of(race.finalists, [&](const racer& r) { return r.last->digest == digest; });
    return race.wrong.empty() && agree ? 0 : 1;
}

}  // namespace aabblab
