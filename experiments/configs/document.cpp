module;

#include "toml.hpp"

module aabblab.configs;

import :document;
import aabblab.files;

namespace aabblab {

namespace {

constexpr std::size_t most_parts = 16;  // per dotted key; a config needs two
constexpr std::size_t most_products = 100'000;

/// Copies a value of toml++ and its contents, so that only this file depends on toml++.
node to_node(const toml::node& value) {
    node result;
    result.line = static_cast<int>(value.source().begin.line);
    if (const toml::table* table = value.as_table()) {
        result.kind = node_kind::table;
        // toml++ sorts entries by key, but products of lists follow the order in the file.
        std::vector<std::pair<toml::source_position, node>> entries;
        for (const auto& [key, value_of_key] : *table) {
            node entry = to_node(value_of_key);
            entry.line = static_cast<int>(key.source().begin.line);
            entry.key = key.str();
            entries.emplace_back(key.source().begin, std::move(entry));
        }
        std::ranges::sort(entries, std::ranges::less{},
                          [](const auto& entry) { return std::pair(entry.first.line, entry.first.column); });
        for (auto& [position, entry] : entries) result.items.push_back(std::move(entry));
    } else if (const toml::array* list = value.as_array()) {
        result.kind = node_kind::list;
        for (const toml::node& item : *list) result.items.push_back(to_node(item));
    } else if (const auto* text = value.as_string()) {
        result.kind = node_kind::text;
        result.text = text->get();
    } else if (const auto* integer = value.as_integer()) {
        result.kind = node_kind::integer;
        result.text = std::to_string(integer->get());
    } else if (const auto* real = value.as_floating_point()) {
        result.kind = node_kind::real;
        result.text = aabb::shortest(real->get());
    } else if (const auto* flag = value.as_boolean()) {
        result.kind = node_kind::boolean;
        result.text = flag->get() ? "true" : "false";
    } else {
        result.kind = node_kind::date;
    }
    return result;
}

/// Drops carriage returns before line feeds: TOML allows one, but programs that convert text twice write two.
std::string without_returns_at_ends(std::string_view text) {
    std::string lines;
    for (std::size_t from = 0; from < text.size();) {
        const std::size_t end = std::min(text.find('\n', from), text.size());
        std::size_t last = end;
        while (end < text.size() && last > from && text[last - 1] == '\r') --last;
        lines += text.substr(from, last - from);
        if (end < text.size()) lines += '\n';
        from = end + 1;
    }
    return lines;
}

std::string_view name_of(node_kind kind) {
    constexpr std::array<std::string_view, 7> names = {"a name",         "a number", "a number", "true or false",
                                                       "a date or time", "a list",   "a table"};
    return names[static_cast<std::size_t>(kind)];
}

/// The first line, from 1, at which an assertion of toml++ fails, which the failure does not say: by bisection.
int line_of_failed_assertion(std::string_view text) {
    const auto fails = [&](std::size_t end) {  // the text before `end`
        try {
            (void)toml::parse(text.substr(0, end));
        } catch (const failed_toml_assertion&) {
            return true;
        } catch (const toml::parse_error&) {
            return false;
        }
        return false;
    };
    std::vector<std::size_t> ends;  // of the lines, in ascending order: if one text fails, so do longer ones
    for (std::size_t end = 0; (end = text.find('\n', end)) != std::string_view::npos;) ends.push_back(++end);
    const auto first = std::ranges::partition_point(ends, [&](std::size_t end) { return !fails(end); });
    return static_cast<int>(first - ends.begin()) + 1;
}

/// Skips up to `most` more quotes after `end`: a multi-line string may end in quotes before the closing ones.
std::size_t end_of_quotes(std::string_view text, std::size_t end, std::size_t most) {
    const std::size_t last = std::min(end + most, text.size());
    while (end < last && text[end] == text[end - 1]) ++end;
    return end;
}

/// The index of the closing quote of the TOML string that opens at `begin`, or of the end of its line or of the text.
std::size_t end_of_string(std::string_view text, std::size_t begin) {
    const std::string_view quote = text.substr(begin, 1);
    const std::string triple(3, quote[0]);
    const bool is_multi_line = text.substr(begin).starts_with(triple);
    const std::string_view closing = is_multi_line ? triple : quote;
    const std::size_t most_before_closing = is_multi_line ? 2 : 0;  // quotes of the string itself, before the closing
    for (std::size_t i = begin + closing.size(); i < text.size(); ++i) {
        if (text[i] == '\\' && quote == "\"")
            ++i;  // an escaped character does not close the string
        else if (text.substr(i).starts_with(closing))
            return end_of_quotes(text, i + closing.size(), most_before_closing) - 1;
        else if (text[i] == '\n' && !is_multi_line)
            return i - 1;
    }
    return text.size();
}

/// The line of the first dotted key with more than `most_parts` parts, or 0: toml++ recurses into each part, and would
/// overflow the stack. Strings and comments are skipped.
int line_of_deep_key(std::string_view text) {
    const auto continues_key = [](unsigned char c) {
        return std::isalnum(c) || c == '_' || c == '-' || c == ' ' || c == '\t';
    };
    std::size_t parts = 1;
    for (std::size_t i = 0; i < text.size(); ++i) {
        const char c = text[i];
        if (c == '.') {
            if (++parts > most_parts) return static_cast<int>(std::ranges::count(text.substr(0, i), '\n')) + 1;
        } else if (c == '"' || c == '\'') {
            i = end_of_string(text, i);
        } else if (c == '#') {
            i = std::min(text.find('\n', i), text.size()) - 1;
        } else if (!continues_key(static_cast<unsigned char>(c))) {
            parts = 1;
        }
    }
    return 0;
}

}  // namespace

const node* node::find(std::string_view wanted) const {
    const auto entry = std::ranges::find(items, wanted, &node::key);
    return entry == items.end() ? nullptr : &*entry;
}

/// Parses TOML. Rejects, with their line, texts that toml++ would crash on or report without a line.
document::document(const std::string& as_written, std::string file, std::size_t most, std::string_view noun)
    : file_(std::move(file)) {
    const std::string text = without_returns_at_ends(as_written);
    if (text.size() > most)
        throw aabb::input_error(file_ + " is longer than " + std::to_string(most) + " bytes, the limit for " +
                                std::string(noun));
    if (const int line = line_of_deep_key(text))
        fail(line, "a key has more than " + std::to_string(most_parts) + " parts");
    try {
        root_ = to_node(toml::parse(text, file_));
        root_.line = 1;
    } catch (const toml::parse_error& error) {
        const toml::source_position& position = error.source().begin;
        if (error.description().find("redefine existing string 'compose'") != std::string_view::npos)
            fail(static_cast<int>(position.line),
                 "compose is already a name, so it cannot be a table too; write [[compose]] with auto = true in place "
                 "of compose = \"auto\"");
        throw aabb::input_error(file_ + ":" + std::to_string(position.line) + ":" + std::to_string(position.column) +
                                ": this is not TOML: " + std::string(error.description()));
    } catch (const failed_toml_assertion&) {
        fail(line_of_failed_assertion(text), "this is not TOML");
    }
}

void document::fail(int line, const std::string& sentence) const {
    throw aabb::input_error(place(line) + ": " + sentence);
}

void document::fail_type(const std::string& key, const node& value, std::string_view expected) const {
    fail(value.line, key + " is " + std::string(name_of(value.kind)) + "; expected " + std::string(expected));
}

void document::require_keys(const node& table, const std::string& owner, const std::vector<std::string>& known) const {
    for (const node& entry : table.items)
        if (std::ranges::find(known, entry.key) == known.end())
            fail(entry.line, aabb::unknown_name("key" + owner, entry.key, known));
}

void document::require_table(const std::string& key, const node& value) const {
    if (value.kind != node_kind::table) fail_type(key, value, "a table");
}

const node& document::required(const node& table, std::string_view key, const std::string& sentence) const {
    const node* value = table.find(key);
    if (!value) fail(table.line, sentence);
    return *value;
}

std::span<const node> document::tables_of(const std::string& key) const {
    const node* list = root_.find(key);
    if (!list) return {};
    if (list->kind != node_kind::list) fail(list->line, key + " must be in double brackets: [[" + key + "]]");
    return list->items;
}

bool document::flag_of(const std::string& key, const node& value) const {
    if (value.kind != node_kind::boolean) fail_type(key, value, "true or false");
    return value.text == "true";
}

const std::string& document::text_of(const std::string& key, const node& value) const {
    if (value.kind != node_kind::text) fail_type(key, value, "a name");
    return value.text;
}

/// Reads a whole number, at least `least`. The key is its name in messages.
std::uint64_t document::integer_of(const std::string& key, const node& value, std::uint64_t least) const {
    std::uint64_t number = 0;
    const char* end = value.text.data() + value.text.size();
    const bool is_integer = value.kind == node_kind::integer &&
                            std::from_chars(value.text.data(), end, number) == std::from_chars_result{end, std::errc{}};
    if (!is_integer || number < least) {
        const std::string actual = value.kind == node_kind::text ? "the text \"" + value.text + "\""
                                   : value.is_scalar()           ? value.text
                                                                 : std::string(name_of(value.kind));
        fail(value.line, key + " must be a whole number, at least " + std::to_string(least) + ", not " + actual);
    }
    return number;
}

/// Reads a name or a list of names, as a list.
std::vector<located_text> document::texts_of(const std::string& key, const node& value) const {
    if (value.kind == node_kind::text) return {{value.text, value.line}};
    if (value.kind != node_kind::list) fail_type(key, value, "a list or a name");
    std::vector<located_text> texts;
    for (const node& item : value.items) {
        if (item.kind != node_kind::text) fail_type("an entry of " + key, item, "a name");
        texts.push_back({item.text, item.line});
    }
    return texts;
}

/// Removes { others_but = […] }, all names but those, from a list. @returns these names; nullopt without the entry
std::optional<std::vector<located_text>> document::take_others(node& list) const {
    const auto is_others = [](const node& item) { return item.find("others_but") != nullptr; };
    const auto others = std::ranges::find_if(list.items, is_others);
    if (list.kind != node_kind::list || others == list.items.end()) return std::nullopt;
    require_keys(*others, " beside others_but", {"others_but"});
    std::vector<located_text> excluded = texts_of("others_but", *others->find("others_but"));
    list.items.erase(others);
    return excluded;
}

/// The values of a key: a scalar, or a list of distinct scalars; each makes a scene or composition of its own.
std::vector<located_text> document::alternatives_of(const std::string& key, const node& value) const {
    if (value.is_scalar()) return {{value.text, value.line}};
    if (value.kind != node_kind::list) fail_type(key, value, "a value or a list of values");
    if (value.items.empty()) fail(value.line, key + " is an empty list; expected at least one value");
    unique_list<located_text> values;
    for (const node& item : value.items) {
        if (!item.is_scalar()) fail_type("an entry of " + key, item, "a value");
        if (!values.add({item.text, item.line}, item.text)) fail(item.line, key + " lists '" + item.text + "' twice");
    }
    return values.items();
}

void document::require_small_product(int line, std::string_view noun, std::span<const std::size_t> factors,
                                     std::size_t more) const {
    auto products = static_cast<double>(more);
    products += std::accumulate(factors.begin(), factors.end(), 1.0, std::multiplies{});
    if (products > static_cast<double>(most_products))
        fail(line, "the lists multiply to more than " + std::to_string(most_products) + " " + std::string(noun) +
                       ", the limit for a config");
}

std::string text_of_file(const std::filesystem::path& file, std::size_t most, std::string_view noun) {
    if (!std::filesystem::exists(file))
        throw aabb::input_error(file.string() + " does not exist; expected " + std::string(noun));
    if (std::filesystem::is_directory(file))
        throw aabb::input_error(file.string() + " is a folder; expected " + std::string(noun));
    return text_of_file(file, most);
}

std::vector<std::size_t> sizes_of(const std::vector<alternatives>& keys, std::size_t further) {
    std::vector<std::size_t> sizes{further};
    for (const auto& [key, values] : keys) sizes.push_back(values.size());
    return sizes;
}

/// Every combination of one value per key, as settings; the first key varies slowest.
std::vector<std::vector<aabb::setting>> cartesian_product(const std::vector<alternatives>& keys) {
    std::vector<std::vector<aabb::setting>> products{{}};
    for (const auto& [key, values] : keys) {
        std::vector<std::vector<aabb::setting>> extended;
        for (const std::vector<aabb::setting>& product : products)
            for (const located_text& value : values) extended.emplace_back(product).push_back({key, value.text});
        products = std::move(extended);
    }
    return products;
}

}  // namespace aabblab
