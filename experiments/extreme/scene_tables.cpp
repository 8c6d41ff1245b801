module aabblab.extreme;

import :cells;
import aabb.validation;
import aabblab.numbers;

namespace aabblab {

table scene_table(std::span<const extreme_row> rows, row_group group) {
    std::vector<extreme_row> shown;
    for (const extreme_row& row : rows)
        if (row.group == group && row.role != contender_role::triangle_test) shown.push_back(row);
    table t{{{"scene", false}, {"compositions"}}, {}};
    const std::vector<std::string> engines = contenders_in(shown, contender_role::engine);
    for (const std::string& engine : engines) t.columns.push_back({engine});
    for (const auto& [scene, of_scene] : by(shown, &extreme_row::scene)) {
        std::vector<std::string> cells{scene, sum_cell(of(of_scene, contender_role::composition))};
        for (const std::string& engine : engines) cells.push_back(cell(of(of_scene, engine)));
        t.rows.push_back(std::move(cells));
    }
    return t;
}

table inexact_scene_table(std::span<const extreme_row> rows) {
    std::vector<extreme_row> shown;
    for (const extreme_row& row : rows)
        if (row.group == row_group::meshes && row.role == contender_role::triangle_test) shown.push_back(row);
    return wrong_table("scene", shown, &extreme_row::scene);
}

table class_table(std::span<const extreme_row> rows) {
    table t{{{"may be inexact", false}}, {}};
    for (const std::string_view name : aabb::difference_class_names) t.columns.push_back({std::string(name)});
    std::vector<extreme_row> shown;
    for (const extreme_row& row : rows)
        if (row.group == row_group::meshes && !row.must_be_exact) shown.push_back(row);
    for (const auto& [name, of_contender] : by(shown, &extreme_row::contender)) {
        aabb::differences sum;
        for (const extreme_row* row : of_contender) sum += row->made.classes;
        std::vector<std::string> cells{name};
        for (std::size_t c = 0; c < sum.missing.size(); ++c) cells.push_back(counts(sum.missing[c], sum.invented[c]));
        t.rows.push_back(std::move(cells));
    }
    return t;
}

std::vector<std::string> memory_in(std::span<const extreme_row> rows, std::span<const aabb::extreme_scene> scenes) {
    std::vector<std::string> all;
    for (const aabb::extreme_scene& scene : scenes) {
        if (scene.most_bytes == 0) continue;
        std::size_t most = 0;
        for (const extreme_row& row : rows)
            if (row.scene == scene.name && row.role == contender_role::composition)
                most = std::max(most, row.made.bytes);
        all.push_back(scene.name + ", " + scene.summary + ":\n  compositions hold at most " + grouped(most) +
                      " bytes, of " + grouped(scene.most_bytes) + " stated");
    }
    return all;
}

}  // namespace aabblab
