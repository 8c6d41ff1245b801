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

/// A strategy by name, with settings that override its defaults.
struct strategy_choice {
    std::string name;
    std::vector<setting> settings;

    friend auto operator<=>(const strategy_choice&, const strategy_choice&) = default;
};

/// The choice in the syntax of the command line: `shell:gaps=ciura,other=2`.
[[nodiscard]] inline std::string to_text(const strategy_choice& choice) {
    std::string text = choice.name;
    for (const setting& s : choice.settings)
        text += (&s == choice.settings.data() ? ":" : ",") + s.name + "=" + s.value;
    return text;
}

/// Parses a strategy and its settings as written on the command line: "name" or "name:parameter=value,parameter=value".
/// @throws input_error on a setting without "=".
[[nodiscard]] inline strategy_choice parse_strategy(std::string_view text) {
    const std::size_t colon = text.find(':');
    strategy_choice choice{std::string(text.substr(0, colon)), {}};
    if (colon == std::string_view::npos) return choice;
    text.remove_prefix(colon + 1);
    while (true) {  // `text` is the rest of the settings
        const std::string_view item = text.substr(0, text.find(','));
        const std::size_t equals = item.find('=');
        if (equals == std::string_view::npos || equals == 0)
            throw input_error("'" + std::string(item) + "' after '" + choice.name + ":' is not of the form name=value");
        choice.settings.push_back({std::string(item.substr(0, equals)), std::string(item.substr(equals + 1))});
        if (item.size() == text.size()) return choice;
        text.remove_prefix(item.size() + 1);
    }
}

/// The properties of a scene that are known before a run. The motion of boxes is left to strategies that observe it:
/// `neighbour_list`, and the plans of `columns`.
struct scene_traits {
    std::size_t frames = 1;
    std::size_t triangles = 0;    ///< total number in all meshes; 0 for scenes of boxes
    std::size_t queries = 1;      ///< expected number of narrow-phase queries of two meshes
    std::size_t meshes = 2;       ///< number of meshes; at least 1
    bool exact_triangles = true;  ///< the other strategies of the narrow phase are exact

    /// The least number of frames for which state kept between frames is worth its cost: the first Verlet list or BVTT
    /// front takes about as long as two searches.
    static constexpr std::size_t fewest_frames_to_keep = 4;

    /// The number of queries of two equally large meshes that repay a slower build: the added build time of both
    /// divided by the time saved per query. A query visits about 21 sqrt(n) pairs of nodes for n triangles of both
    /// meshes, as counted with meshes of 5,000 to 200,000 triangles.
    /// @param longer additional build time per triangle in nanoseconds
    /// @param share relative saving per query: 0.1 if queries take a tenth less
    [[nodiscard]] inline std::size_t queries_that_repay(double longer, double share) const {
        constexpr double visits_per_root = 21;
        constexpr double never = 1e18;  // more queries than any program makes, and less than 2^64
        if (triangles == 0) return static_cast<std::size_t>(never);
        const double least = longer * static_cast<double>(triangles) /
                             (machine_costs().node_visit * visits_per_root * share * std::sqrt(triangles_per_query()));
        return static_cast<std::size_t>(std::clamp(std::ceil(least), 0.0, never));
    }
    [[nodiscard]] inline double triangles_per_query() const {
        return 2 * static_cast<double>(triangles) / static_cast<double>(meshes);
    }
};

/// Whether a strategy serves a scene better than the default of its kind, and with which settings. A strategy that
/// `auto` may choose has a member `static scene_fit fit(const scene_traits&)`.
struct scene_fit {
    bool serves = false;
    std::vector<setting> settings{};
    std::vector<statement> because{};  ///< the reasons for or against it; may be empty
};

}  // namespace aabb
