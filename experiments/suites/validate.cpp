module;
#include <nlohmann/json.hpp>

module aabblab.suites;

import aabb.extreme;
import aabb.policy;
import aabblab.extreme;
import aabblab.files;
import aabblab.fmt;
import aabblab.json;
import aabblab.numbers;
import aabblab.output;
import aabblab.progress;
import aabblab.stepping;
import aabblab.stiff;

namespace aabblab {

namespace {

/// The tables that are told, with what stands above them.
std::vector<named_table> tables_of(const std::vector<extreme_row>& rows) {
    std::vector<named_table> all = {
        {"extreme_boxes", "Boxes: by the definition, in a double loop", scene_table(rows, row_group::boxes)},
        {"extreme_meshes", "Meshes: by CGAL's exact kernel on every two triangles; -missing +invented",
         scene_table(rows, row_group::meshes)},
        {"extreme_tests", "Meshes, by inexact triangle tests", inexact_scene_table(rows)},
        {"extreme_classes", "The same by class", class_table(rows)},
        {"extreme_cases", "Pairs of triangles that were found hard, by exact tests and as two meshes",
         case_table(rows)},
        {"extreme_case_tests", "The same by inexact triangle tests, in every order of corners, float and double",
         inexact_case_table(rows)}};
    std::erase_if(all, [](const named_table& t) { return t.content.rows.empty(); });
    return all;
}

std::string verdict_of(const stiff_row& r) {
    if (r.rule.empty()) return "";
    return r.holds ? "holds" : "FAILS";
}

/// A table for each quantity.
std::vector<named_table> tables_of(const stiff_study& study, const stiff_result& result) {
    std::vector<named_table> all;
    for (const stiff_row& r : result.rows) {
        const std::string caption = fmt::format("{}: {}", study.name, r.quantity);
        auto found = std::ranges::find(all, caption, &named_table::caption);
        if (found == all.end()) {
            const std::string name = fmt::format("{}_{}", study.name, all.size() + 1);
            all.push_back({name, caption, {{{r.quantity, false}, {"measured"}, {"expected", false}, {"", false}}, {}}});
            found = all.end() - 1;
        }
        found->content.rows.push_back({r.subject, fmt::format("{:.4g}", r.measured), r.rule, verdict_of(r)});
    }
    return all;
}

/// Those of these names, all where none is given.
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

using nlohmann::json;

json json_of(const figure_axis& axis) {
    return {{"label", axis.label}, {"logarithmic", axis.logarithmic}, {"names", axis.names}};
}

figure_axis axis_of(const json_value& j) {
    figure_axis axis{j.needed("label").text(), j.needed("logarithmic").flag(), {}};
    for (const json_value& name : j.needed("names").list()) {
        const std::vector<json_value> pair = name.list();
        if (pair.size() != 2) name.fail("must be a number and its name");
        axis.names.emplace_back(pair[0].number(), pair[1].text());
    }
    return axis;
}

json json_of(const std::vector<series>& all) {
    json lines = json::array();
    for (const series& s : all) {
        json points = json::array();
        for (const figure_point& p : s.points) points.push_back({p.x, p.y, p.low, p.high});
        lines.push_back({{"label", s.label}, {"style", static_cast<int>(s.style)}, {"points", std::move(points)}});
    }
    return lines;
}

json json_of(const std::vector<figure_mark>& all) {
    json marks = json::array();
    for (const figure_mark& m : all) marks.push_back({{"x", m.x}, {"label", m.label}});
    return marks;
}

json json_of(const figure& f) {
    json panels = json::array();
    for (const figure_panel& p : f.panels)
        panels.push_back({{"title", p.title}, {"lines", json_of(p.lines)}, {"marks", json_of(p.marks)}});
    return {{"name", f.name},    {"caption", f.caption},      {"x", json_of(f.x)},
            {"y", json_of(f.y)}, {"lines", json_of(f.lines)}, {"marks", json_of(f.marks)},
            {"panels", panels}};
}

/// A number that is none, as a trajectory's that ends beyond all, is null in JSON; figures leave it out.
double number_of(const json_value& j) {
    return j.is_null() ? std::numeric_limits<double>::quiet_NaN() : j.number();
}

std::vector<series> series_of(const json_value& in) {
    std::vector<series> all;
    for (const json_value& line : in.needed("lines").list()) {
        const json_value style = line.needed("style");
        if (style.index() > static_cast<std::size_t>(series_style::level)) style.fail("is not a style of lines");
        series s{line.needed("label").text(), static_cast<series_style>(style.index()), {}};
        for (const json_value& p : line.needed("points").list()) {
            const std::vector<json_value> numbers = p.list();
            if (numbers.size() != 4) p.fail("must be four numbers");
            s.points.push_back(
                {number_of(numbers[0]), number_of(numbers[1]), number_of(numbers[2]), number_of(numbers[3])});
        }
        all.push_back(std::move(s));
    }
    return all;
}

std::vector<figure_mark> marks_of(const json_value& in) {
    std::vector<figure_mark> all;
    for (const json_value& m : in.needed("marks").list())
        all.push_back({m.needed("x").number(), m.needed("label").text()});
    return all;
}

figure figure_of(const json_value& j) {
    figure f{j.needed("name").text(),
             j.needed("caption").text(),
             axis_of(j.needed("x")),
             axis_of(j.needed("y")),
             series_of(j),
             marks_of(j)};
    for (const json_value& p : j.objects("panels"))
        f.panels.push_back({p.needed("title").text(), series_of(p), marks_of(p)});
    return f;
}

json json_of(const named_table& t) {
    json columns = json::array();
    for (const column& c : t.content.columns) columns.push_back({{"name", c.name}, {"is_number", c.is_number}});
    return {{"name", t.name}, {"caption", t.caption}, {"columns", std::move(columns)}, {"rows", t.content.rows}};
}

named_table table_of(const json_value& j) {
    named_table t{j.needed("name").text(), j.needed("caption").text(), {}};
    for (const json_value& c : j.needed("columns").list())
        t.content.columns.push_back({c.needed("name").text(), c.needed("is_number").flag()});
    for (const json_value& row : j.needed("rows").list()) {
        std::vector<std::string>& fields = t.content.rows.emplace_back();
        for (const json_value& field : row.list()) fields.push_back(field.text());
        if (fields.size() != t.content.columns.size()) row.fail("must have a field for each column");
    }
    return t;
}

}  // namespace

std::string usual_cases() {
    return AABBLAB_CASES;
}

suite_report play_extreme_suite(const std::filesystem::path& folder, const std::string& cases, bool quick, bool shown) {
    const auto size = quick ? aabb::extreme_size::quick : aabb::extreme_size::full;
    const std::vector<aabb::triangle_case> hard = read_triangle_cases(cases);
    std::filesystem::create_directories(folder);  // before the work, which takes a while
    const extreme_list list = all_extreme_scenes(size);
    for (const std::string& sentence : list.notes) note(sentence);
    std::vector<extreme_row> rows = play_scenes(list.scenes, size);
    // What is finished stays, whatever happens afterwards.
    write_file(folder / "extreme.csv", csv_of(rows));
    for (extreme_row& row : play_cases(hard)) rows.push_back(std::move(row));
    suite_report report;
    report.tables = tables_of(rows);
    report.paragraphs = memory_in(rows);
    report.failures = failures_in(rows);
    write_file(folder / "extreme.csv", csv_of(rows));
    if (shown) {
        for (const named_table& t : report.tables)
            print(t.caption + "\n\n" + to_text(t.content, output_width()) + "\n");
        for (const std::string& sentence : report.paragraphs) print(sentence + "\n");
        print("\nRefused:\n");
        for (const std::string& sentence : refusals_in(rows)) print("  " + sentence + "\n");
    }
    for (const std::string& sentence : report.failures) note(sentence);
    return report;
}

suite_report play_stiff_suite(const std::filesystem::path& folder, const std::vector<std::string>& studies, bool quick,
                              bool shown) {
    const std::vector<stiff_study> chosen = chosen_studies(studies);
    std::filesystem::create_directories(folder);
    for (const std::string_view name : left_out_integrators())
        note("the integrator " + std::string(name) +
             " is left out of this build: its library was not found; ./aabblab validate stiff installs it");
    suite_report report;
    for (const stiff_study& study : chosen) {
        stiff_result result;
        {
            progress done("playing " + std::string(study.name), 1000);
            result = study.play(
                {quick, usual_contender(), [&](double share) { done.at(static_cast<std::size_t>(1000 * share)); }});
        }
        report.paragraphs.push_back(fmt::format("{}: {}. Expected: {}.", study.name, study.about, study.reference));
        const std::vector<named_table> tables = tables_of(study, result);
        if (shown) {
            print(wrapped(report.paragraphs.back()) + "\n\n");
            for (const named_table& t : tables) print(to_text(t.content, output_width()) + "\n");
            flush_output();
        }
        table rows = empty_table({"subject", "quantity"}, {"measured"}, {"expected", "verdict"});
        for (const stiff_row& r : result.rows) {
            rows.rows.push_back({r.subject, r.quantity, fifteen_digits(r.measured), r.rule, verdict_of(r)});
            if (!r.holds)
                report.failures.push_back(
                    fmt::format("{}: {}: {} is {:.4g}, not {}", study.name, r.subject, r.quantity, r.measured, r.rule));
        }
        // What is finished stays, whatever happens afterwards; other studies' files do too.
        write_file(folder / (std::string(study.name) + ".csv"), to_csv(rows));
        draw(folder / "figures", result.figures);
        std::ranges::copy(tables, std::back_inserter(report.tables));
        std::ranges::copy(result.figures, std::back_inserter(report.figures));
    }
    for (const std::string& sentence : report.failures) note(sentence);
    return report;
}

void keep_report(const std::filesystem::path& file, const suite_report& report) {
    json figures = json::array();
    for (const figure& f : report.figures) figures.push_back(json_of(f));
    json tables = json::array();
    for (const named_table& t : report.tables) tables.push_back(json_of(t));
    const json all = {{"paragraphs", report.paragraphs},
                      {"figures", std::move(figures)},
                      {"tables", std::move(tables)},
                      {"failures", report.failures}};
    write_file(file, all.dump(1) + "\n");
}

suite_report kept_report(const std::filesystem::path& file) {
    const json_value all(file.string(), text_of_file(file), "is not the report of a suite of validate");
    suite_report report;
    report.paragraphs = all.needed("paragraphs").texts();
    report.failures = all.needed("failures").texts();
    for (const json_value& f : all.needed("figures").list()) report.figures.push_back(figure_of(f));
    for (const json_value& t : all.needed("tables").list()) report.tables.push_back(table_of(t));
    return report;
}

}  // namespace aabblab
