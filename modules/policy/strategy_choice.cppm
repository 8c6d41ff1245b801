export module aabb.policy:strategy_choice;

import aabb.base;
import aabb.costs;
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

/// What is known of a scene before it is played. What boxes do from frame to frame is left to strategies that watch it:
/// `neighbour_list`, and the plans of `columns`.
struct scene_outlook {
    std::size_t frames = 1;
    std::size_t triangles = 0;    ///< of all meshes; 0 where there are boxes only
    std::size_t queries = 1;      ///< of two meshes, that trees are to serve
    std::size_t meshes = 2;       ///< that the triangles are of; at least 1
    bool exact_triangles = true;  ///< the strategies beside it are exact

    /// Of fewer, what is kept for later frames does not pay where it serves: the first list of neighbours or front,
    /// which takes about as long as two searches.
    static constexpr std::size_t fewest_frames_to_keep = 4;

    /// From so many queries on, what a build takes longer for each triangle comes back where each query takes less by
    /// that share. A query of two meshes visits about 21 pairs of nodes times the root of their triangles: counted with
    /// meshes of 5,000 to 200,000. Meshes are taken to be alike.
    /// @param longer in ns
    [[nodiscard]] inline std::size_t queries_that_repay(double longer, double share) const {
        constexpr double visits_a_root = 21;
        constexpr double many = 1e18;
        if (triangles == 0) return static_cast<std::size_t>(many);
        const double all = longer * static_cast<double>(triangles) /
                           (machine_costs().node_visit * visits_a_root * share * std::sqrt(triangles_of_two()));
        return static_cast<std::size_t>(std::clamp(std::ceil(all), 0.0, many));
    }
    [[nodiscard]] inline double triangles_of_two() const {
        return 2 * static_cast<double>(triangles) / static_cast<double>(meshes);
    }
};

/// Whether a strategy serves a scene better than the usual one of its kind, and the settings with which it does. A
/// strategy that `auto` may choose has a member `static scene_fit fit(const scene_outlook&)`.
struct scene_fit {
    bool serves = false;
    std::vector<setting> settings{};
    std::vector<statement> because{};  ///< why, or why not; empty where nothing is to be said
};

}  // namespace aabb
