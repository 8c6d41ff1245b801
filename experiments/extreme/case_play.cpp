module aabblab.extreme;

import :contenders;
import aabb.base;
import aabb.geometry;
import aabb.pipeline;
import aabb.registry;
import aabb.validation;

namespace aabblab {

namespace {

extreme_row row_of(const aabb::triangle_case& one, std::string contender, contender_role role, bool must_be_exact) {
    return {row_group::cases, one.name, one.about, one.kind, std::move(contender), role, must_be_exact, true, {}};
}

/// Counts an answer that is not the true one.
void hold(bool answer, bool truth, extreme_row& row) {
    if (answer == truth) return;
    ++(truth ? row.made.missing : row.made.invented);
    row.made.said = aabb::verdict::wrong;
    row.made.reason = truth ? "says that they do not intersect" : "says that they intersect";
    row.as_expected = !row.must_be_exact;
}

template <class Real>
extreme_row played(const aabb::triangle_case& one, const named_test& test, bool truth, const char* precision) {
    extreme_row row = row_of(one, test.name + " in " + precision, contender_role::triangle_test, test.exact);
    for (const aabb::triangle_pair<Real>& pair : aabb::every_order<Real>(one))
        hold(test.test->intersects(pair.a, pair.b), truth, row);
    return row;
}

void play_tests(std::span<const aabb::triangle_case> cases, std::vector<extreme_row>& rows) {
    for (const named_test& test : all_triangle_tests())
        for (const aabb::triangle_case& one : cases) {
            rows.push_back(played<float>(one, test, one.intersect, "float"));
            if (test.test->takes_double()) rows.push_back(played<double>(one, test, one.intersect_double, "double"));
        }
}

/// The first triangle of each case, then the second, a mesh each.
std::vector<aabb::mesh> meshes_of(std::span<const aabb::triangle_case> cases) {
    std::vector<aabb::mesh> all;
    for (const aabb::triangle_case& one : cases)
        for (const aabb::triangle3d* t : {&one.first, &one.second}) {
            const aabb::triangle3f corners = aabb::in_float(*t);
            all.push_back({{corners[0], corners[1], corners[2]}, {{0, 1, 2}}});
        }
    return all;
}

/// Either triangle against the other, by every query.
void play_stage(std::span<const aabb::triangle_case> cases, std::span<const aabb::mesh> meshes,
                aabb::local_stage& stage, const extreme_row& form, std::vector<extreme_row>& rows) {
    for (const aabb::mesh& m : meshes) stage.add_model(m);
    for (std::size_t i = 0; i < cases.size(); ++i) {
        extreme_row row = row_of(cases[i], form.contender, form.role, form.must_be_exact);
        const auto first = static_cast<std::uint32_t>(2 * i);
        for (const auto [a, b] : {std::array{first, first + 1}, std::array{first + 1, first}}) {
            std::vector<aabb::index_pair> pairs;
            stage.all_pairs(a, {}, b, {}, pairs);
            hold(!pairs.empty(), cases[i].intersect, row);
            hold(stage.first_pair(a, {}, b, {}).has_value(), cases[i].intersect, row);
            hold(stage.count_pairs(a, {}, b, {}) == 1, cases[i].intersect, row);
        }
        rows.push_back(std::move(row));
    }
}

}  // namespace

std::vector<extreme_row> play_cases(std::span<const aabb::triangle_case> cases) {
    std::vector<extreme_row> rows;
    play_tests(cases, rows);
    const std::vector<aabb::mesh> meshes = meshes_of(cases);
    extreme_row form;
    for (const aabb::composition& c : exact_compositions(aabb::stage::local_detection, true)) {
        form.contender = to_text(c, aabb::stage::local_detection);
        play_stage(cases, meshes, *aabb::compose_local_detection(c, aabb::instrumentation::none), form, rows);
    }
    form.role = contender_role::engine;
    for (const aabb::engine_info& engine : aabb::engines()) {
        if (!engine.collides_meshes) continue;
        form.contender = engine.name;
        form.must_be_exact = engine.exact;
        play_stage(cases, meshes, *aabb::make_mesh_engine(engine.name), form, rows);
    }
    return rows;
}

}  // namespace aabblab
