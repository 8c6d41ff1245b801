module aabblab.comparison;

import aabb.base;
import aabblab.fmt;
import aabblab.output;
import aabblab.tables;

namespace aabblab {

namespace {

bool has_results(const std::filesystem::path& folder) {
    std::error_code ignored;
    return std::filesystem::is_regular_file(folder / "results.csv", ignored);
}

/// The folder itself if it holds a results.csv, otherwise its sub-folders that do.
std::vector<std::filesystem::path> folders_in(const std::filesystem::path& folder) {
    if (has_results(folder)) return {folder};
    std::error_code error;
    std::vector<std::filesystem::path> paths;
    for (auto entry = std::filesystem::directory_iterator(folder, error);
         !error && entry != std::filesystem::directory_iterator(); entry.increment(error))
        if (has_results(entry->path())) paths.push_back(entry->path());
    if (error) throw aabb::input_error(folder.string() + " cannot be read: " + error.message());
    std::ranges::sort(paths);
    return paths;
}

std::string maker_of(const manifest_summary& m) {
    return fmt::format("commit {}, {}, {}", m.commit, m.compiler, m.cpu);
}

/// The builds and processors of a run: "commit d27dba3, Clang 19.1.7, Intel Xeon"; a list if experiments differ.
std::string makers_of(const run_results& run) {
    std::vector<std::string> makers;
    for (const manifest_summary& m : run.manifests)
        if (std::ranges::find(makers, maker_of(m)) == makers.end()) makers.push_back(maker_of(m));
    return fmt::format("{}", fmt::join(makers, "; "));
}

/// Rejects runs of different processors, as their times are not comparable.
void require_one_machine(const run_results& a, const run_results& b) {
    for (const manifest_summary& of_a : a.manifests)
        for (const manifest_summary& of_b : b.manifests)
            if (of_a.cpu != of_b.cpu)
                throw aabb::input_error(fmt::format(
                    "--times compares runs of one machine only: {} is from {}, {} from {}; without --times, ratios are "
                    "compared",
                    a.folder.string(), maker_of(of_a), b.folder.string(), maker_of(of_b)));
}

/// Indexed by `outcome`.
constexpr std::array<std::string_view, 4> outcome_names{"less", "same", "more", "undecided"};

std::string heading_of(const compared_scene& s) {
    return fmt::format("{}: {}, {}", s.experiment, s.scene.kind, settings_text(s.scene));
}

void print_block(const std::string& heading, const table& t) {
    if (!t.rows.empty()) print("\n" + heading + "\n" + to_text(t, output_width()));
}

void print_different_results(const comparison& report) {
    table t = empty_table({"experiment", "scene", "parameters", "digest in A", "in B"});
    for (const different_result& d : report.different_results)
        t.rows.push_back({d.experiment, d.scene.kind, parameters_text(d.scene), d.in_a, d.in_b});
    print_block(fmt::format("the results differ in {} of {} scenes", t.rows.size(), report.results_compared), t);
}

/// The table of a scene's compared ratios or times: those that changed beyond noise from A to B, or all.
/// @param unit the column's name: "ratio" or "ms"
table table_of(std::span<const compared_time> times, const std::string& unit, bool list_all) {
    table t = empty_table({"composition"}, {(unit + " in A").c_str(), "in B", "B/A", "95 %"}, {"B is"});
    for (const compared_time& time : times)
        if (list_all || time.verdict == outcome::less || time.verdict == outcome::more)
            t.rows.push_back(
                {time.label, fmt::format("{:.3f}", time.in_a), fmt::format("{:.3f}", time.in_b),
                 fmt::format("{:.3f}", time.change),
                 time.lacks_repeats ? "-" : fmt::format("{:.3f}-{:.3f}", time.change_range.low, time.change_range.high),
                 std::string(outcome_names[static_cast<std::size_t>(time.verdict)])});
    return t;
}

/// Prints a table per scene, then a line of totals: "24 ratios compared: 2 changed beyond noise, …".
/// @param times either the ratios or the milliseconds of a scene
/// @param list_all includes unchanged and undecided ones
void print_compared(const comparison& report, std::vector<compared_time> compared_scene::* times, bool list_all) {
    const bool are_ratios = times == &compared_scene::ratios;
    const char* const quantity = are_ratios ? "ratios" : "times";
    std::size_t count = 0, changed = 0, same = 0, undecided = 0, too_few = 0;
    for (const compared_scene& s : report.scenes) {
        for (const compared_time& time : s.*times) {
            ++count;
            changed += time.verdict == outcome::less || time.verdict == outcome::more;
            same += time.verdict == outcome::same;
            undecided += time.verdict == outcome::undecided;
            too_few += time.verdict == outcome::undecided && time.lacks_repeats;
        }
        const std::string unit =
            are_ratios ? "; time relative to that of '" + s.baseline + "'" : "; milliseconds per frame";
        print_block(heading_of(s) + unit, table_of(s.*times, are_ratios ? "ratio" : "ms", list_all));
    }
    print(fmt::format("\n{} {} compared: {} changed beyond noise, {} unchanged (within {:.0f} %), {} undecided", count,
                      quantity, changed, same, 100 * equivalence_band, undecided));
    if (too_few > 0) print(fmt::format(", {} of them because of too few repeats", too_few));
    print("\n");
    if (undecided == 0) return;
    print(
        fmt::format("undecided: the interval of B/A extends beyond a change of {:.0f} %, or the change is significant "
                    "only without Holm's correction for all {}{}\n",
                    100 * equivalence_band, quantity, list_all ? "" : "; --all lists them"));
}

std::string percents(std::uint64_t before, std::uint64_t after) {
    if (before == 0) return "-";
    return fmt::format("{:+.2f}", 100 * (static_cast<double>(after) / static_cast<double>(before) - 1));
}

/// Prints the counts and bytes that changed, a table per scene, then a line of totals.
void print_numbers(const comparison& report) {
    std::size_t changed = 0;
    for (const compared_scene& s : report.scenes) {
        table t = empty_table({"composition", "quantity"}, {"in A", "in B", "%"});
        for (const changed_number& n : s.changed)
            t.rows.push_back(
                {n.label, n.quantity, std::to_string(n.in_a), std::to_string(n.in_b), percents(n.in_a, n.in_b)});
        changed += t.rows.size();
        print_block(heading_of(s) + "; sums over seeds", t);
    }
    print(fmt::format("{}{} counts and sizes compared: {} changed\n", changed > 0 ? "\n" : "", report.numbers_compared,
                      changed));
}

}  // namespace

/// Reads and verifies the results of a folder, or of all its sub-folders, which must be of different experiments.
run_results read_results(const std::filesystem::path& folder) {
    if (!std::filesystem::is_directory(folder))
        throw aabb::input_error(folder.string() +
                                (std::filesystem::exists(folder) ? " is not a folder" : " does not exist") +
                                "; expected a folder of results");
    run_results run{folder, {}, {}};
    std::map<std::string, std::filesystem::path> folder_of;  // by experiment
    for (const std::filesystem::path& subfolder : folders_in(folder)) {
        std::vector<row> rows = verified_rows(subfolder);
        if (rows.empty()) continue;
        for (const row& r : rows)
            if (const auto& before = folder_of.emplace(r.experiment, subfolder).first->second; before != subfolder)
                throw aabb::input_error(
                    fmt::format("{} and {} both hold results of the experiment {}; compare one of them",
                                before.string(), subfolder.string(), r.experiment));
        run.manifests.push_back(read_manifest(subfolder));
        run.rows.insert(run.rows.end(), std::make_move_iterator(rows.begin()), std::make_move_iterator(rows.end()));
    }
    if (run.rows.empty())
        throw aabb::input_error("there are no results in " + folder.string() +
                                ": neither it nor a sub-folder has a results.csv with rows");
    return run;
}

/// Prints what differs: pairs, ratios of times, times if requested, counts. Returns 1 as exit status if pairs differ.
int print_comparison(const compare_request& request) {
    const run_results a = read_results(request.a);
    const run_results b = read_results(request.b);
    if (request.times) {
        require_one_machine(a, b);
        note("times of runs at different hours differ by more than the noise within each; ratios are more reliable");
    }
    const comparison report = compare(a, b, request.times ? compared::ratios_and_times : compared::ratios);
    print(fmt::format("A: {} ({})\nB: {} ({})\n", visible(request.a), makers_of(a), visible(request.b), makers_of(b)));
    print_different_results(report);
    print_compared(report, &compared_scene::ratios, request.list_all);
    if (request.times) print_compared(report, &compared_scene::times, request.list_all);
    print_numbers(report);
    if (report.only_in_a + report.only_in_b > 0)
        print(fmt::format("not compared, because the other run lacks them: {} compositions in a scene of A, {} of B\n",
                          report.only_in_a, report.only_in_b));
    return report.different_results.empty() ? 0 : 1;
}

}  // namespace aabblab
