module;
#include <charconv>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <system_error>
#include <type_traits>
#include <vector>

module aabblab.errors;

import aabb.base;
import aabb.policy;
import aabblab.files;
import aabblab.results;
import aabblab.tables;

namespace aabblab {

namespace {

/// The columns in one place: calls `field(name, member)` for each.
template <class Point, class Field>
void for_each_column(Point& p, Field field) {
    field("pairs", p.pairs);
    field("precision", p.in_double);
    field("curve", p.curve);
    field("triangle", p.triangle);
    field("count", p.count);
    field("intersecting", p.intersecting);
    field("false_negatives", p.false_negatives);
    field("false_positives", p.false_positives);
    field("ns", p.ns_a_pair.median);
    field("ns_low", p.ns_a_pair.low);
    field("ns_high", p.ns_a_pair.high);
}

std::string written(const std::string& text) {
    return text;
}
std::string written(bool in_double) {
    return in_double ? "double" : "float";
}
std::string written(const aabb::strategy_choice& triangle) {
    return to_text(triangle);
}
std::string written(std::uint64_t number) {
    return std::to_string(number);
}
std::string written(double number) {
    return aabb::shortest(number);
}

bool taken(std::string& to, const std::string& text) {
    to = text;
    return true;
}
bool taken(bool& in_double, const std::string& text) {
    in_double = text == "double";
    return in_double || text == "float";
}
bool taken(aabb::strategy_choice& to, const std::string& text) {
    to = aabb::parse_strategy(text);
    return true;
}
template <class Number>
bool taken(Number& to, const std::string& text) {
    const char* end = text.data() + text.size();
    if (std::from_chars(text.data(), end, to) != std::from_chars_result{end, std::errc{}}) return false;
    // Times are drawn on a logarithmic axis.
    if constexpr (std::is_floating_point_v<Number>) return std::isfinite(to) && to > 0;
    return true;
}

std::vector<column> columns() {
    std::vector<column> all;
    error_point any;
    for_each_column(any, [&]<class Value>(const char* name, const Value&) {
        all.push_back({name, std::is_same_v<Value, double> || std::is_same_v<Value, std::uint64_t>});
    });
    return all;
}

}  // namespace

table error_rows(std::span<const error_point> points) {
    table t{columns(), {}};
    for (const error_point& p : points) {
        std::vector<std::string>& cells = t.rows.emplace_back();
        for_each_column(p, [&](const char*, const auto& value) { cells.push_back(written(value)); });
    }
    return t;
}

std::vector<error_point> read_error_rows(const std::filesystem::path& file) {
    const std::vector<csv_record> records = whole_records_of(text_of_file(file), file.string());
    std::vector<std::string> header;
    for (const column& c : columns()) header.push_back(c.name);
    if (records.empty() || records[0].fields != header)
        throw aabb::input_error(file.string() + ":1: these are not the columns of this version");
    std::vector<error_point> points;
    for (const auto& [fields, line] : std::span(records).subspan(1)) {
        const std::string place = file.string() + ":" + std::to_string(line) + ": ";
        if (fields.size() != header.size())
            throw aabb::input_error(place + "expected " + std::to_string(header.size()) + " fields, not " +
                                    std::to_string(fields.size()));
        std::size_t at = 0;
        for_each_column(points.emplace_back(), [&](const char* name, auto& value) {
            if (!taken(value, fields[at])) throw aabb::input_error(place + name + " cannot be '" + fields[at] + "'");
            ++at;
        });
    }
    return points;
}

}  // namespace aabblab
