module aabblab.extreme;

import aabb.pipeline;
import aabb.registry;
import aabb.validation;
import aabblab.progress;
import aabblab.trials;

namespace aabblab {

namespace {

/// The strategy with each combination of its parameters' named values; the first, all defaults, has no settings.
std::vector<aabb::strategy_choice> with_named_values(aabb::strategy_kind kind, const std::string& name) {
    const auto info = std::ranges::find(aabb::strategies(kind), name, &aabb::strategy_info::name);
    std::vector<aabb::strategy_choice> choices{{name, {}}};
    for (const aabb::parameter_info& parameter : info->parameters) {
        const auto* const named = std::get_if<aabb::name_values>(&parameter.values);
        if (!named) continue;
        const std::size_t count = choices.size();
        for (const std::string& value : named->names)
            for (std::size_t i = 0; i < count && value != parameter.fallback; ++i)
                choices.emplace_back(choices[i]).settings.push_back({parameter.name, value});
    }
    return choices;
}

/// The composition with each combination of the named values of the parameters of its strategies.
std::vector<aabb::composition> with_named_values(const aabb::composition& c, aabb::stage stage) {
    std::vector<aabb::composition> compositions{c};
    for (const aabb::strategy_kind kind : aabb::strategy_kinds) {
        if (info_of(kind).stage != stage) continue;
        std::vector<aabb::composition> expanded;
        for (const aabb::composition& previous : compositions)
            for (const aabb::strategy_choice& choice : with_named_values(kind, c[kind].name))
                expanded.emplace_back(previous)[kind] = choice;
        compositions = std::move(expanded);
    }
    return compositions;
}

/// The valid, exact compositions of a stage.
/// @param named_values includes every combination of those parameters whose values are names
std::vector<aabb::composition> exact_compositions(aabb::stage stage, bool named_values) {
    std::vector<aabb::composition> compositions;
    for (const aabb::composition& c : aabb::every_composition(stage))
        std::ranges::move(named_values ? with_named_values(c, stage) : std::vector{c},
                          std::back_inserter(compositions));
    // Broad phases run on scenes of boxes here, so those that need meshes are excluded.
    std::erase_if(compositions, [&](const aabb::composition& c) {
        return !is_exact(c, stage) || !rejection_of(c, stage).empty() || !needs_meshes(c).empty();
    });
    return compositions;
}

/// The default composition of the narrow phase with each inexact triangle test.
std::vector<aabb::composition> inexact_compositions() {
    std::vector<aabb::composition> compositions;
    for (const aabb::strategy_info& info : aabb::strategies(aabb::strategy_kind::triangle)) {
        aabb::composition c;
        c[aabb::strategy_kind::triangle] = {info.name, {}};
        if (!is_exact(c, aabb::stage::local_detection)) compositions.push_back(std::move(c));
    }
    return compositions;
}

struct named_test {
    std::string name;
    bool exact;
    std::unique_ptr<aabb::triangle_test> test;
};

/// All triangle tests: the strategies, with each combination of named values, then those of libraries.
std::vector<named_test> named_triangle_tests() {
    std::vector<named_test> tests;
    for (const aabb::strategy_info& info : aabb::strategies(aabb::strategy_kind::triangle))
        for (const aabb::strategy_choice& choice : with_named_values(aabb::strategy_kind::triangle, info.name)) {
            aabb::composition c;
            c[aabb::strategy_kind::triangle] = choice;
            tests.push_back(
                {to_text(choice), is_exact(c, aabb::stage::local_detection), aabb::make_triangle_test(choice)});
        }
    for (const aabb::library_test_info& info : aabb::library_tests())
        tests.push_back({info.name, info.exact, aabb::make_library_test({info.name, {}})});
    return tests;
}

extreme_row row_of(const aabb::triangle_case& c, const std::string& name, candidate_role role, bool must_be_exact) {
    return {row_group::cases, c.name, c.about, c.kind, name, {}, role, must_be_exact};
}

/// Compares a result with the ground truth, and counts errors.
void count_error(bool result, bool truth, extreme_row& row) {
    if (result == truth) return;
    ++(truth ? row.result.false_negatives : row.result.false_positives);
    row.result.outcome = aabb::verdict::wrong;
    row.result.reason = truth ? "reports that they do not intersect" : "reports that they intersect";
    row.as_expected = !row.must_be_exact;
}

template <class Real>
extreme_row row_of_test(const aabb::triangle_case& c, const named_test& test, bool truth, const char* precision) {
    extreme_row row = row_of(c, test.name, candidate_role::triangle_test, test.exact);
    row.precision = precision;
    for (const aabb::triangle_pair<Real>& pair : aabb::every_order<Real>(c))
        count_error(test.test->intersects(pair.a, pair.b), truth, row);
    return row;
}

/// Two meshes of one triangle for each case of two triangles: those of case i are 2i and 2i + 1.
std::vector<aabb::mesh> meshes_of(std::span<const aabb::triangle_case> cases) {
    std::vector<aabb::mesh> meshes;
    for (const aabb::triangle_case& c : cases)
        for (const aabb::triangle3d* t : {&c.first, &c.second}) {
            const aabb::triangle3f corners = aabb::in_float(*t);
            meshes.push_back({{corners[0], corners[1], corners[2]}, {{0, 1, 2}}});
        }
    return meshes;
}

/// A composition, an engine or a triangle test, with its name in reports.
struct named_candidate {
    std::string name;
    candidate_role role;
    candidate implementation;
};

/// All candidates of a stage: exact compositions, engines and, for the narrow phase, inexact triangle tests.
/// @param named_values includes every combination of those parameters whose values are names
std::vector<named_candidate> candidates(aabb::stage stage, bool named_values) {
    const bool meshes = stage == aabb::stage::local_detection;
    std::vector<named_candidate> list;
    const aabb::strategy_choice any_test = aabb::composition()[aabb::strategy_kind::triangle];
    for (const aabb::composition& c : exact_compositions(stage, named_values)) {
        list.push_back({to_text(c, stage), candidate_role::composition, candidate_of(c, meshes)});
        // Distances do not depend on the triangle test.
        if (!meshes || c[aabb::strategy_kind::triangle] != any_test) continue;
        list.push_back(list.back());
        list.back().name += " by distance";
        list.back().implementation.make_local = [c](aabb::instrumentation) { return compose_by_distance(c); };
    }
    for (const aabb::engine_info& engine : aabb::engines())
        if (meshes ? engine.collides_meshes : engine.searches_boxes)
            list.push_back({engine.name, candidate_role::engine, candidate_of(engine, meshes).value()});
    if (!meshes) return list;
    for (const aabb::composition& c : inexact_compositions())
        list.push_back({to_text(c[aabb::strategy_kind::triangle]), candidate_role::triangle_test,
                        candidate_of(c, /*meshes=*/true)});
    return list;
}

/// Runs a candidate on every case of two triangles, the meshes 2i and 2i + 1, by all queries in both orders.
void run_on_cases(std::span<const aabb::triangle_case> cases, std::span<const aabb::mesh> meshes,
                  const named_candidate& tested, std::vector<extreme_row>& rows) {
    const std::unique_ptr<aabb::local_stage> stage = tested.implementation.make_local(aabb::instrumentation::none);
    for (const aabb::mesh& m : meshes) stage->add_model(m);
    for (std::size_t i = 0; i < cases.size(); ++i) {
        extreme_row row = row_of(cases[i], tested.name, tested.role, tested.implementation.exact);
        const auto first = static_cast<std::uint32_t>(2 * i);
        for (const auto [a, b] : {std::array{first, first + 1}, std::array{first + 1, first}}) {
            std::vector<aabb::index_pair> pairs;
            stage->all_pairs(a, {}, b, {}, pairs);
            count_error(!pairs.empty(), cases[i].intersect, row);
            count_error(stage->first_pair(a, {}, b, {}).has_value(), cases[i].intersect, row);
            count_error(stage->count_pairs(a, {}, b, {}) == 1, cases[i].intersect, row);
        }
        rows.push_back(std::move(row));
    }
}

/// Runs the candidates on the judge's scene, and appends a row for each with the result.
void run_candidates(const aabb::extreme_judge& judge, std::span<const named_candidate> list,
                    std::vector<extreme_row>& rows) {
    const aabb::extreme_scene& scene = judge.scene();
    const bool boxes = static_cast<bool>(scene.make_boxes);
    for (const named_candidate& c : list) {
        // Engines always list all pairs before they return the first.
        if (c.role == candidate_role::engine && scene.query == aabb::extreme_query::first_pair) continue;
        extreme_row row{.group = boxes ? row_group::boxes : row_group::meshes,
                        .scene = scene.name,
                        .about = scene.summary,
                        .candidate = c.name,
                        .role = c.role};
        // Box tests only compare coordinates, without rounding, so every engine must be exact.
        row.must_be_exact = boxes ? c.implementation.exact_boxes : c.implementation.exact;
        row.stated_bytes = scene.most_bytes;
        row.result = boxes ? judge.judge([&] { return c.implementation.make_global(aabb::instrumentation::none); })
                           : judge.judge([&] { return c.implementation.make_local(aabb::instrumentation::none); });
        if (c.role == candidate_role::composition) require_stated_memory(scene, row.result);
        row.as_expected = is_as_expected(scene, row.result, row.must_be_exact);
        rows.push_back(std::move(row));
    }
}

}  // namespace

/// Runs the triangle tests on each case of two triangles, in float and in double, then compositions and engines on
/// meshes of one triangle.
/// @returns a row per candidate and case, and per precision for triangle tests
std::vector<extreme_row> run_triangle_cases(std::span<const aabb::triangle_case> cases) {
    std::vector<extreme_row> rows;
    for (const named_test& test : named_triangle_tests())
        for (const aabb::triangle_case& c : cases) {
            rows.push_back(row_of_test<float>(c, test, c.intersect, "float"));
            if (test.test->takes_double()) rows.push_back(row_of_test<double>(c, test, c.intersect_double, "double"));
        }
    const std::vector<aabb::mesh> meshes = meshes_of(cases);
    for (const named_candidate& c : candidates(aabb::stage::local_detection, /*named_values=*/true))
        if (c.role != candidate_role::triangle_test) run_on_cases(cases, meshes, c, rows);
    return rows;
}

/// Runs every candidate on every scene, a row each; at full size, also with each named value of parameters.
std::vector<extreme_row> run_extreme_scenes(std::span<const aabb::extreme_scene> scenes, aabb::extreme_size size) {
    const bool named_values = size == aabb::extreme_size::full;
    const auto for_boxes = candidates(aabb::stage::global_search, named_values);
    const auto for_meshes = candidates(aabb::stage::local_detection, named_values);
    // Parameters would add minutes but no insight in scenes with large meshes: those with a memory limit.
    const auto for_large_meshes = candidates(aabb::stage::local_detection, /*named_values=*/false);
    std::vector<extreme_row> rows;
    progress shown("extreme scenes", scenes.size());
    for (std::size_t i = 0; i < scenes.size(); ++i) {
        const aabb::extreme_judge judge(scenes[i]);
        run_candidates(judge,
                       scenes[i].make_boxes       ? for_boxes
                       : scenes[i].most_bytes > 0 ? for_large_meshes
                                                  : for_meshes,
                       rows);
        shown.update(i + 1);
    }
    return rows;
}

}  // namespace aabblab
