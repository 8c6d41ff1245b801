module;

#include "../../experiments/configs/toml.hpp"
#include "endpoints_toml.hpp"

module aabblab.claims;

import aabb.base;

namespace aabblab {

namespace {

[[noreturn]] void fail(const toml::node& node, const std::string& sentence) {
    throw aabb::input_error("paper/claims/endpoints.toml:" + std::to_string(node.source().begin.line) + ": " +
                            sentence);
}

/// The value of a key, which must be there and have this type.
template <class Type>
decltype(auto) needed(const toml::table& table, std::string_view key) {
    const auto* value = table[key].as<Type>();
    if (!value) fail(table, "expected " + std::string(key));
    return *value;
}

std::string text_of_key(const toml::table& table, std::string_view key) {
    return needed<std::string>(table, key).get();
}

expectation expectation_in(const toml::table& table) {
    const std::string text = text_of_key(table, "expects");
    if (text != "less" && text != "not more") fail(table, "expected expects = \"less\" or \"not more\"");
    return text == "less" ? expectation::less : expectation::not_more;
}

/// A factor of a table, with all the values that it lists.
struct listed_factor {
    std::uint32_t column;  ///< in the file
    std::string name;
    std::vector<std::string> values;
};

/// The factors of a table in the order of the file; toml++ sorts them by name.
std::vector<listed_factor> factors_in(const toml::table& table) {
    std::vector<listed_factor> listed;
    for (const auto& [key, value] : table) {
        listed_factor& factor = listed.emplace_back(
            listed_factor{key.source().begin.column, std::string(key.str()), std::vector<std::string>()});
        if (const auto* list = value.as_array())
            for (const toml::node& item : *list) factor.values.push_back(item.value_or(std::string()));
        else
            factor.values.push_back(value.value_or(std::string()));
    }
    std::ranges::sort(listed, {}, &listed_factor::column);
    return listed;
}

/// The conditions that a table of factors names: lists multiply out.
std::vector<factors> products_of(const toml::table& table) {
    std::vector<factors> products{{}};
    for (const listed_factor& factor : factors_in(table)) {
        std::vector<factors> longer;
        for (const factors& begun : products)
            for (const std::string& value : factor.values) {
                longer.push_back(begun);
                longer.back().emplace_back(factor.name, value);
            }
        products = std::move(longer);
    }
    return products;
}

/// The text with {names} replaced by the values of factors, or of arms.
std::string filled_in(std::string text, const factors& where, const toml::table& arms) {
    for (std::size_t open = 0; (open = text.find('{', open)) != std::string::npos;) {
        const std::size_t close = text.find('}', open);
        const std::string name = text.substr(open + 1, close - open - 1);
        const auto factor = std::ranges::find(where, name, &factors::value_type::first);
        const std::string value = factor != where.end() ? factor->second : text_of_key(arms, name);
        text.replace(open, close - open + 1, value);
    }
    return text;
}

/// The ratios of a list, `primary` or `earlier`; none without it.
std::vector<stated_ratio> ratios_in(const toml::table& claim, std::string_view list, const toml::table& arms) {
    std::vector<stated_ratio> ratios;
    if (!claim.contains(list)) return ratios;
    for (const toml::node& node : needed<toml::array>(claim, list)) {
        const toml::table& entry = *node.as_table();
        for (const toml::node& where : needed<toml::array>(entry, "where"))
            for (const factors& condition : products_of(*where.as_table()))
                ratios.push_back({condition, filled_in(text_of_key(entry, "ratio"), condition, arms),
                                  expectation_in(entry.contains("expects") ? entry : claim)});
    }
    return ratios;
}

std::vector<std::uint64_t> seeds_in(const toml::table& seeds, std::string_view key) {
    std::vector<std::uint64_t> list;
    for (const toml::node& seed : needed<toml::array>(seeds, key))
        list.push_back(static_cast<std::uint64_t>(seed.value_or(std::int64_t{0})));
    return list;
}

stated_claim claim_in(const toml::table& table, const toml::table& arms) {
    const std::string rule = text_of_key(table, "verdict");
    if (rule != "every" && rule != "cases") fail(table, "expected verdict = \"every\" or \"cases\"");
    stated_claim claim{.id = text_of_key(table, "id"),
                       .of = table["of"].value_or(std::string("paper")),
                       .claim = text_of_key(table, "claim"),
                       .quote = text_of_key(table, "quote"),
                       .regime = text_of_key(table, "regime"),
                       .measured = text_of_key(table, "measured"),
                       .expected = expectation_in(table),
                       .rule = rule == "every" ? verdict_rule::every : verdict_rule::cases,
                       .primary = ratios_in(table, "primary", arms),
                       .earlier = ratios_in(table, "earlier", arms)};
    if (claim.rule == verdict_rule::cases) claim.left_open = text_of_key(table, "left_open");
    return claim;
}

stated_analysis parse_endpoints() {
    const toml::table file = toml::parse(embedded::endpoints_toml);
    const auto& rule = needed<toml::table>(file, "rule");
    const auto& seeds = needed<toml::table>(file, "seeds");
    stated_analysis analysis{.margin = needed<double>(rule, "margin").get(),
                             .level = needed<double>(rule, "level").get(),
                             .seeds = seeds_in(seeds, "now"),
                             .earlier_seeds = seeds_in(seeds, "earlier")};
    for (const toml::node& claim : needed<toml::array>(file, "claim"))
        analysis.claims.push_back(claim_in(*claim.as_table(), needed<toml::table>(file, "arms")));
    return analysis;
}

}  // namespace

std::string_view stated_text() {
    return embedded::endpoints_toml;
}

/// What decides every claim, fixed before the measurements: endpoints.toml, which is embedded in the program.
const stated_analysis& stated() {
    static const stated_analysis analysis = parse_endpoints();
    return analysis;
}

}  // namespace aabblab
