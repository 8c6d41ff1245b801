module;
#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

module aabblab.results;

import :csv;
import aabb.base;
import aabb.counters;
import aabb.registry;
import aabblab.files;
import aabblab.scenes;

namespace aabblab {

namespace {

/// The columns of a table in one place: calls `field(name, member)` for each.
template <class Name, class Field>
void for_each_name(Name& name, Field field) {
    for (const aabb::strategy_kind kind : aabb::strategy_kinds) field(std::string(name_of(kind)), name[kind]);
    field("engine", name.engine);
}

/// A scene without kind and seed, which have columns of their own.
template <class Scene>
struct parameters_of {
    Scene& scene;
};

template <class Scene, class Field>
void for_each_column_of_scene(Scene& scene, Field field) {
    field("scene", scene.kind);
    field("scene_parameters", parameters_of<Scene>{scene});
    field("seed", scene.seed);
}

template <class Row, class Field>
void for_each_key(Row& r, Field field) {
    field("experiment", r.experiment);
    for_each_column_of_scene(r.scene, field);
    field("objects", r.objects);
    field("frames", r.frames);
    for_each_name(r.name, field);
    field("repeat", r.repeat);
}

template <class Row, class Field>
void for_each_column(Row& r, Field field) {
    for_each_key(r, field);
    field("process", r.process);
    field("triangles", r.triangles);
    field("build_ms", r.build_ms);
    field("first_ms", r.first_ms);
    field("update_ms", r.update_ms);
    field("search_ms", r.search_ms);
    field("detect_ms", r.detect_ms);
    field("build_cpu_ms", r.build_cpu_ms);
    field("first_cpu_ms", r.first_cpu_ms);
    field("update_cpu_ms", r.update_cpu_ms);
    field("search_cpu_ms", r.search_cpu_ms);
    field("detect_cpu_ms", r.detect_cpu_ms);
    field("candidates", r.candidates);
    field("contacts", r.contacts);
    field("digest", r.digest);
    for (std::size_t i = 0; i < r.counts.size(); ++i) field(std::string(aabb::work_names[i]), r.counts[i]);
    for (std::size_t i = 0; i < r.bytes.size(); ++i) field("bytes_" + std::string(byte_columns[i]), r.bytes[i]);
    field("missing", r.missing);
    field("invented", r.invented);
    field("box_inflation", r.box_inflation);
    field("status", r.status);
}

template <class Difference, class Field>
void for_each_column_of_difference(Difference& d, Field field) {
    for_each_column_of_scene(d.scene, field);
    for_each_name(d.name, field);
    field("what", d.what);
    field("class", d.kind);
    field("count", d.count);
}

std::string written(const std::string& text) {
    return text;
}
std::string written(std::uint64_t number) {
    return std::to_string(number);
}
std::string written(double number) {
    std::array<char, 64> text{};
    const auto end = std::to_chars(text.data(), text.data() + text.size(), number, std::chars_format::fixed, 6).ptr;
    return {text.data(), end};
}
template <class Scene>
std::string written(const parameters_of<Scene>& parameters) {
    return parameters_json(parameters.scene);
}
template <class T>
std::string written(const std::optional<T>& value) {
    return value ? written(*value) : "";
}

bool taken(std::string& to, const std::string& text) {
    to = text;
    return true;
}
template <class Number>
bool taken(Number& to, const std::string& text) {
    const char* end = text.data() + text.size();
    if (std::from_chars(text.data(), end, to) != std::from_chars_result{end, std::errc{}}) return false;
    if constexpr (std::is_floating_point_v<Number>) return std::isfinite(to);
    return true;
}
bool taken(parameters_of<scene_choice>& to, const std::string& text) {
    return set_parameters(to.scene, text);
}
template <class T>
bool taken(std::optional<T>& to, const std::string& text) {
    to.reset();
    return text.empty() || taken(to.emplace(), text);
}

std::string expected_of(const parameters_of<scene_choice>&) {
    return "a JSON object of settings";
}
template <class T>
std::string expected_of(const T&) {
    return "a number";
}

template <class T>
bool is_negative(const T&) {
    return false;
}
bool is_negative(const std::optional<double>& number) {
    return number.value_or(0) < 0;
}

constexpr auto columns_of_row = [](auto& r, auto field) { for_each_column(r, field); };
constexpr auto columns_of_difference = [](auto& d, auto field) { for_each_column_of_difference(d, field); };

/// What is quoted of a field that may be of any length.
constexpr std::size_t longest_quote = 60;

/// Columns that results of earlier versions do not have.
constexpr std::array<std::string_view, 1> later_columns{"restarts"};

template <class Row, class Columns>
std::vector<std::string> names_of(Columns columns, const std::vector<std::string>& without = {}) {
    std::vector<std::string> names;
    Row any;
    columns(any, [&](const std::string& name, const auto&) {
        if (std::ranges::find(without, name) == without.end()) names.push_back(name);
    });
    return names;
}

/// "column 3 is 'x'; expected 'seed'"
std::string first_difference(const std::vector<std::string>& names, const std::vector<std::string>& expected) {
    const auto [is, should_be] = std::ranges::mismatch(names, expected);
    return "column " + std::to_string(is - names.begin() + 1) +
           (is == names.end() ? " is missing" : " is '" + is->substr(0, longest_quote) + "'") + "; expected " +
           (should_be == expected.end() ? "no more" : "'" + *should_be + "'");
}

template <class Row, class Columns>
std::string line_of(const Row& r, Columns columns) {
    std::vector<std::string> fields;
    columns(r, [&](const std::string&, const auto& value) { fields.push_back(written(value)); });
    return csv_line(fields);
}

/// @param taken_in sees each row and the line that it begins in
template <class Row, class Columns, class TakenIn>
std::vector<Row> read_table(const std::filesystem::path& file, Columns columns, TakenIn taken_in) {
    const std::string text = text_of_file(file);
    const std::vector<csv_record> records = read_csv(text, file.string()).records;
    std::vector<Row> rows;
    if (records.empty()) return rows;
    std::vector<std::string> absent(later_columns.begin(), later_columns.end());
    std::erase_if(absent, [&](const std::string& name) {
        return std::ranges::find(records[0].fields, name) != records[0].fields.end();
    });
    const std::vector<std::string> header = names_of<Row>(columns, absent);
    if (csv_line(records[0].fields) != csv_line(header))
        throw aabb::input_error(file.string() + ":1: these are not the columns of this version; " +
                                first_difference(records[0].fields, header));
    for (const auto& [fields, line] : std::span(records).subspan(1)) {
        const std::string place = file.string() + ":" + std::to_string(line) + ": ";
        std::size_t at = 0;
        columns(rows.emplace_back(), [&](const std::string& name, auto&& value) {
            if (std::ranges::find(absent, name) != absent.end()) return;
            if (at >= fields.size()) throw aabb::input_error(place + "the column " + name + " is missing");
            if (!taken(value, fields[at]))
                throw aabb::input_error(place + name + " must be " + expected_of(value) + ", not '" + fields[at] + "'");
            if (name.ends_with("_ms") && is_negative(value))
                throw aabb::input_error(place + name + " is a time, which is not below 0, as '" + fields[at] + "' is");
            ++at;
        });
        if (at != fields.size()) throw aabb::input_error(place + "there are more fields than columns");
        taken_in(rows.back(), line);
    }
    return rows;
}

}  // namespace

std::string row::key() const {
    std::vector<std::string> fields;
    for_each_key(*this, [&](const std::string&, const auto& value) { fields.push_back(written(value)); });
    return csv_line(fields);
}

std::string csv_header_of_rows() {
    return csv_line(names_of<row>(columns_of_row));
}
std::string csv_of(const row& r) {
    return line_of(r, columns_of_row);
}
std::string csv_of(std::span<const difference> differences) {
    std::string text = csv_line(names_of<difference>(columns_of_difference));
    for (const difference& d : differences) text += line_of(d, columns_of_difference);
    return text;
}

std::vector<row> read_rows(const std::filesystem::path& file) {
    return read_rows(file, [](const row&, std::size_t) {});
}
std::vector<row> read_rows(const std::filesystem::path& file,
                           const std::function<void(const row&, std::size_t)>& seen) {
    std::map<std::string, std::size_t> lines;  // by key
    return read_table<row>(file, columns_of_row, [&](const row& r, std::size_t line) {
        const std::string place = file.string() + ":" + std::to_string(line) + ": ";
        if (r.status != "exact" && r.status != "inexact")
            throw aabb::input_error(place + "the status is '" + r.status + "'; expected exact or inexact");
        if (const auto [before, is_new] = lines.emplace(r.key(), line); !is_new)
            throw aabb::input_error(place + "the measurement of line " + std::to_string(before->second) +
                                    " stands here again, so two runs have written into one folder");
        seen(r, line);
    });
}
std::vector<difference> read_differences(const std::filesystem::path& file) {
    return read_table<difference>(file, columns_of_difference, [](const difference&, std::size_t) {});
}

}  // namespace aabblab
