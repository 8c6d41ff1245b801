module;
#include <cassert>

export module aabb.policy:choice_parameter;

import aabb.std;
import :parameter_values;

export namespace aabb {

/// One of several names; the field is an enumeration numbered from 0 in the order of the names.
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
        const auto found = std::ranges::find(names, text);
        if (found == names.end()) return false;
        config.*field = static_cast<Enum>(found - names.begin());
        return true;
    }
};

}  // namespace aabb
