export module aabb.policy:text_parameter;

import aabb.std;
import :parameter_values;

export namespace aabb {

/// A text as it is, mostly the name of a file. It is never empty: a field that is empty by default must be set. A text
/// with a comma cannot be written in a strategy's `name:parameter=value,…`, so these are parameters of scenes.
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
