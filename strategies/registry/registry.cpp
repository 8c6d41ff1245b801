module aabb.registry;

import aabb.composed;

namespace aabb {

// Defined in the generated catalog.cpp.
namespace registry {
composed::global_search_rows all_global_rows();
composed::local_detection_rows all_local_rows();
std::vector<strategy_info> infos_of(strategy_kind kind);
std::unique_ptr<global_stage> prepared(const strategy_choice& choice, std::unique_ptr<global_stage> search,
                                       instrumentation counted);
tree_builder builder_named(const strategy_choice& choice);
std::unique_ptr<triangle_test> triangle_test_named(const strategy_choice& choice);
}  // namespace registry

namespace {

/// The strategy of a choice, whose name must be known.
const strategy_info& strategy_of(strategy_kind kind, const strategy_choice& choice) {
    return *std::ranges::find(strategies(kind), choice.name, &strategy_info::name);
}

const composed::global_search_rows& global_rows() {
    static const composed::global_search_rows rows = registry::all_global_rows();
    return rows;
}
const composed::local_detection_rows& local_rows() {
    static const composed::local_detection_rows rows = registry::all_local_rows();
    return rows;
}

/// The kinds of a stage that are compiled alone (`is_compiled_alone`), or those compiled together.
std::vector<strategy_kind> kinds_of(stage of, bool is_compiled_alone) {
    std::vector<strategy_kind> kinds = kinds_of(of);
    std::erase_if(kinds, [&](strategy_kind kind) { return info_of(kind).is_compiled_alone != is_compiled_alone; });
    return kinds;
}

void require_known(const composition& c, stage of) {
    for (const strategy_kind kind : kinds_of(of)) require_known(kind, c[kind]);
}

/// The choices of the kinds that are compiled together, in their order.
std::vector<strategy_choice> choices_of(const composition& c, stage of) {
    std::vector<strategy_choice> choices;
    for (const strategy_kind kind : kinds_of(of, /*is_compiled_alone=*/false)) choices.push_back(c[kind]);
    return choices;
}

template <class Rows>
const auto& find_row(const Rows& rows, const composition& c, stage of) {
    require_known(c, of);
    const std::vector<strategy_choice> choices = choices_of(c, of);
    return *std::ranges::find_if(
        rows, [&](const auto& row) { return std::ranges::equal(row.names, choices, {}, {}, &strategy_choice::name); });
}

template <class Rows>
const auto& accepted_row(const Rows& rows, const composition& c, stage of) {
    const auto& row = find_row(rows, c, of);
    if (!row.make) throw input_error(to_text(c, of) + ": " + std::string(row.rejection));
    return row;
}

/// All accepted compositions of a stage, with default parameters. The rows of its table combine the kinds that are
/// compiled together. A strategy of a kind that is compiled alone (`prepare`, `build`) works with every row, so it is
/// combined with two only: that of the default strategies, and that of the first strategy of each kind.
template <class Rows>
std::vector<composition> every_composition(const Rows& rows, stage of) {
    std::vector<composition> compositions;
    const std::vector<strategy_kind> kinds = kinds_of(of, /*is_compiled_alone=*/false);
    for (const auto& row : rows) {
        if (!row.make) continue;  // rejected
        composition& c = compositions.emplace_back();
        for (std::size_t i = 0; i < kinds.size(); ++i) c[kinds[i]] = {std::string(row.names[i]), {}};
    }
    for (const strategy_kind kind : kinds_of(of, /*is_compiled_alone=*/true))
        for (const strategy_info& info : strategies(kind)) {
            if (info.name == info_of(kind).fallback) continue;  // the default, as in the rows
            composition c;
            c[kind] = {info.name, {}};
            compositions.push_back(c);
            for (const strategy_kind other : kinds) c[other] = {strategies(other).front().name, {}};
            if (find_row(rows, c, of).make) compositions.push_back(c);
        }
    return compositions;
}

/// The kind that has a strategy of this name; nothing if no kind has one, or several have.
std::optional<strategy_kind> only_kind_of(const std::string& name) {
    std::optional<strategy_kind> only;
    for (const strategy_kind kind : strategy_kinds) {
        if (std::ranges::find(strategies(kind), name, &strategy_info::name) == strategies(kind).end()) continue;
        if (only) return std::nullopt;
        only = kind;
    }
    return only;
}

}  // namespace

std::string_view name_of(strategy_kind kind) {
    return info_of(kind).name;
}

std::vector<strategy_kind> kinds_of(stage of) {
    std::vector<strategy_kind> kinds(strategy_kinds.begin(), strategy_kinds.end());
    std::erase_if(kinds, [&](strategy_kind kind) { return info_of(kind).stage != of; });
    return kinds;
}

/// The registry's entries of all strategies of a kind, made at the first call.
std::span<const strategy_info> strategies(strategy_kind kind) {
    static const by_kind<std::vector<strategy_info>> infos = [] {
        by_kind<std::vector<strategy_info>> table;
        for (const strategy_kind k : strategy_kinds) table[k] = registry::infos_of(k);
        return table;
    }();
    return infos[kind];
}

std::vector<std::string> strategy_names(strategy_kind kind) {
    std::vector<std::string> names;
    for (const strategy_info& info : strategies(kind)) names.push_back(info.name);
    return names;
}

/// Rejects an unknown name, a parameter that is given twice and an invalid setting.
/// @throws input_error that names the kind to which the name belongs, or the nearest valid name
void require_known(strategy_kind kind, const strategy_choice& choice) {
    const std::vector<std::string> names = strategy_names(kind);
    if (std::ranges::find(names, choice.name) == names.end()) {
        if (const std::optional<strategy_kind> other = only_kind_of(choice.name))
            throw input_error("'" + choice.name + "' is of the kind " + std::string(name_of(*other)) + ", not " +
                              std::string(name_of(kind)));
        throw input_error(unknown_name(name_of(kind), choice.name, names));
    }
    std::set<std::string_view> seen;
    for (const setting& s : choice.settings) {
        if (!seen.insert(s.name).second) throw input_error(choice.name + ": " + s.name + " is given twice");
        // Earlier versions had parameters that are kinds of their own now.
        const auto kind_of_name = std::ranges::find(strategy_kind_infos, s.name, &strategy_kind_info::name);
        const std::vector<parameter_info>& parameters = strategy_of(kind, choice).parameters;
        const auto parameter = std::ranges::find(parameters, s.name, &parameter_info::name);
        if (kind_of_name != strategy_kind_infos.end() && parameter == parameters.end())
            throw input_error(choice.name + " has no parameter " + s.name + ", which is a kind of its own: write " +
                              s.name + " = \"" + s.value + "\" or --" + s.name + " " + s.value);
    }
    strategy_of(kind, choice).check(choice);
}

/// Chooses a strategy of each kind: the one that the user names, else a default. A kind has two defaults: a plain one,
/// `default_with`, for stages in which the user names another kind (kinds compiled alone do not count), and `fallback`
/// for the others. A stage that rejects the former and accepts the latter uses the latter.
composition::composition(const named_strategies& named) {
    const auto complete = [&](stage of, std::string_view strategy_kind_info::* usual) {
        for (const strategy_kind kind : kinds_of(of))
            choices_[kind] = named[kind].value_or(strategy_choice{std::string(info_of(kind).*usual), {}});
    };
    for (const stage of : {stage::global_search, stage::local_detection}) {
        complete(of, &strategy_kind_info::fallback);
        const bool any_named = std::ranges::any_of(kinds_of(of, /*is_compiled_alone=*/false),
                                                   [&](strategy_kind kind) { return named[kind].has_value(); });
        if (!any_named) continue;
        const composition with_fallbacks = *this;
        complete(of, &strategy_kind_info::default_with);
        if (!rejection_of(*this, of).empty() && rejection_of(with_fallbacks, of).empty()) *this = with_fallbacks;
    }
}

/// The strategies joined by " + ", as in "shell + axial_cut + one_axis", without defaults of kinds compiled alone.
std::string text_in_line(const by_kind<std::string>& choices, std::span<const strategy_kind> kinds) {
    std::string text;
    for (const strategy_kind kind : kinds) {
        const bool is_left_out = info_of(kind).is_compiled_alone && choices[kind] == info_of(kind).fallback;
        if (!is_left_out && !choices[kind].empty()) text += (text.empty() ? "" : " + ") + choices[kind];
    }
    return text;
}

std::string to_text(const composition& c, stage of) {
    by_kind<std::string> choices;
    for (const strategy_kind kind : kinds_of(of)) choices[kind] = to_text(c[kind]);
    return text_in_line(choices);
}

std::string_view rejection_of(const composition& c, stage of) {
    return of == stage::global_search ? find_row(global_rows(), c, of).rejection
                                      : find_row(local_rows(), c, of).rejection;
}

bool is_exact(const composition& c, stage of) {
    require_known(c, of);
    return std::ranges::all_of(kinds_of(of),
                               [&](strategy_kind kind) { return strategy_of(kind, c[kind]).is_exact_with(c[kind]); });
}

std::string needs_meshes(const composition& c) {
    require_known(c, stage::global_search);
    for (const strategy_kind kind : kinds_of(stage::global_search))
        if (const std::string& sentence = strategy_of(kind, c[kind]).needs_meshes; !sentence.empty()) return sentence;
    return {};
}

std::vector<composition> every_composition(stage of) {
    return of == stage::global_search ? every_composition(global_rows(), of) : every_composition(local_rows(), of);
}

std::unique_ptr<global_stage> compose_global_search(const composition& c, instrumentation counted) {
    const auto& row = accepted_row(global_rows(), c, stage::global_search);
    return registry::prepared(c[strategy_kind::prepare], row.make(choices_of(c, stage::global_search), counted),
                              counted);
}

std::unique_ptr<local_stage> compose_local_detection(const composition& c, instrumentation counted) {
    const auto& row = accepted_row(local_rows(), c, stage::local_detection);
    return row.make(choices_of(c, stage::local_detection), registry::builder_named(c[strategy_kind::build]), counted);
}

std::unique_ptr<triangle_test> make_triangle_test(const strategy_choice& choice) {
    require_known(strategy_kind::triangle, choice);
    return registry::triangle_test_named(choice);
}

ordered_mesh in_leaf_order(const mesh& m, const strategy_choice& build) {
    require_known(strategy_kind::build, build);
    require_valid(m);
    const balanced_order order = registry::builder_named(build).order(m);
    return {in_leaf_order(m, order), {order.triangles.begin(), order.triangles.end()}};
}

}  // namespace aabb
