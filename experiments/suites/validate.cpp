module aabblab.suites;

import aabb.extreme;
import aabb.policy;
import aabblab.extreme;
import aabblab.files;
import aabblab.fmt;
import aabblab.json;
import aabblab.output;
import aabblab.progress;
import aabblab.stepping;
import aabblab.stiff;

namespace aabblab {

namespace {

/// The tables of the report on extreme scenes and hard pairs of triangles, without empty ones; a row per result.
std::vector<named_table> tables_of(std::span<const extreme_row> rows) {
    std::vector<named_table> tables = {
        {"extreme_boxes", "Boxes, compared with a plain loop over all pairs", scene_table(rows, row_group::boxes)},
        {"extreme_meshes", "Meshes, compared with CGAL's exact kernel; -2 +3: 2 false negatives, 3 false positives",
         scene_table(rows, row_group::meshes)},
        {"extreme_tests", "Meshes, by inexact triangle tests", inexact_scene_table(rows)},
        {"extreme_classes", "Meshes, wrong pairs of inexact candidates by class", class_table(rows)},
        {"extreme_cases", "Hard pairs of triangles, by exact tests, and as meshes: all pairs, any one, their number",
         case_table(rows)},
        {"extreme_case_tests", "Hard pairs of triangles, by inexact tests, in every order of corners, float and double",
         inexact_case_table(rows)}};
    std::erase_if(tables, [](const named_table& t) { return t.content.rows.empty(); });
    return tables;
}

suite_report report_of(std::span<const extreme_row> rows) {
    return {memory_in(rows), {}, tables_of(rows), failures_in(rows)};
}

/// The tables of a study of stiff contacts, one per quantity: case, value, expectation, and whether it holds.
std::vector<named_table> tables_of(const stiff_study& study, const stiff_result& result) {
    std::vector<named_table> tables;
    for (const stiff_row& r : result.rows) {
        const std::string caption = fmt::format("{}: {}", study.name, r.quantity);
        auto match = std::ranges::find(tables, caption, &named_table::caption);
        if (match == tables.end()) {
            const std::string name = fmt::format("{}_{}", study.name, tables.size() + 1);
            tables.push_back({name, caption, empty_table({r.quantity.c_str()}, {"measured"}, {"expected", ""})});
            match = tables.end() - 1;
        }
        match->content.rows.push_back({r.subject, fmt::format("{:.4g}", r.measured), r.rule,
                                       std::string(stiff_verdict_words[static_cast<std::size_t>(r.verdict)])});
    }
    return tables;
}

/// Adds the description, figures, tables and failed expectations of a study to the report.
void add_study(suite_report& report, const stiff_study& study, const stiff_result& result) {
    report.paragraphs.push_back(fmt::format("{}: {}. Expected: {}.", study.name, study.about, study.reference));
    std::ranges::move(figures_of(study, result), std::back_inserter(report.figures));
    std::ranges::move(tables_of(study, result), std::back_inserter(report.tables));
    for (const stiff_row& r : result.rows)
        if (!r.holds())
            report.failures.push_back(
                fmt::format("{}: {}: {} is {:.4g}, not {}", study.name, r.subject, r.quantity, r.measured, r.rule));
}

/// The studies of stiff contacts with these names, or all if there are no names.
std::vector<stiff_study> chosen_studies(const std::vector<std::string>& names) {
    std::vector<stiff_study> chosen;
    std::vector<std::string> known;
    for (const stiff_study& study : stiff_studies()) {
        known.emplace_back(study.name);
        if (names.empty() || std::ranges::find(names, study.name) != names.end()) chosen.push_back(study);
    }
    for (const std::string& name : names)
        if (std::ranges::find(known, name) == known.end())
            throw aabb::input_error(aabb::unknown_name("study", name, known));
    return chosen;
}

/// A row per study and a column per method: how many verdicts differ, and in brackets the greatest change of a value.
table table_of(std::span<const method_effect> effects) {
    table t = empty_table({"study"}, {"rules"});
    for (const method_effect& e : effects)
        if (std::ranges::find(t.columns, e.method, &column::name) == t.columns.end()) t.columns.push_back({e.method});
    for (const method_effect& e : effects) {
        auto row = std::ranges::find(t.rows, e.study, [](const auto& cells) { return cells[0]; });
        if (row == t.rows.end()) {
            t.rows.emplace_back(t.columns.size());
            row = t.rows.end() - 1;
            (*row)[0] = e.study;
            (*row)[1] = std::to_string(e.rules);
        }
        const auto place = std::ranges::find(t.columns, e.method, &column::name) - t.columns.begin();
        (*row)[static_cast<std::size_t>(place)] = fmt::format("{} ({:.1g})", e.turned, e.change);
    }
    return t;
}

/// The names of studies with results in the folder that this version does not have, sorted.
std::vector<std::string> unknown_studies(const std::filesystem::path& folder) {
    std::vector<std::string> names;
    if (!std::filesystem::is_directory(folder)) return names;
    for (const auto& file : std::filesystem::directory_iterator(folder)) {
        constexpr std::string_view ending = "_points.csv";
        std::string name = file.path().filename().string();
        if (!name.ends_with(ending)) continue;
        name.resize(name.size() - ending.size());
        if (std::ranges::find(stiff_studies(), name, &stiff_study::name) == stiff_studies().end())
            names.push_back(std::move(name));
    }
    std::ranges::sort(names);
    return names;
}

figure_axis stored_axis(const json_value& j) {
    return {j.needed("label").text(), j.needed("logarithmic").flag()};
}

/// Reads a line of a figure from a report of an earlier version, as JSON. A point is x, y, and the quartiles of y.
series stored_series(const json_value& j) {
    const json_value style = j.needed("style");
    if (style.index() > static_cast<std::size_t>(series_style::level)) style.fail("is not a style of lines");
    series line{j.needed("label").text(), static_cast<series_style>(style.index())};
    for (const json_value& p : j.needed("points").list()) {
        const std::vector<json_value> numbers = p.list();
        if (numbers.size() != 4) p.fail("must be four numbers");
        // Here the quartiles equal y, as nothing was repeated. In JSON a y that is not finite, as of a diverging
        // trajectory, is null.
        if (!numbers[1].is_null()) line.points.push_back({numbers[0].number(), numbers[1].number()});
    }
    return line;
}

/// Reads a figure from a report in JSON, which earlier versions stored instead of rows.
figure stored_figure(const json_value& j) {
    figure f{j.needed("name").text(), j.needed("caption").text(), stored_axis(j.needed("x")),
             stored_axis(j.needed("y"))};
    for (const json_value& line : j.needed("lines").list()) f.lines.push_back(stored_series(line));
    for (const json_value& m : j.needed("marks").list())
        f.marks.push_back({m.needed("x").number(), m.needed("label").text()});
    return f;
}

/// Reads a table from a report in JSON, which earlier versions stored instead of rows.
named_table stored_table(const json_value& j) {
    named_table t{j.needed("name").text(), j.needed("caption").text(), {}};
    for (const json_value& c : j.needed("columns").list())
        t.content.columns.push_back({c.needed("name").text(), c.needed("is_number").flag()});
    for (const json_value& row : j.needed("rows").list()) {
        t.content.rows.push_back(row.texts());
        if (t.content.rows.back().size() != t.content.columns.size()) row.fail("must have a field for each column");
    }
    return t;
}

suite_report read_report(const std::filesystem::path& file) {
    const json_value document(file.string(), text_of_file(file), "is not the report of a suite of validate");
    suite_report report{document.needed("paragraphs").texts(), {}, {}, document.needed("failures").texts()};
    for (const json_value& f : document.needed("figures").list()) report.figures.push_back(stored_figure(f));
    for (const json_value& t : document.needed("tables").list()) report.tables.push_back(stored_table(t));
    return report;
}

}  // namespace

std::string default_cases() {
    return AABBLAB_CASES;
}

/// Runs the extreme scenes and hard pairs of triangles (`cases`, a file), compares with the ground truth, stores a row
/// per result, and prints the report if `shown`.
suite_report run_extreme_suite(const std::filesystem::path& folder, const std::string& cases, bool quick, bool shown) {
    const auto size = quick ? aabb::extreme_size::quick : aabb::extreme_size::full;
    const std::vector<aabb::triangle_case> hard = read_triangle_cases(cases);
    std::filesystem::create_directories(folder);  // fail early, before the long run
    const extreme_list list = all_extreme_scenes(size);
    for (const std::string& sentence : list.notes) note(sentence);
    std::vector<extreme_row> rows = run_extreme_scenes(list.scenes, size);
    // Write the scenes first, so that a crash in the cases does not lose them.
    write_file(folder / "extreme.csv", csv_of(rows));
    for (extreme_row& row : run_triangle_cases(hard)) rows.push_back(std::move(row));
    suite_report report = report_of(rows);
    write_file(folder / "extreme.csv", csv_of(rows));
    if (shown) {
        print(
            "exact: the same pairs as the ground truth; rejected: invalid input, rejected by\n"
            "AABB Lab as it must be; 91 exact: all 91 are; -: not run or, as a count, none.\n"
            "flushed_, upward_: in a thread that flushes denormals to zero or rounds upward.\n"
            "beyond_float: an engine in double that finds no pairs is exact, too.\n"
            "Classes of wrong pairs: near: moving one triangle by a millionth of the extent\n"
            "of both together changes the result; other: it does not.\n"
            "aabblab list engines explains engines.\n\n");
        for (const named_table& t : report.tables)
            print(wrapped(t.caption) + "\n\n" + to_text(t.content, output_width()) + "\n");
        for (const std::string& sentence : report.paragraphs) print(sentence + "\n");
        print("\nRejected:\n");
        for (const std::string& sentence : rejections_in(rows)) print("  " + sentence + "\n");
    }
    for (const std::string& sentence : report.failures) note(sentence);
    return report;
}

/// Runs simulations of stiff contacts, whose forces depend on detected contacts, and compares them with known results.
suite_report run_stiff_suite(const std::filesystem::path& folder, const std::vector<std::string>& studies, bool quick,
                             bool shown) {
    const std::vector<stiff_study> chosen = chosen_studies(studies);
    std::filesystem::create_directories(folder);
    for (const std::string_view name : left_out_integrators())
        note("the integrator " + std::string(name) +
             " is left out of this build: its library was not found; ./aabblab validate stiff installs it");
    if (shown)
        print(
            "Contacts exert forces, so wrong contacts give a wrong motion. Each study\ncompares the motion with a "
            "known one.\n\n");
    suite_report report;
    for (const stiff_study& study : chosen) {
        stiff_result result;
        {
            progress done("running " + std::string(study.name), 1000);  // thousandths
            study.run({quick, default_candidate(),
                       [&](double share) { done.update(static_cast<std::size_t>(1000 * share)); }},
                      result);
        }
        add_study(report, study, result);
        if (shown) {
            print(wrapped(report.paragraphs.back()) + "\n\n");
            for (const named_table& t : tables_of(study, result)) print(to_text(t.content, output_width()) + "\n");
            flush_output();
        }
        // Write after each study, so that a crash does not lose finished ones.
        write_result(folder, study, result);
        draw(folder / "figures", figures_of(study, result));
    }
    for (const std::string& sentence : report.failures) note(sentence);
    return report;
}

void compare_stiff_methods(const std::filesystem::path& folder, const std::vector<std::string>& studies, bool quick) {
    std::filesystem::create_directories(folder);
    std::vector<method_effect> effects = read_effects(folder);
    for (const stiff_study& study : chosen_studies(studies)) {
        if (study.compares_methods) {
            note("left out: " + std::string(study.name) + " compares methods by itself");
            continue;
        }
        std::erase_if(effects, [&](const method_effect& e) { return e.study == study.name; });
        progress done("comparing methods in " + std::string(study.name), 1000);  // thousandths
        std::ranges::move(
            effects_of_methods(study, {quick, default_candidate(),
                                       [&](double share) { done.update(static_cast<std::size_t>(1000 * share)); }}),
            std::back_inserter(effects));
        std::ranges::stable_sort(effects, {}, [](const method_effect& e) {
            return std::ranges::find(stiff_studies(), e.study, &stiff_study::name) - stiff_studies().begin();
        });
        // Write after each study, so that a crash does not lose finished ones.
        write_effects(folder, effects);
    }
    print_paragraph(
        "Rules whose verdict is not that with exact contacts, and in brackets the greatest change of a value with a "
        "closed form, in parts of it:");
    print("\n" + to_text(table_of(effects), output_width()) + "\n");
}

/// The report on what the folder stores: a whole report (earlier versions), rows of the extreme suite, or results of
/// studies. Empty if there is nothing, or the extreme suite was interrupted, as it might seem to pass.
std::optional<suite_report> stored_report(const std::filesystem::path& folder) {
    if (std::filesystem::exists(folder / "report.json")) return read_report(folder / "report.json");
    if (std::filesystem::exists(folder / "extreme.csv")) {
        const std::vector<extreme_row> rows = read_extreme_rows(folder / "extreme.csv");
        // Cases run last: if there are none, the run was interrupted.
        if (std::ranges::count(rows, row_group::cases, &extreme_row::group) == 0) return std::nullopt;
        return report_of(rows);
    }
    suite_report report;
    for (const stiff_study& study : stiff_studies())
        if (const std::optional<stiff_result> result = read_result(folder, study)) add_study(report, study, *result);
    for (const std::string& name : unknown_studies(folder)) {
        const stiff_study study{name, "a study of another version, without figures", "as its rows say",
                                /*run=*/nullptr};
        if (const std::optional<stiff_result> result = read_result(folder, study)) add_study(report, study, *result);
    }
    return report.tables.empty() ? std::nullopt : std::optional(report);
}

}  // namespace aabblab
