export module aabb.policy:integer_parameter;

import aabb.std;
import :parameter_values;

export namespace aabb {

/// A whole number in [least, most], as text; with `or_auto`, "auto" too, which leaves the optional empty.
template <class Config, class Value, std::integral Whole>
struct integer_parameter {
    std::string_view name;
    Value Config::* field;
    Whole least;
    Whole most;
    std::string_view help;

    static constexpr bool or_auto = std::same_as<Value, std::optional<Whole>>;
    static_assert(std::unsigned_integral<Whole> && (or_auto || std::same_as<Value, Whole>));

    [[nodiscard]] parameter_values values() const {
        return whole_values{static_cast<std::uint64_t>(least), static_cast<std::uint64_t>(most), or_auto};
    }

    [[nodiscard]] std::string show(const Config& config) const {
        if constexpr (or_auto)
            return config.*field ? std::to_string(*(config.*field)) : "auto";
        else
            return std::to_string(config.*field);
    }

    [[nodiscard]] bool set(Config& config, std::string_view text) const {
        if constexpr (or_auto)
            if (text == "auto") {
                config.*field = std::nullopt;
                return true;
            }
        Whole value = 0;
        const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
        if (error != std::errc{} || end != text.data() + text.size() || value < least || value > most) return false;
        config.*field = value;
        return true;
    }
};

}  // namespace aabb
