module;
#include <nlohmann/json.hpp>

module aabblab.suites;

import aabb.base;
import aabblab.files;
import aabblab.json;

namespace aabblab {

namespace {

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
