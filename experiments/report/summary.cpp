module;
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

module aabblab.report;

import aabb;
import aabblab.results;
import aabblab.statistics;

namespace aabblab {

namespace {

constexpr std::array<name_part, 6> composition_parts{{{"sort", &contender_name::sort},
                                                      {"partition", &contender_name::partition},
                                                      {"sweep", &contender_name::sweep},
                                                      {"split_large", &contender_name::split_large},
                                                      {"tree", &contender_name::tree},
                                                      {"triangle", &contender_name::triangle}}};

std::optional<double> ms_a_frame(const row& r) {
    if (!r.first_ms || r.frames == 1) return r.first_ms;
    return (*r.update_ms + *r.search_ms + *r.detect_ms) / static_cast<double>(r.frames - 1);
}

std::string answer_of(const row& r) {
    if (r.status == "exact" || !r.missing) return r.status;
    return fmt::format("-{} +{}", *r.missing, *r.invented);
}

/// Of the parts whose columns are to be counted.
template <class Counted>
std::optional<std::uint64_t> bytes_of(const row& r, Counted counted) {
    std::uint64_t all = 0;
    for (std::size_t i = 0; i < byte_columns.size(); ++i)
        if (counted(byte_columns[i])) all += r.bytes[i].value_or(0);
    return all > 0 ? std::optional(all) : std::nullopt;
}

std::optional<double> bytes_a_triangle(const row& r) {
    const auto trees = bytes_of(r, [](std::string_view part) { return part == "nodes" || part == "indices"; });
    if (!trees || r.triangles.value_or(0) == 0) return std::nullopt;
    return static_cast<double>(*trees) / static_cast<double>(*r.triangles);
}

summary_line line_of(std::span<const row* const> repeats) {
    const row& any = *repeats[0];
    summary_line line;
    line.name = any.name;
    line.pairs = any.candidates;
    line.contacts = any.contacts;
    line.answer = answer_of(any);
    line.bytes = bytes_of(any, [](std::string_view part) { return part != "triangles" && part != "vertices"; });
    line.bytes_a_triangle = bytes_a_triangle(any);
    line.box_inflation = any.box_inflation;
    line.counts = any.counts;
    line.bytes_by_part = any.bytes;
    std::vector<double> times, builds;
    for (const row* r : repeats)
        if (const std::optional<double> ms = ms_a_frame(*r)) {
            times.push_back(*ms);
            builds.push_back(*r->build_ms);
        }
    if (times.empty()) return line;
    line.ms_a_frame = quartiles_of(times);
    line.build_ms = quartiles_of(builds).median;
    return line;
}

/// The line's times over those of another in the same repeats.
void set_ratio(summary_line& line, std::span<const row* const> repeats, std::span<const row* const> base) {
    std::vector<double> ratios;
    for (const row* r : repeats)
        for (const row* b : base)
            if (r->repeat == b->repeat && ms_a_frame(*r) && ms_a_frame(*b).value_or(0) > 0)
                ratios.push_back(*ms_a_frame(*r) / *ms_a_frame(*b));
    if (ratios.empty()) return;
    line.ratio = quartiles_of(ratios).median;
    line.ratio_interval = median_interval(ratios);
}

/// Finds what differs between the compositions and what they share, and names the lines by what differs.
void set_labels(scene_summary& scene) {
    for (const name_part& part : composition_parts) {
        std::set<std::string> values;
        for (const summary_line& line : scene.lines)
            if (line.name.engine.empty()) values.insert(line.name.*part.field);
        if (values.size() > 1)
            scene.differing.push_back(part);
        else if (!values.empty() && !values.begin()->empty() && *values.begin() != "off")
            scene.common += (scene.common.empty() ? "" : ", ") + std::string(part.kind) + " " + *values.begin();
    }
    for (summary_line& line : scene.lines) {
        line.label = line.name.engine;
        if (!line.label.empty()) continue;
        for (const name_part& part : scene.differing) {
            const std::string& value = line.name.*part.field;
            // A size does not speak for itself, as the name of a strategy does.
            const bool is_size = part.field == &contender_name::split_large;
            if (is_size && value == "off") continue;
            line.label += (line.label.empty() ? "" : " + ") + (is_size ? "split_large=" + value : value);
        }
        if (line.label.empty()) line.label = "this composition";
    }
}

/// Decimals that leave the fastest line of a scene three digits or more.
int decimals_of(const scene_summary& scene) {
    double least = 100;
    for (const summary_line& line : scene.lines)
        if (line.ms_a_frame) least = std::min(least, line.ms_a_frame->median);
    return least < 1 ? 4 : least < 10 ? 3 : 2;
}

/// Three digits that count.
std::string three_digits(double value) {
    return fmt::format("{:.{}f}", value, value < 0.1 ? 4 : value < 1 ? 3 : value < 10 ? 2 : value < 100 ? 1 : 0);
}

/// The cells of a line from its times, "-" for what was not timed.
std::vector<std::string> time_cells(const summary_line& line, int decimals, number_style style) {
    if (!line.ms_a_frame) return {"-", "-", "-", "-"};
    const auto [low, median, high] = *line.ms_a_frame;
    const bool plain = style == number_style::plain;
    const std::string ratio = line.ratio ? fmt::format("{:.{}f}", *line.ratio, plain ? 6 : 2) : "-";
    const std::string around = line.ratio_interval
                                   ? fmt::format("{:.{}f}-{:.{}f}", line.ratio_interval->low, plain ? 6 : 2,
                                                 line.ratio_interval->high, plain ? 6 : 2)
                                   : "-";
    if (plain) return {fmt::format("{:.6f}", median), fmt::format("{:.6f}-{:.6f}", low, high), ratio, around};
    return {fmt::format("{:.{}f}", median, decimals), three_digits(low) + "-" + three_digits(high), ratio, around};
}

std::string build_cell(double ms, number_style style) {
    return fmt::format("{:.{}f}", ms, style == number_style::plain ? 6 : 2);
}

std::string bytes_cell(const std::optional<std::uint64_t>& bytes, number_style style) {
    if (!bytes) return "-";
    if (style == number_style::plain) return std::to_string(*bytes);
    const double kib = static_cast<double>(*bytes) / 1024;
    return kib < 100 ? fmt::format("{:.1f}", kib) : number_text(static_cast<std::uint64_t>(std::llround(kib)), style);
}

}  // namespace

std::string number_text(std::uint64_t n, number_style style) {
    std::string digits = std::to_string(n);
    if (style == number_style::plain) return digits;
    for (std::size_t at = digits.size(); at > 3;) digits.insert(at -= 3, ",");
    return digits;
}

std::vector<column> name_columns_of(const scene_summary& scene) {
    std::vector<column> columns;
    for (const name_part& part : scene.differing) columns.push_back({std::string(part.kind), false});
    if (columns.empty()) columns.push_back({"composition", false});
    return columns;
}

std::vector<std::string> name_cells_of(const scene_summary& scene, const summary_line& line) {
    std::vector<std::string> cells;
    if (line.name.engine.empty())
        for (const name_part& part : scene.differing) cells.push_back(line.name.*part.field);
    if (cells.empty()) cells.push_back(line.label);
    cells.resize(std::max<std::size_t>(scene.differing.size(), 1));
    return cells;
}

std::vector<scene_summary> summarise(std::span<const row> rows) {
    struct group {
        scene_summary scene;
        std::vector<std::vector<const row*>> lines;
    };
    std::vector<group> groups;
    for (const row& r : rows) {
        auto g = std::ranges::find_if(groups, [&](const group& other) {
            return other.scene.scene == r.scene && other.scene.parameters == r.scene_parameters;
        });
        if (g == groups.end()) {
            g = groups.emplace(g);
            g->scene.experiment = r.experiment;
            g->scene.scene = r.scene;
            g->scene.parameters = r.scene_parameters;
            g->scene.objects = r.objects;
            g->scene.frames = r.frames;
        }
        auto line = std::ranges::find_if(g->lines, [&](const auto& other) { return other[0]->name == r.name; });
        if (line == g->lines.end()) line = g->lines.insert(line, std::vector<const row*>{});
        line->push_back(&r);
        if (r.status == "exact") g->scene.digest = r.digest;
    }
    std::vector<scene_summary> scenes;
    for (group& g : groups) {
        for (const auto& line : g.lines) {
            g.scene.lines.push_back(line_of(line));
            set_ratio(g.scene.lines.back(), line, g.lines[0]);
        }
        set_labels(g.scene);
        scenes.push_back(std::move(g.scene));
    }
    return scenes;
}

table table_of(const scene_summary& scene, number_style style) {
    const bool meshes = std::ranges::any_of(scene.lines, [](const summary_line& l) { return l.contacts.has_value(); });
    const bool timed = std::ranges::any_of(scene.lines, [](const summary_line& l) { return l.ms_a_frame.has_value(); });
    const bool sized = std::ranges::any_of(scene.lines, [](const summary_line& l) { return l.bytes.has_value(); });
    const int decimals = decimals_of(scene);
    table t{name_columns_of(scene), {}};
    t.columns.insert(t.columns.end(), {{"answer", false}, {"pairs"}});
    if (meshes) t.columns.push_back({"contacts"});
    if (timed) t.columns.insert(t.columns.end(), {{"ms/frame"}, {"quartiles"}, {"ratio"}, {"95 %"}});
    if (timed && meshes) t.columns.push_back({"build"});
    if (sized) t.columns.push_back({style == number_style::plain ? "bytes" : "KiB"});
    for (const summary_line& line : scene.lines) {
        std::vector<std::string>& cells = t.rows.emplace_back(name_cells_of(scene, line));
        cells.insert(cells.end(), {line.answer, number_text(line.pairs, style)});
        if (meshes) cells.push_back(line.contacts ? number_text(*line.contacts, style) : "-");
        if (timed)
            for (std::string& cell : time_cells(line, decimals, style)) cells.push_back(std::move(cell));
        if (timed && meshes) cells.push_back(line.build_ms ? build_cell(*line.build_ms, style) : "-");
        if (sized) cells.push_back(bytes_cell(line.bytes, style));
    }
    return t;
}

std::string heading_of(const scene_summary& scene) {
    std::string text = fmt::format("{}: {} objects, {} frames\n{}\n", scene.scene,
                                   number_text(scene.objects, number_style::grouped), scene.frames, scene.parameters);
    if (!scene.common.empty()) text += "all compositions: " + scene.common + "\n";
    if (!scene.digest.empty()) text += "digest of the exact answer: " + scene.digest + "\n";
    const auto is_inexact = [](const summary_line& line) { return line.answer != "exact"; };
    if (std::ranges::any_of(scene.lines, is_inexact))
        text += "an answer -3 +5 misses 3 of the exact answer and invents 5\n";
    return text;
}

}  // namespace aabblab
