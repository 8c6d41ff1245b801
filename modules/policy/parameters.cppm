module;
#include <cassert>

export module aabb.policy:parameters;

import aabb.base;
import aabb.std;

export namespace aabb {

/// Integers in [least, most].
struct integer_values {
    std::uint64_t least = 0;
    std::uint64_t most = 0;
    bool or_auto = false;
};
/// Numbers in (above, at_most], or with `or_equal` in [above, at_most].
struct number_values {
    double above = 0;
    double at_most = std::numeric_limits<double>::max();
    bool or_equal = false;
    bool or_auto = false;
};
/// One of several names.
struct name_values {
    std::vector<std::string> names;
};
/// Any text that is not empty.
struct text_values {
    std::string what;  ///< completes "must be …"
};
using parameter_values = std::variant<integer_values, number_values, name_values, text_values>;

/// The valid values in words that complete "must be …": "a whole number from 1 to 8 or auto", "one of x, y".
[[nodiscard]] inline std::string to_text(const parameter_values& values) {
    if (const auto* integers = std::get_if<integer_values>(&values))
        return "a whole number from " + std::to_string(integers->least) + " to " + std::to_string(integers->most) +
               (integers->or_auto ? " or auto" : "");
    if (const auto* number = std::get_if<number_values>(&values)) {
        std::string text = (number->or_equal ? "a number of at least " : "a number above ") + shortest(number->above);
        if (number->at_most < std::numeric_limits<double>::max()) text += " and at most " + shortest(number->at_most);
        return text + (number->or_auto ? " or auto" : "");
    }
    if (const auto* names = std::get_if<name_values>(&values)) {
        std::string text;
        for (const std::string& name : names->names) text += (text.empty() ? "one of " : ", ") + name;
        return text;
    }
    return std::get<text_values>(values).what;
}

/// A parameter with one of several names; the field is an enumeration numbered from 0 in the order of the names.
template <class Config, class Enum, std::size_t N>
struct choice_parameter {
    std::string_view name;
    Enum Config::* field;
    std::array<std::string_view, N> names;
    std::string_view help;

    [[nodiscard]] parameter_values values() const { return name_values{{names.begin(), names.end()}}; }
    [[nodiscard]] std::string show(const Config& config) const {
        const auto chosen = static_cast<std::size_t>(config.*field);
        assert(chosen < N);
        return std::string(names[chosen]);
    }

    [[nodiscard]] bool set(Config& config, std::string_view text) const {
        const auto match = std::ranges::find(names, text);
        if (match == names.end()) return false;
        config.*field = static_cast<Enum>(match - names.begin());
        return true;
    }
};

/// An integer parameter in [least, most]; with `or_auto` also "auto", which leaves the optional empty.
template <class Config, class Value, std::integral Integer>
struct integer_parameter {
    std::string_view name;
    Value Config::* field;
    Integer least;
    Integer most;
    std::string_view help;

    static constexpr bool or_auto = std::same_as<Value, std::optional<Integer>>;
    static_assert(std::unsigned_integral<Integer> && (or_auto || std::same_as<Value, Integer>));

    [[nodiscard]] parameter_values values() const {
        return integer_values{static_cast<std::uint64_t>(least), static_cast<std::uint64_t>(most), or_auto};
    }

    [[nodiscard]] std::string show(const Config& config) const {
        if constexpr (or_auto)
            return config.*field ? std::to_string(*(config.*field)) : "auto";
        else
            return std::to_string(config.*field);
    }

    /// Parses a text into the parameter's field; "auto" leaves it empty where that is allowed.
    /// @returns false if the text is no valid value
    [[nodiscard]] bool set(Config& config, std::string_view text) const {
        if (or_auto && text == "auto") {
            config.*field = Value{};
            return true;
        }
        Integer value = 0;
        const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
        if (error != std::errc{} || end != text.data() + text.size() || value < least || value > most) return false;
        config.*field = value;
        return true;
    }
};

/// A real parameter in (above, at_most], or with `or_equal` [above, at_most]; "auto" leaves the optional empty.
template <class Config, class Value>
struct number_parameter {
    std::string_view name;
    Value Config::* field;
    double above;
    double at_most;
    std::string_view help;
    bool or_equal = false;

    static constexpr bool or_auto = std::same_as<Value, std::optional<double>>;
    [[nodiscard]] parameter_values values() const { return number_values{above, at_most, or_equal, or_auto}; }
    [[nodiscard]] std::string show(const Config& config) const {
        if constexpr (or_auto)
            return config.*field ? shortest(*(config.*field)) : "auto";
        else
            return shortest(static_cast<double>(config.*field));
    }

    /// Parses a text into the parameter's field; "auto" leaves it empty where that is allowed.
    /// @returns false if the text is no valid value
    [[nodiscard]] bool set(Config& config, std::string_view text) const {
        if (or_auto && text == "auto") {
            config.*field = Value{};
            return true;
        }
        double value = 0;
        const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
        const bool is_in_range = (value > above || (or_equal && value == above)) && value <= at_most;
        if (error != std::errc{} || end != text.data() + text.size() || !is_in_range) return false;
        config.*field = value;
        return true;
    }
};

/// A text parameter, mostly the name of a file. It is never empty: a field that is empty by default must be set. Since
/// a text with a comma cannot be written in a strategy's `name:parameter=value,…`, only scenes have such parameters.
template <class Config>
struct text_parameter {
    std::string_view name;
    std::string Config::* field;
    std::string_view what;  ///< completes "must be …"
    std::string_view help;

    [[nodiscard]] parameter_values values() const { return text_values{std::string(what)}; }
    [[nodiscard]] std::string show(const Config& config) const { return config.*field; }
    [[nodiscard]] bool set(Config& config, std::string_view text) const {
        config.*field = text;
        return !text.empty();
    }
};

}  // namespace aabb
