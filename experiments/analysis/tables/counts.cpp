module;
#include <fmt/format.h>

module aabblab.tables;

import aabblab.numbers;

namespace aabblab {

namespace {

/// Whether any composition has a number other than 0 in this place.
template <class Numbers>
bool is_used(const scene_summary& scene, Numbers summary_line::* numbers, std::size_t place) {
    return std::ranges::any_of(scene.lines, [&](const summary_line& line) {
        return !line.name.is_reference() && (line.*numbers)[place].value_or(0) > 0;
    });
}

std::string spaced(std::string_view name) {
    std::string text(name);
    std::ranges::replace(text, '_', ' ');
    return text;
}

std::string count_text(double value) {
    return value != 0 && value < 100 ? fmt::format("{:.1f}", value)
                                     : grouped(static_cast<std::uint64_t>(std::llround(value)));
}

}  // namespace

table counts_table_of(const scene_summary& scene) {
    constexpr auto copies = static_cast<std::size_t>(aabb::work::subset_copies);
    table t{name_columns_of(scene.differing), {}};
    std::vector<std::size_t> works;
    std::vector<std::size_t> parts;
    for (std::size_t i = 0; i < aabb::work_names.size(); ++i) {
        if (!is_used(scene, &summary_line::counts, i)) continue;
        works.push_back(i);
        t.columns.push_back({spaced(aabb::work_names[i])});
        if (i == copies) t.columns.push_back({"copies an object"});
    }
    for (std::size_t i = 0; i < byte_columns.size(); ++i) {
        // The meshes are the same for all.
        if (byte_columns[i] == "triangles" || byte_columns[i] == "vertices") continue;
        if (!is_used(scene, &summary_line::bytes_by_part, i)) continue;
        parts.push_back(i);
        t.columns.push_back({"KiB " + spaced(byte_columns[i])});
    }
    if (works.empty() && parts.empty()) return {};
    const bool trees =
        std::ranges::any_of(scene.lines, [](const summary_line& line) { return line.bytes_a_triangle.has_value(); });
    const bool inflated =
        std::ranges::any_of(scene.lines, [](const summary_line& line) { return line.box_inflation.value_or(0) > 0; });
    if (trees) t.columns.push_back({"tree bytes a triangle"});
    if (inflated) t.columns.push_back({"box inflation %"});
    std::size_t rank = 0;
    for (const summary_line* line : ranking_of(scene)) {
        ++rank;
        if (line->name.is_reference()) continue;
        std::vector<std::string>& cells = t.rows.emplace_back(name_cells_of(scene.differing, line->name, rank));
        for (const std::size_t i : works) {
            const double each = line->counts[i].value_or(0);
            cells.push_back(count_text(each));
            if (i == copies) cells.push_back(fmt::format("{:.3f}", each / static_cast<double>(scene.objects)));
        }
        for (const std::size_t i : parts) cells.push_back(kib_text(line->bytes_by_part[i].value_or(0)));
        if (trees) cells.push_back(text_or_dash(line->bytes_a_triangle, 2));
        if (inflated) cells.push_back(line->box_inflation ? fmt::format("{:.3f}", 100 * *line->box_inflation) : "-");
    }
    return t;
}

}  // namespace aabblab
