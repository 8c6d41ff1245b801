export module aabb.policy:parameter_values;

import aabb.base;
import aabb.std;

export namespace aabb {

/// Whole numbers in [least, most].
struct whole_values {
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
/// One of these.
struct name_values {
    std::vector<std::string> names;
};
/// Any text but an empty one.
struct text_values {
    std::string what;  ///< completes "must be …"
};
/// The values that a parameter takes.
using parameter_values = std::variant<whole_values, number_values, name_values, text_values>;

/// Completes "must be …": "a whole number from 1 to 8 or auto", "one of x, y".
[[nodiscard]] inline std::string to_text(const parameter_values& values) {
    if (const auto* whole = std::get_if<whole_values>(&values))
        return "a whole number from " + std::to_string(whole->least) + " to " + std::to_string(whole->most) +
               (whole->or_auto ? " or auto" : "");
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

}  // namespace aabb
