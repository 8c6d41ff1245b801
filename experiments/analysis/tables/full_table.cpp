module;
#include <fmt/format.h>

module aabblab.tables;

import aabblab.digits;

namespace aabblab {

namespace {

std::string text_of(const std::optional<std::uint64_t>& value) {
    return value ? fmt::format("{}", *value) : "";
}

/// Those that are more than a median of rows.
bool has_own_column(const metric& m) {
    constexpr std::array<std::string_view, 5> own{"frame_ms", "build_ms", "all_bytes", "missing", "invented"};
    return std::ranges::find(own, m.name) != own.end();
}

std::vector<std::string> cells_of(const scene_summary& scene, const summary_line& line, std::size_t rank) {
    std::vector<std::string> cells{scene.experiment,
                                   scene.scene.kind,
                                   parameters_json(scene.scene),
                                   fmt::format("{}", fmt::join(scene.seeds, " ")),
                                   fmt::format("{}", scene.objects),
                                   fmt::format("{}", scene.frames)};
    for (const aabb::strategy_kind kind : aabb::strategy_kinds) cells.push_back(line.name[kind]);
    cells.insert(cells.end(),
                 {line.name.engine, fmt::format("{}", rank), line.status, text_of(line.missing), text_of(line.invented),
                  fmt::format("{}", line.pairs), text_of(line.contacts), fmt::format("{}", line.repeats)});
    const auto& ms = line.ms_a_frame;
    const auto& around = line.ratio_interval;
    for (const std::optional<double>& value :
         {ms ? std::optional(ms->median) : std::nullopt, ms ? std::optional(ms->low) : std::nullopt,
          ms ? std::optional(ms->high) : std::nullopt, line.ratio, around ? std::optional(around->low) : std::nullopt,
          around ? std::optional(around->high) : std::nullopt, line.build_ms})
        cells.push_back(value ? fmt::format("{:.6f}", *value) : "");
    cells.push_back(text_of(line.bytes));
    for (std::size_t i = 0; i < metrics().size(); ++i)
        if (!has_own_column(metrics()[i])) cells.push_back(line.metrics[i] ? fifteen_digits(*line.metrics[i]) : "");
    return cells;
}

}  // namespace

table full_table_of(std::span<const scene_summary> scenes) {
    table t;
    for (const char* name : {"experiment", "scene", "scene_parameters", "seeds", "objects", "frames"})
        t.columns.push_back({name});
    for (const aabb::strategy_kind kind : aabb::strategy_kinds) t.columns.push_back({std::string(name_of(kind))});
    for (const char* name :
         {"engine", "rank", "status", "missing", "invented", "candidates", "contacts", "repeats", "frame_ms",
          "frame_ms_low", "frame_ms_high", "ratio", "ratio_low", "ratio_high", "build_ms", "all_bytes"})
        t.columns.push_back({name});
    for (const metric& m : metrics())
        if (!has_own_column(m)) t.columns.push_back({m.name});
    for (const scene_summary& scene : scenes) {
        std::size_t rank = 0;
        for (const summary_line* line : ranking_of(scene)) t.rows.push_back(cells_of(scene, *line, ++rank));
    }
    return t;
}

}  // namespace aabblab
