module;
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <string_view>
#include <tuple>
#include <utility>
#include <vector>

module aabblab.tables;

import aabb;
import aabblab.results;
import aabblab.statistics;

namespace aabblab {

namespace {

using repeats_of_line = std::vector<const row*>;

std::optional<double> ms_a_frame(const row& r) {
    if (!r.first_ms || r.frames == 1) return r.first_ms;
    return (*r.update_ms + *r.search_ms + *r.detect_ms) / static_cast<double>(r.frames - 1);
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

void add(std::optional<std::uint64_t>& sum, const std::optional<std::uint64_t>& more) {
    if (more) sum = sum.value_or(0) + *more;
}
void add(std::optional<double>& sum, const std::optional<double>& more) {
    if (more) sum = sum.value_or(0) + *more;
}

/// What does not vary between the repeats of a seed.
void add_seed(const row& r, double share, summary_line& line) {
    line.pairs += r.candidates;
    add(line.contacts, r.contacts);
    add(line.missing, r.missing);
    add(line.invented, r.invented);
    if (line.status != "inexact") line.status = r.status;
    line.bytes = std::max(line.bytes,
                          bytes_of(r, [](std::string_view part) { return part != "triangles" && part != "vertices"; }));
    line.bytes_a_triangle = std::max(line.bytes_a_triangle, bytes_a_triangle(r));
    if (r.box_inflation) add(line.box_inflation, *r.box_inflation * share);
    const double frames = r.frames > 1 ? static_cast<double>(r.frames - 1) : 1;
    for (std::size_t i = 0; i < r.counts.size(); ++i)
        if (r.counts[i]) add(line.counts[i], static_cast<double>(*r.counts[i]) / frames * share);
    for (std::size_t i = 0; i < r.bytes.size(); ++i)
        line.bytes_by_part[i] = std::max(line.bytes_by_part[i], r.bytes[i]);
}

summary_line line_of(std::span<const row* const> repeats) {
    summary_line line;
    line.name = repeats[0]->name;
    line.repeats = repeats.size();
    std::map<std::string_view, const row*> seeds;
    for (const row* r : repeats) seeds.emplace(r->scene_parameters, r);
    for (const auto& [seed, r] : seeds) add_seed(*r, 1 / static_cast<double>(seeds.size()), line);
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

/// The line's times over those of another in the same repeats of the same seeds.
void set_ratio(summary_line& line, std::span<const row* const> repeats, std::span<const row* const> base) {
    std::map<std::pair<std::string_view, std::uint64_t>, double> base_ms;
    for (const row* b : base)
        if (ms_a_frame(*b).value_or(0) > 0)
            base_ms.emplace(std::pair(std::string_view(b->scene_parameters), b->repeat), *ms_a_frame(*b));
    std::map<std::string_view, std::size_t> seeds;
    std::map<std::uint64_t, std::size_t> processes;
    for (const row* r : repeats) {
        seeds.emplace(r->scene_parameters, seeds.size());
        processes.emplace(r->process, processes.size());
    }
    cells ratios(processes.size(), seeds.size());
    std::size_t count = 0;
    for (const row* r : repeats) {
        const auto under = base_ms.find({r->scene_parameters, r->repeat});
        if (under == base_ms.end() || ms_a_frame(*r).value_or(0) <= 0) continue;
        ratios.add(processes.at(r->process), seeds.at(r->scene_parameters), std::log(*ms_a_frame(*r) / under->second));
        ++count;
    }
    if (count == 0) return;
    const estimate log_ratio = bootstrap(ratios);
    line.ratio = std::exp(log_ratio.value);
    if (count == 1) return;
    const auto [low, high] = log_ratio.range();
    line.ratio_interval = {std::exp(low), std::exp(high)};
}

/// Finds what differs between the compositions and what they share, and names the lines by what differs.
void set_labels(scene_summary& scene) {
    std::vector<contender_name> names;
    for (const summary_line& line : scene.lines) names.push_back(line.name);
    scene.differing = differing_parts(names);
    const auto composition = std::ranges::find(names, "", &contender_name::engine);
    for (const name_part& part : composition_parts) {
        const auto is_part = [&](const name_part& other) { return other.kind == part.kind; };
        if (composition == names.end() || std::ranges::any_of(scene.differing, is_part)) continue;
        const std::string& value = (*composition).*part.field;
        if (!value.empty() && value != "off")
            scene.common += (scene.common.empty() ? "" : ", ") + std::string(part.kind) + " " + value;
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

/// The rows of a scene, whatever its seeds, by who played.
struct rows_of_scene {
    scene_summary scene;
    std::vector<repeats_of_line> lines;
    std::map<contender_name, std::size_t> places;  // of lines

    void add(const row& r) {
        const auto [place, is_new] = places.emplace(r.name, lines.size());
        if (is_new) lines.emplace_back();
        lines[place->second].push_back(&r);
        if (std::ranges::find(scene.seeds, seed_of(r.scene_parameters)) == scene.seeds.end())
            scene.seeds.push_back(seed_of(r.scene_parameters));
        if (r.status == "exact") scene.digest = r.digest;
    }
};

}  // namespace

std::vector<scene_summary> summarise(std::span<const row> rows) {
    std::vector<rows_of_scene> all;
    std::map<std::tuple<std::string, std::string, std::string>, std::size_t> places;
    for (const row& r : rows) {
        const std::string parameters = without_seed(r.scene_parameters);
        const auto [place, is_new] = places.emplace(std::tuple(r.experiment, r.scene, parameters), all.size());
        if (is_new) {
            scene_summary& scene = all.emplace_back().scene;
            scene.experiment = r.experiment;
            scene.scene = r.scene;
            scene.parameters = parameters;
            scene.objects = r.objects;
            scene.frames = r.frames;
        }
        all[place->second].add(r);
    }
    std::vector<scene_summary> scenes;
    for (rows_of_scene& one : all) {
        for (const repeats_of_line& repeats : one.lines) {
            one.scene.lines.push_back(line_of(repeats));
            set_ratio(one.scene.lines.back(), repeats, one.lines[0]);
        }
        if (one.scene.seeds.size() > 1) one.scene.digest.clear();
        set_labels(one.scene);
        scenes.push_back(std::move(one.scene));
    }
    return scenes;
}

std::vector<const summary_line*> ranking_of(const scene_summary& scene) {
    std::vector<const summary_line*> lines;
    for (const summary_line& line : scene.lines) lines.push_back(&line);
    const auto key = [](const summary_line* line) {
        const double ms = line->ms_a_frame ? line->ms_a_frame->median : 0;
        return std::tuple(!line->ms_a_frame, line->status != "exact", line->ratio.value_or(ms), ms, line);
    };
    std::ranges::sort(lines, {}, key);
    return lines;
}

}  // namespace aabblab
