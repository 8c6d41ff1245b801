module;

#include <random>

module aabblab.atlas;

import aabb.policy;
import aabblab.fmt;
import aabblab.numbers;

namespace aabblab {

namespace {

constexpr std::array<std::string_view, 5> parameters{"objects", "displacement", "density", "ratio", "moving"};

/// The settings of a scene without one parameter: scenes in which these agree differ in that parameter only.
std::string settings_without(const scene_choice& scene, std::string_view parameter) {
    scene_choice others = scene;
    std::erase_if(others.settings, [&](const aabb::setting& s) { return s.name == parameter || s.name == "frames"; });
    return settings_text(others);
}

/// The fraction of the way between two scenes at which two candidates take the same time, by linear interpolation of
/// the logarithm of their ratio. Its 95 % interval is that of lines whose ends are drawn with their errors.
/// @param from the logarithm at the first scene, which the first candidate wins: below 0
/// @param to the logarithm at the second scene: above 0
std::pair<double, interval> crossing(const estimate& from, const estimate& to) {
    // A line from a at 0 to b at 1 is 0 at a / (a - b).
    const auto share = [](double a, double b) { return a == b ? 0.5 : std::clamp(a / (a - b), 0.0, 1.0); };
    constexpr std::size_t draws = 2000;
    std::mt19937_64 random(1);
    const auto drawn = [&](const estimate& e) {
        // The sum of twelve uniform numbers is close to normal, and reproducible with every library.
        double sum = -6;
        for (int i = 0; i < 12; ++i) sum += static_cast<double>(random() >> 11U) * 0x1p-53;
        return e.value + sum * e.error;
    };
    std::vector<double> shares;
    for (std::size_t i = 0; i < draws; ++i) {
        const double a = drawn(from), b = drawn(to);
        // Clamp to an end if one candidate is ahead at both.
        shares.push_back(a >= 0 ? 0 : b <= 0 ? 1 : share(a, b));
    }
    std::ranges::sort(shares);
    constexpr std::size_t tail = draws / 40;  // 2.5 %
    return {share(from.value, to.value), {shares[tail], shares[draws - 1 - tail]}};
}

/// The fastest candidate with these strategies, whatever their parameters; null if the scene has none.
const atlas_candidate* fastest_of(const atlas_scene& scene, const std::string& family) {
    return scene.fastest_if([&](const atlas_candidate& candidate) { return family_of(candidate.label) == family; });
}

/// The value at which the winners of two scenes, which differ in one parameter, take the same time, interpolated along
/// its logarithm. None if the same strategies win both, or if a winner was not timed in both.
std::optional<border> border_between(const atlas_scene& from, const atlas_scene& to, std::string_view parameter) {
    const atlas_candidate& first_winner = from.fastest();
    const atlas_candidate& second_winner = to.fastest();
    const std::string before = family_of(first_winner.label), after = family_of(second_winner.label);
    if (before == after) return std::nullopt;
    const atlas_candidate* second_at_first = fastest_of(from, after);
    const atlas_candidate* first_at_second = fastest_of(to, before);
    if (!second_at_first || !first_at_second) return std::nullopt;
    const double log_from = std::log(from.number(parameter));
    const double log_length = std::log(to.number(parameter)) - log_from;
    if (!std::isfinite(log_from)) return std::nullopt;
    // Logarithms of the first winner's time over the second's, at either scene.
    const estimate ratio_at_first = log_ratio_in(from, first_winner, *second_at_first);
    const estimate ratio_at_second = log_ratio_in(to, *first_at_second, second_winner);
    if (!ratio_at_first.is_known() || !ratio_at_second.is_known()) return std::nullopt;
    const auto [share, range] = crossing(ratio_at_first, ratio_at_second);
    return border{before,
                  after,
                  std::string(parameter),
                  from.scene.kind + " " + settings_without(from.scene, parameter),
                  std::exp(log_from + share * log_length),
                  {std::exp(log_from + range.low * log_length), std::exp(log_from + range.high * log_length)}};
}

/// The logarithm of the position of a border, with the error that its 95 % interval implies.
estimate log_position_of(const border& b) {
    constexpr double errors_in_interval = 2 * 1.96;
    constexpr double many_degrees = 1000;
    return {std::log(b.position), std::log(b.range.high / b.range.low) / errors_in_interval, many_degrees};
}

}  // namespace

/// The borders along each parameter: between successive scenes of the map whose other parameters are all equal.
std::vector<border> borders_of(const std::vector<atlas_scene>& atlas) {
    std::vector<border> borders;
    for (const std::string_view parameter : parameters) {
        std::map<std::string, std::vector<const atlas_scene*>> by_others;
        for (const atlas_scene& scene : atlas)
            if (!scene.is_held_out && !std::isnan(scene.number(parameter)))
                by_others[settings_without(scene.scene, parameter)].push_back(&scene);
        for (auto& [others, scenes] : by_others) {
            std::ranges::stable_sort(scenes, {}, [&](const atlas_scene* s) { return s->number(parameter); });
            for (std::size_t i = 1; i < scenes.size(); ++i)
                if (auto b = border_between(*scenes[i - 1], *scenes[i], parameter)) borders.push_back(*std::move(b));
        }
    }
    return borders;
}

table borders_table(const std::vector<border>& borders) {
    table t = empty_table({"before", "after", "along"}, {"at", "low", "high"}, {"others"});
    for (const border& b : borders)
        t.rows.push_back({b.before, b.after, b.parameter, fmt::format("{:.4g}", b.position),
                          fmt::format("{:.4g}", b.range.low), fmt::format("{:.4g}", b.range.high), b.others});
    return t;
}

/// One row per parameter and pair of winners, the most frequent first: the number of borders and their values.
table borders_summary(const std::vector<border>& borders) {
    std::map<std::tuple<std::string, std::string, std::string>, std::vector<const border*>> by_winners;
    for (const border& b : borders) by_winners[{b.parameter, b.before, b.after}].push_back(&b);
    std::vector<std::vector<const border*>> groups;
    for (const auto& [key, group] : by_winners) groups.push_back(group);
    std::ranges::stable_sort(groups, [](const auto& a, const auto& b) { return a.size() > b.size(); });
    table t = empty_table({"along", "fastest before", "fastest after"}, {"borders", "at", "95 %", "from", "to"});
    for (const std::vector<const border*>& group : groups) {
        std::vector<estimate> log_positions;
        for (const border* b : group) log_positions.push_back(log_position_of(*b));
        const auto [low, high] = std::ranges::minmax(group, {}, &border::position);
        const estimate mean = mean_of(log_positions);
        const border& first = *group.front();
        t.rows.push_back({first.parameter, first.before, first.after, grouped(group.size()),
                          fmt::format("{:.3g}", std::exp(mean.value)),
                          fmt::format("{:.3g}-{:.3g}", std::exp(mean.range().low), std::exp(mean.range().high)),
                          fmt::format("{:.3g}", low->position), fmt::format("{:.3g}", high->position)});
    }
    return t;
}

}  // namespace aabblab
