module aabblab.suites;

import aabblab.errors;
import aabblab.files;
import aabblab.fmt;
import aabblab.output;
import aabblab.stopwatch;

namespace aabblab {

namespace {

/// Prints the errors of triangle tests in two tables per group of pairs: over all its pairs, and by set of pairs.
void print_tables(std::span<const error_point> points) {
    for (const pair_group group : groups_in(points)) {
        print(wrapped(group_statement(points, group)) +
              "\n\nwrong: share of the pairs of the set in which the method errs most, the last\n"
              "column; FN, FP: false negatives, share of its intersecting pairs, and false\n"
              "positives, share of its disjoint pairs; fewest wrong first\n"
              "ns/pair: processor time, the median over batches, then the mean over sets\n"
              "aabblab list triangle and list library_tests explain names and parameters\n\n" +
              to_text(error_summary(points, group), output_width()) + "\n");
        print("By set of pairs: FN and FP, joined by +, here as shares of all pairs of the set\n");
        for (const std::string& scene : scenes_by_number(points, group)) print(wrapped(scene) + "\n");
        print("\n" + to_text(errors_by_set(points, group), output_width()) + "\n");
    }
}

/// Prints how the constructed intersections of triangles differ from CGAL's, and whether their error bounds hold.
void print_tables(std::span<const hit_point> points) {
    for (const bool in_double : {false, true}) {
        const table shown = hit_summary(points, in_double);
        if (shown.rows.empty()) continue;
        print(
            fmt::format("Intersections of triangles of {}s, compared with CGAL's exact construction\n"
                        "differ: hits with another kind or number of corners; error/bound: the greatest\n"
                        "ratio of an error to its bound; error, bound: the greatest error and its bound;\n"
                        "ns/hit: the median over batches of up to 1,024 hits\n\n{}\n",
                        in_double ? "double" : "float", to_text(shown, output_width())));
    }
}

/// Constructs the intersections of pairs of triangles, compares them with CGAL's, and writes intersections.csv.
/// @returns a sentence for each test with wrong intersections
std::vector<std::string> measure_hits_into(const std::filesystem::path& folder, std::span<const pair_set> sets,
                                           printed shown) {
    // Write after each set, so that a crash does not lose finished ones.
    const std::vector<hit_point> points = measure_hits(
        sets, [&](std::span<const hit_point> finished) { write_file(folder / "intersections.csv", csv_of(finished)); });
    if (shown != printed::nothing) print_tables(points);
    std::vector<std::string> failures;
    for (const hit_point& p : points)
        if (!p.is_right())
            failures.push_back(fmt::format("{} constructs {} intersections of {} wrongly", p.triangle,
                                           p.different + p.outside, p.pairs));
    return failures;
}

}  // namespace

std::string default_study() {
    return AABBLAB_ERROR_CONFIGS "/triangle_tests.toml";
}

std::vector<std::filesystem::path> configs_in(const std::filesystem::path& folder) {
    std::vector<std::filesystem::path> configs;
    for (const auto& file : std::filesystem::directory_iterator(folder))
        if (file.path().extension() == ".toml") configs.push_back(file.path());
    std::ranges::sort(configs);
    return configs;
}

std::vector<std::filesystem::path> error_configs() {
    return configs_in(AABBLAB_ERROR_CONFIGS);
}

/// Runs a study of error against time: of compositions in whole scenes, or of triangle tests on pairs of triangles. It
/// may also compare the intersections of triangles that tests construct with exact ones (`hits`).
/// @returns a sentence per failure
std::vector<std::string> measure_study(const error_study& study, const std::filesystem::path& folder, printed shown) {
    require_fine_clock();
    std::vector<std::string> failures;
    std::filesystem::create_directories(folder);
    // Remove results of an earlier study, which would not match the config of this one.
    for (const char* file : {"errors.csv", "intersections.csv"}) std::filesystem::remove(folder / file);
    remove_record(folder);
    write_file(folder / "config.toml", study.text);
    if (study.scene_experiment) {
        failures =
            run_experiment(*study.scene_experiment, folder, existing_results::replace, "the same command", shown);
        const std::vector<row> rows = verified_rows(folder);
        const study_record record = record_of(study, rows);
        write_record(folder, record);
        if (shown != printed::nothing) {
            for (const std::string& text : metric_statements(record, rows)) print(wrapped(text) + "\n\n");
            draw(folder / "figures", metric_figures(record, rows));
        }
    } else if (!study.curves.empty()) {
        const std::vector<error_point> points = measure_errors(
            study, [&](std::span<const error_point> finished) { write_file(folder / "errors.csv", csv_of(finished)); });
        if (shown != printed::nothing) {
            print_tables(points);
            draw(folder / "figures", error_figures(points));
        }
    }
    if (!study.hits.empty())
        std::ranges::move(measure_hits_into(folder, study.hits, shown), std::back_inserter(failures));
    return failures;
}

}  // namespace aabblab
