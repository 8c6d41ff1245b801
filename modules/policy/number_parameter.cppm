export module aabb.policy:number_parameter;

import aabb.base;
import aabb.std;
import :parameter_values;

export namespace aabb {

/// A real number in (above, at_most], or with `or_equal` in [above, at_most], as text; with `or_auto`, "auto" too,
/// which leaves the optional empty.
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

    [[nodiscard]] bool set(Config& config, std::string_view text) const {
        if constexpr (or_auto)
            if (text == "auto") {
                config.*field = std::nullopt;
                return true;
            }
        double value = 0;
        const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
        const bool is_in = (value > above || (or_equal && value == above)) && value <= at_most;
        if (error != std::errc{} || end != text.data() + text.size() || !is_in) return false;
        config.*field = value;
        return true;
    }
};

}  // namespace aabb
