#include "command_parser.hpp"

#include "composing.hpp"

import aabb.selection;
import aabblab.inputs;

namespace aabblab {

namespace {

/// The default of a kind: "bucket, or what fits the named strategies", "selected for the scene".
std::string default_text(aabb::strategy_kind kind) {
    if (aabb::depends_on_scene(kind)) return "selected for the scene";
    const aabb::strategy_kind_info& info = info_of(kind);
    const std::string text(info.fallback);
    return info.default_with == info.fallback ? text : text + ", or what fits the named strategies";
}

/// The options of a stage: "--sort, --partition and --sweep".
std::string option_names(aabb::stage stage) {
    std::vector<std::string> names;
    for (const aabb::strategy_kind kind : kinds_of(stage)) names.push_back(fmt::format("--{}", name_of(kind)));
    const std::string last = names.back();
    names.pop_back();
    return fmt::format("{} and {}", fmt::join(names, ", "), last);
}

}  // namespace

/// Adds an option per kind of strategy of the stages, --sort and so on, except those that need meshes, and --engine.
void method_options::add_to(const command_parser& command, const std::string& replaced) {
    const bool has_meshes = std::ranges::find(stages_, aabb::stage::local_detection) != stages_.end();
    for (const aabb::stage stage : stages_)
        for (const aabb::strategy_kind kind : kinds_of(stage)) {
            std::vector<std::string> names;
            for (const aabb::strategy_info& strategy : aabb::strategies(kind))
                if (has_meshes || strategy.needs_meshes.empty()) names.push_back(strategy.name);
            command.option(fmt::format("--{} S", name_of(kind)), &values_[kind],
                           fmt::format("One of {} (default: {}); parameters: NAME:parameter=value",
                                       fmt::join(names, ", "), default_text(kind)));
        }
    command.option("--engine E", &engine_, "Engine such as cgal instead of " + replaced);
    command.footer("aabblab list shows every strategy with its parameters, and every engine.");
}

/// Returns what the options say to search with: a strategy per kind, or an engine, which replaces the last stage and so
/// excludes strategies of that stage. Strategies that cannot be combined are rejected here, before any file is read.
search_choice method_options::choice() const {
    const auto is_set = [&](aabb::strategy_kind kind) { return values_[kind].has_value(); };
    const aabb::stage replaced_by_engine = stages_.back();
    if (engine_ && std::ranges::any_of(kinds_of(replaced_by_engine), is_set))
        throw aabb::input_error(fmt::format("--engine replaces {}, so give it {}", option_names(replaced_by_engine),
                                            stages_.size() == 1 ? "alone" : "without them"));
    search_choice choice{stages_, /*named=*/{}, engine_};
    for (const aabb::stage stage : stages_)
        for (const aabb::strategy_kind kind : kinds_of(stage)) {
            if (!is_set(kind)) continue;
            if (*values_[kind] == "auto")
                throw aabb::input_error(fmt::format("--{} auto: omit the option to have one selected", name_of(kind)));
            choice.named[kind] = aabb::parse_strategy(*values_[kind]);
        }
    static_cast<void>(method_of(choice, /*traits=*/{}));  // rejects invalid compositions
    return choice;
}

std::string listed_names(aabb::strategy_kind kind) {
    return fmt::format("{}", fmt::join(aabb::strategy_names(kind), ", "));
}

void add_within(const command_parser& command, std::optional<double>* distance, const std::string& pairs) {
    const auto take = [distance](const std::string& text) {
        const std::string expected =
            fmt::format("--within is a distance: a finite number that is not negative, not '{}'", text);
        try {
            *distance = parse_number_of<double>({text}, 0);
        } catch (const aabb::input_error&) {
            throw aabb::input_error(expected);
        }
        if (*distance < 0) throw aabb::input_error(expected);
    };
    command.option("--within D", take,
                   fmt::format("Find the pairs of {0} whose distance is at most D, exactly", pairs));
}

void add_metric(const command_parser& command, std::optional<aabb::box_metric>* metric) {
    const auto take = [metric](const std::string& text) {
        if (text != "euclidean" && text != "axis")
            throw aabb::input_error(fmt::format("--metric is euclidean or axis, not '{}'", text));
        *metric = text == "axis" ? aabb::box_metric::axis : aabb::box_metric::euclidean;
    };
    command.option("--metric M", take,
                   "The distance of --within: euclidean, or axis, the greatest gap on an axis (default euclidean)");
}

void require_no_triangle_test(const search_choice& choice) {
    if (choice.engine) throw aabb::input_error("no engine compares distances; omit --engine");
    if (choice.named[aabb::strategy_kind::triangle])
        throw aabb::input_error("distances need no triangle test; omit --triangle");
    if (const std::optional<aabb::strategy_choice>& tree = choice.named[aabb::strategy_kind::tree];
        tree && std::ranges::find(tree->settings, "leaf_test", &aabb::setting::name) != tree->settings.end())
        throw aabb::input_error("distances need no test of a leaf; omit leaf_test");
}

std::string text_of_within(const std::optional<double>& distance) {
    return distance ? fmt::format(" within {}", *distance) : "";
}

self_pairs self_pairs_of(const std::string& value) {
    // Two have earlier names.
    const std::map<std::string, self_pairs> choices{{"true", self_pairs::intersecting},
                                                    {"all", self_pairs::all},
                                                    {"together", self_pairs::all},
                                                    {"no-adjacent", self_pairs::no_adjacent},
                                                    {"apart", self_pairs::no_adjacent}};
    if (const auto choice = choices.find(value); choice != choices.end()) return choice->second;
    throw aabb::input_error(
        aabb::unknown_name("value of --self", value, std::vector<std::string>{"all", "no-adjacent"}));
}

void add_touching(const command_parser& command, bool* touching, const std::string& hits) {
    const auto take = [touching](const std::string& text) {
        if (text != "yes" && text != "no")
            throw aabb::input_error(fmt::format("--touching is yes or no, not '{}'", text));
        *touching = text == "yes";
    };
    command.option(
        "--touching V", take,
        "no: leave out " + hits +
            " that only touch, in a point or along a segment; those that cross, or overlap in a plane, stay (default "
            "yes)");
}

}  // namespace aabblab
