module;
#include <nlohmann/json.hpp>

module aabblab.json;

import aabb.base;

namespace aabblab {

using nlohmann::json;

struct json_value::document {
    std::string file;
    json content;
};

namespace {

/// The nesting limit of lists and objects, since visitors recurse. Valid inputs stay far below it.
constexpr int most_nested = 64;

/// Whether brackets outside strings are nested deeper than `most_nested`, so that a parser would need much memory or
/// stack. Works on malformed JSON, too.
bool is_nested_too_deeply(std::string_view text) {
    int depth = 0;
    bool in_string = false;
    for (std::size_t i = 0; i < text.size(); ++i) {
        const char c = text[i];
        if (in_string && c == '\\')
            ++i;
        else if (c == '"')
            in_string = !in_string;
        else if (!in_string && (c == '[' || c == '{') && ++depth > most_nested)
            return true;
        else if (!in_string && (c == ']' || c == '}'))
            --depth;
    }
    return false;
}

/// Parses untrusted JSON, which may be malformed in any way.
/// @param message what a file with a syntax error is not: "is not a manifest of results"
/// @param where whether messages locate the error by its line, or by its byte as in formats without lines
json parse(const std::string& file, std::string_view text, const std::string& message, json_value::position where) {
    const auto reject = [&](const std::string& place, const std::string& why) {
        throw aabb::input_error(file + place + ": " + message + why);
    };
    // Checked up front, because a parser callback would visit every list again for each of its items.
    if (is_nested_too_deeply(text))
        reject("", ": its JSON is nested more than " + std::to_string(most_nested) + " deep");
    try {
        return json::parse(text);
    } catch (const json::parse_error& error) {
        const std::size_t read = std::min(error.byte, text.size());
        if (where == json_value::position::byte) reject("", ": its JSON is malformed at byte " + std::to_string(read));
        const auto line = 1 + std::ranges::count(text.substr(0, read), '\n');
        reject(":" + std::to_string(line), ": its JSON is malformed");
    } catch (const json::out_of_range&) {
        reject("", ": a number in it does not fit a double");
    }
    return {};
}

const json& content_at(const void* content) {
    return *static_cast<const json*>(content);
}

}  // namespace

json_value::json_value(std::string file, std::string_view text, const std::string& message, position where) {
    json content = parse(file, text, message, where);
    in_ = std::make_unique<document>(document{std::move(file), std::move(content)});
    content_ = &in_->content;
}

json_value::json_value(std::shared_ptr<const document> in, const void* content, std::string place)
    : in_(std::move(in)), content_(content), place_(std::move(place)) {}

void json_value::fail(const std::string& sentence) const {
    throw aabb::input_error(in_->file + ": " + (place_.empty() ? "the file" : place_) + " " + sentence);
}

void json_value::require(bool holds, const std::string& expected) const {
    if (!holds) fail("must be " + expected);
}

std::string json_value::text() const {
    require(content_at(content_).is_string(), "a string");
    return content_at(content_).get<std::string>();
}

double json_value::number() const {
    require(content_at(content_).is_number(), "a number");
    return content_at(content_).get<double>();
}

std::size_t json_value::index() const {
    require(content_at(content_).is_number_unsigned(), "a whole number");
    return content_at(content_).get<std::size_t>();
}

bool json_value::flag() const {
    require(content_at(content_).is_boolean(), "true or false");
    return content_at(content_).get<bool>();
}

bool json_value::is_null() const {
    return content_at(content_).is_null();
}

std::vector<json_value> json_value::list() const {
    require(content_at(content_).is_array(), "a list");
    std::vector<json_value> items;
    for (const json& item : content_at(content_))
        items.push_back(json_value(in_, &item, place_ + "[" + std::to_string(items.size()) + "]"));
    return items;
}

std::vector<std::string> json_value::texts() const {
    std::vector<std::string> texts;
    for (const json_value& item : list()) texts.push_back(item.text());
    return texts;
}

bool json_value::has(const std::string& key) const {
    require(content_at(content_).is_object(), "an object");
    return content_at(content_).contains(key);
}

json_value json_value::needed(const std::string& key) const {
    std::optional<json_value> value = member(key);
    if (!value) throw aabb::input_error(in_->file + ": " + (place_.empty() ? "" : place_ + ".") + key + " is missing");
    return *std::move(value);
}

std::optional<json_value> json_value::member(const std::string& key) const {
    if (!has(key)) return {};
    return json_value(in_, &content_at(content_).at(key), place_.empty() ? key : place_ + "." + key);
}

std::vector<json_value> json_value::objects(const std::string& key) const {
    const std::optional<json_value> value = member(key);
    if (!value) return {};
    std::vector<json_value> items = value->list();
    for (const json_value& item : items) item.require(content_at(item.content_).is_object(), "an object");
    return items;
}

std::vector<std::string> json_value::texts(const std::string& key) const {
    const std::optional<json_value> value = member(key);
    return value ? value->texts() : std::vector<std::string>();
}

/// The member of this name, which must be a list of whole numbers; empty if there is none.
std::vector<std::size_t> json_value::indices(const std::string& key) const {
    const std::optional<json_value> value = member(key);
    if (!value) return {};
    const json& content = content_at(value->content_);
    value->require(content.is_array() && std::ranges::all_of(content, &json::is_number_unsigned),
                   "a list of whole numbers");
    return content.get<std::vector<std::size_t>>();
}

std::optional<std::vector<double>> json_value::numbers(const std::string& key) const {
    const std::optional<json_value> value = member(key);
    if (!value) return {};
    const json& content = content_at(value->content_);
    value->require(content.is_array() && std::ranges::all_of(content, &json::is_number), "a list of numbers");
    return content.get<std::vector<double>>();
}

void json_value::read_numbers(double* to, std::size_t count) const {
    const json& content = content_at(content_);
    require(content.is_array() && content.size() == count && std::ranges::all_of(content, &json::is_number),
            "a list of " + std::to_string(count) + " numbers");
    for (std::size_t i = 0; i < count; ++i) to[i] = content[i].get<double>();
}

}  // namespace aabblab
