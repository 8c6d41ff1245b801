export module aabb.policy:strategy_choice;

import aabb.base;
import aabb.std;

export namespace aabb {

/// One setting as the user wrote it: `gaps=ciura` on the command line, `gaps = "ciura"` in TOML.
struct setting {
    std::string name;
    std::string value;

    friend auto operator<=>(const setting&, const setting&) = default;
};

/// A strategy by name, with the settings that differ from its defaults.
struct strategy_choice {
    std::string name;
    std::vector<setting> settings;

    friend auto operator<=>(const strategy_choice&, const strategy_choice&) = default;
};

/// The choice as the command line takes it: `shell:gaps=ciura,other=2`.
[[nodiscard]] inline std::string to_text(const strategy_choice& choice) {
    std::string text = choice.name;
    for (const setting& s : choice.settings)
        text += (&s == choice.settings.data() ? ":" : ",") + s.name + "=" + s.value;
    return text;
}

/// The inverse of `to_text`.
/// @throws input_error on a setting without "=".
[[nodiscard]] inline strategy_choice parse_strategy(std::string_view text) {
    const std::size_t colon = text.find(':');
    strategy_choice choice{std::string(text.substr(0, colon)), {}};
    if (colon == std::string_view::npos) return choice;
    text.remove_prefix(colon + 1);
    while (true) {
        const std::string_view one = text.substr(0, text.find(','));
        const std::size_t equals = one.find('=');
        if (equals == std::string_view::npos || equals == 0)
            throw input_error("'" + std::string(one) + "' after '" + choice.name + ":' is not of the form name=value");
        choice.settings.push_back({std::string(one.substr(0, equals)), std::string(one.substr(equals + 1))});
        if (one.size() == text.size()) return choice;
        text.remove_prefix(one.size() + 1);
    }
}

}  // namespace aabb
