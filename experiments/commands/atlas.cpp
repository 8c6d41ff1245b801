#include "command_parser.hpp"

import aabblab.atlas;
import aabblab.record;
import aabblab.statistics;
import aabblab.suites;
import aabblab.tables;

namespace aabblab {

namespace {

struct atlas_request {
    std::optional<std::string> out;
    std::optional<std::string> source;  ///< the folder or archive to judge instead of the folder `out`
    bool quick = false, judge = false;

    [[nodiscard]] std::filesystem::path folder() const {
        if (out) return *out;
        if (source) return "results/atlas-judged";
        return quick ? "results/atlas-quick" : "results/atlas";
    }
};

struct measured_results {
    std::filesystem::path folder;  ///< of the experiments
    std::vector<atlas_scene> scenes;
    std::vector<border_law> laws;
};

/// Reads the measured scenes of an atlas, or of the one in a reproduction's report, and notes unfinished parts.
measured_results existing_atlas(const results_source& source) {
    verify_record(source.folder);
    std::filesystem::path parts = source.folder;
    std::vector<atlas_scene> atlas = measured_atlas(parts);
    if (atlas.empty()) atlas = measured_atlas(parts = folder_of_atlas(source.folder));
    if (atlas.empty()) throw aabb::input_error("there are no results of an atlas in " + source.name);
    for (const std::string& missing : unfinished_parts(parts)) note(missing);
    return {parts, std::move(atlas), measured_laws(parts)};
}

/// Measures the atlas, or with --judge reads results, writes its maps, and prints which candidate is the fastest where.
/// @returns the exit status: 1 if a check failed
int run(const atlas_request& request) {
    outlive_reader();  // a closed pipe does not stop the measurement
    if (request.source && !request.judge)
        throw aabb::input_error(*request.source + " is given, but only --judge reads existing results");
    const std::filesystem::path out = request.folder();
    std::vector<std::string> failures;
    if (!request.judge) failures = measure_atlas(out, request.quick);
    const std::vector<std::string> names(request.source ? 1 : 0, request.source.value_or(""));
    results_sources sources(names);
    if (names.empty()) sources.add(out);
    const results_source& source = sources.list().front();
    measured_results measured;
    // An archive is read from an unpacked copy, but messages have the archive's name.
    (void)sources.run_with_source_names([&] {
        measured = existing_atlas(source);
        return 0;
    });
    const std::vector<atlas_scene>& atlas = measured.scenes;
    write_atlas(out, atlas, measured.laws);
    write_times_of_atlas(out, measured.folder);
    print_paragraph(
        "How often each candidate is the fastest, by processor time per frame after the first; shown in: scenes where "
        "the second is slower beyond noise; as fast in: scenes where another is faster, but not beyond noise");
    print(to_text(winners_table(atlas), output_width()) + "\n");
    print("Processor time per frame after the first, relative to the fastest candidate of each scene\n" +
          to_text(regrets_table(atlas, atlas_time::per_frame), output_width()) + "\n");
    for (const border_law& law : measured.laws) print_paragraph(sentence_of(law));
    if (!measured.laws.empty()) print_paragraph("Here " + std::string(legend_of_laws));
    print("\n");
    for (const judged_statement& s : judged_statements(atlas))
        print_paragraph(fmt::format("{}: {} Here: {}. ({})", s.text.id, s.text.says, verdict_text(s), s.text.source));
    print("\nMaps, borders and every ratio are in " + visible((out / "atlas.html").string()) + "\n");
    return failures.empty() ? 0 : 1;
}

}  // namespace

void add_atlas(const command_parser& program) {
    const command_parser command = program.add_command(
        "atlas",
        "Map the fastest composition or engine of each scene, and the slowdown of each candidate relative to it");
    auto& request = command.set_action(run);
    command.flag("--quick", &request.quick, "Use small scenes and few repeats: a minute instead of half an hour");
    command.flag("--judge", &request.judge, "Measure nothing: draw the maps of existing results");
    command.optional_argument("RESULTS", &request.source,
                              "With --judge: archive or folder of results, from atlas or reproduce, instead of the "
                              "folder of --out");
    command.option("--out DIR", &request.out,
                   "Folder of results and maps (default results/atlas; with --quick results/atlas-quick; with RESULTS "
                   "results/atlas-judged)");
}

}  // namespace aabblab
