#include <cstddef>
#include <filesystem>
#include <limits>
#include <nlohmann/json.hpp>
#include <string>
#include <utility>
#include <vector>

#include "suite_report.hpp"

import aabb.base;
import aabblab.figures;
import aabblab.files;
import aabblab.tables;

namespace aabblab {

namespace {

using nlohmann::json;

json json_of(const figure_axis& axis) {
    return {{"label", axis.label}, {"logarithmic", axis.logarithmic}, {"names", axis.names}};
}

figure_axis axis_of(const json& j) {
    return {j.at("label"), j.at("logarithmic"), j.at("names").get<std::vector<std::pair<double, std::string>>>()};
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
double number_of(const json& j) {
    return j.is_null() ? std::numeric_limits<double>::quiet_NaN() : j.get<double>();
}

std::vector<series> series_of(const json& j) {
    std::vector<series> all;
    for (const json& line : j) {
        series s{line.at("label"), static_cast<series_style>(line.at("style").get<int>()), {}};
        for (const json& p : line.at("points"))
            s.points.push_back({number_of(p.at(0)), number_of(p.at(1)), number_of(p.at(2)), number_of(p.at(3))});
        all.push_back(std::move(s));
    }
    return all;
}

std::vector<figure_mark> marks_of(const json& j) {
    std::vector<figure_mark> all;
    for (const json& m : j) all.push_back({m.at("x"), m.at("label")});
    return all;
}

figure figure_of(const json& j) {
    figure f{j.at("name"),       j.at("caption"),          axis_of(j.at("x")),
             axis_of(j.at("y")), series_of(j.at("lines")), marks_of(j.at("marks"))};
    for (const json& p : j.value("panels", json::array()))
        f.panels.push_back({p.at("title"), series_of(p.at("lines")), marks_of(p.at("marks"))});
    return f;
}

json json_of(const captioned_table& t) {
    json columns = json::array();
    for (const column& c : t.content.columns) columns.push_back({{"name", c.name}, {"is_number", c.is_number}});
    return {{"name", t.name}, {"caption", t.caption}, {"columns", std::move(columns)}, {"rows", t.content.rows}};
}

captioned_table table_of(const json& j) {
    captioned_table t{j.at("name"), j.at("caption"), {}};
    for (const json& c : j.at("columns")) t.content.columns.push_back({c.at("name"), c.at("is_number")});
    t.content.rows = j.at("rows").get<std::vector<std::vector<std::string>>>();
    return t;
}

}  // namespace

void keep_report(const std::filesystem::path& file, const suite_report& report) {
    json figures = json::array();
    for (const figure& f : report.figures) figures.push_back(json_of(f));
    json tables = json::array();
    for (const captioned_table& t : report.tables) tables.push_back(json_of(t));
    const json all = {{"paragraphs", report.paragraphs},
                      {"figures", std::move(figures)},
                      {"tables", std::move(tables)},
                      {"failures", report.failures}};
    write_file(file, all.dump(1) + "\n");
}

suite_report kept_report(const std::filesystem::path& file) {
    try {
        const json all = json::parse(bytes_of_file(file));
        suite_report report;
        report.paragraphs = all.at("paragraphs").get<std::vector<std::string>>();
        report.failures = all.at("failures").get<std::vector<std::string>>();
        for (const json& f : all.at("figures")) report.figures.push_back(figure_of(f));
        for (const json& t : all.at("tables")) report.tables.push_back(table_of(t));
        return report;
    } catch (const json::exception&) {
        throw aabb::input_error(file.string() + " is not the report of a suite of validate; play the suite again");
    }
}

}  // namespace aabblab
