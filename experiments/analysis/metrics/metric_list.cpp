module;
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <initializer_list>
#include <optional>
#include <span>
#include <vector>

module aabblab.metrics;

import aabblab.results;

namespace aabblab {

namespace {

/// The times of a row by one of the clocks.
struct clock {
    std::optional<double> row::*build, row::*first, row::*update, row::*search, row::*detect;
};
constexpr clock wall{&row::build_ms, &row::first_ms, &row::update_ms, &row::search_ms, &row::detect_ms};
constexpr clock cpu{&row::build_cpu_ms, &row::first_cpu_ms, &row::update_cpu_ms, &row::search_cpu_ms,
                    &row::detect_cpu_ms};

/// The column as it is.
template <class Number>
row_value column(std::optional<Number> row::* of) {
    return [of](const row& r) -> std::optional<double> {
        return r.*of ? std::optional(static_cast<double>(*(r.*of))) : std::nullopt;
    };
}

double sum(const row& r, std::initializer_list<std::optional<double> row::*> of) {
    double all = 0;
    for (const auto one : of) all += *(r.*one);
    return all;
}

row_value whole_frame(const clock& by) {
    return [by](const row& r) -> std::optional<double> {
        if (!(r.*by.update) || r.frames == 1) return r.*by.first;
        return sum(r, {by.update, by.search, by.detect}) / frames_after_first(r);
    };
}

row_value whole_run(const clock& by) {
    return [by](const row& r) -> std::optional<double> {
        if (!(r.*by.update)) return std::nullopt;
        return sum(r, {by.build, by.first, by.update, by.search, by.detect});
    };
}

std::optional<double> global_cpu_ms(const row& r) {
    if (!r.update_cpu_ms || r.frames == 1) return std::nullopt;
    return sum(r, {cpu.update, cpu.search}) / frames_after_first(r);
}

std::optional<double> global_share(const row& r) {
    if (!r.update_cpu_ms || !r.detect_cpu_ms || r.frames == 1) return std::nullopt;
    const double global = sum(r, {cpu.update, cpu.search});
    return 100 * global / (global + *r.detect_cpu_ms);
}

std::optional<double> waiting(const row& r) {
    if (!r.update_cpu_ms || !r.update_ms) return std::nullopt;
    const auto frames = [&](const clock& by) { return sum(r, {by.first, by.update, by.search, by.detect}); };
    const double all = frames(wall);
    return all > 0 ? std::optional(100 * std::max(0.0, 1 - frames(cpu) / all)) : std::nullopt;
}

std::optional<double> all_bytes(const row& r) {
    std::uint64_t all = 0;
    for (std::size_t i = 0; i < byte_columns.size(); ++i)
        if (byte_columns[i] != "triangles" && byte_columns[i] != "vertices") all += r.bytes[i].value_or(0);
    // An engine need not say.
    return all > 0 ? std::optional(static_cast<double>(all)) : std::nullopt;
}

std::optional<double> tree_bytes(const row& r) {
    static const row_value ours = a_triangle(bytes_of({"nodes", "indices"}));
    // What of an engine's bytes is its tree is not known.
    return r.name.is_reference() ? std::nullopt : ours(r);
}

std::optional<double> wrong_share(const row& r) {
    if (!r.missing) return std::nullopt;
    const auto found = static_cast<double>(r.contacts ? *r.contacts : r.candidates);
    const auto missing = static_cast<double>(*r.missing);
    const auto invented = static_cast<double>(*r.invented);
    return (missing + invented) / std::max(found - invented + missing, 1.0);
}

std::vector<metric> listed() {
    using enum better;
    constexpr auto time = metric_group::time;
    constexpr auto bytes = metric_group::bytes;
    constexpr auto error = metric_group::error;
    return {
        {"frame_ms", "ms", "time a frame after frame 0, all of it; of frame 0 where there is no other", time, less,
         whole_frame(wall)},
        {"update_ms", "ms", "time a frame to take the boxes: to sort and to partition them", time, less,
         a_frame(wall.update)},
        {"search_ms", "ms", "time a frame to find overlapping boxes", time, less, a_frame(wall.search)},
        {"detect_ms", "ms", "time a frame to find intersecting triangles", time, less, a_frame(wall.detect)},
        {"global_share", "%", "share of global search in the processor time of the frames after frame 0", time, neither,
         global_share},
        {"build_ms", "ms", "time to make the stages and build the trees", time, less, column(wall.build)},
        {"first_ms", "ms", "time of frame 0", time, less, column(wall.first)},
        {"whole_ms", "ms", "time of all frames, frame 0 and the making of the stages with them", time, less,
         whole_run(wall)},
        {"frame_cpu_ms", "ms", "processor time a frame after frame 0, all of it; of frame 0 where there is no other",
         time, less, whole_frame(cpu)},
        {"update_cpu_ms", "ms", "processor time a frame to take the boxes: to sort and to partition them", time, less,
         a_frame(cpu.update)},
        {"search_cpu_ms", "ms", "processor time a frame to find overlapping boxes", time, less, a_frame(cpu.search)},
        {"global_cpu_ms", "ms", "processor time of global search a frame after frame 0", time, less, global_cpu_ms},
        {"detect_cpu_ms", "ms", "processor time a frame to find intersecting triangles", time, less,
         a_frame(cpu.detect)},
        {"build_cpu_ms", "ms", "processor time to make the stages and build the trees", time, less, column(cpu.build)},
        {"whole_cpu_ms", "ms", "processor time of all frames, frame 0 and the making of the stages with them", time,
         less, whole_run(cpu)},
        {"waiting", "%", "share of the wall time of all frames in which the thread had no processor", time, less,
         waiting},
        {"all_bytes", "bytes", "memory of all parts but the meshes, which every composition reads", bytes, less,
         all_bytes},
        {"tree_bytes", "bytes a triangle", "memory of the trees", bytes, less, tree_bytes},
        {"missing", "", "pairs of the exact answer that are not found, over all frames", error, less,
         column(&row::missing)},
        {"invented", "", "pairs that are found and not in the exact answer, over all frames", error, less,
         column(&row::invented)},
        {"wrong_share", "", "pairs missing and invented, over those of the exact answer, or over one where it has none",
         error, less, wrong_share},
        {"box_inflation", "", "area of the boxes of a tree over that of the smallest ones, less 1", error, less,
         column(&row::box_inflation)}};
}

}  // namespace

std::span<const metric> metrics() {
    static const std::vector<metric> all = [] {
        std::vector<metric> made = listed();
        for (const metric& counted : work_metrics()) made.push_back(counted);
        return made;
    }();
    return all;
}

}  // namespace aabblab
