module aabblab.metrics;

import aabb.counters;
import aabb.policy;

namespace aabblab {

namespace {

using optional_number = std::optional<double>;
using time_column = optional_number row::*;

/// The columns of one clock: wall time, or processor time of the thread.
struct times {
    time_column build, first, update, search, detect;
};
constexpr times wall{&row::build_ms, &row::first_ms, &row::update_ms, &row::search_ms, &row::detect_ms};
constexpr times processor{&row::build_cpu_ms, &row::first_cpu_ms, &row::update_cpu_ms, &row::search_cpu_ms,
                          &row::detect_cpu_ms};

metric time_metric(std::string name, std::string summary, row_value ms) {
    return {std::move(name), "ms", std::move(summary), metric_group::time, better::less, std::move(ms)};
}

metric error_metric(std::string name, std::string summary, row_value error) {
    return {std::move(name), "", std::move(summary), metric_group::error, better::less, std::move(error)};
}

/// The number of frames after frame 0; 1 if there is only that one.
double frames_after_first(const row& r) {
    return r.frames > 1 ? static_cast<double>(r.frames - 1) : 1;
}

/// The mean of a sum per frame after frame 0; empty if there is no such frame.
row_value per_frame(time_column sum) {
    return [sum](const row& r) -> optional_number {
        return r.*sum && r.frames > 1 ? optional_number(*(r.*sum) / frames_after_first(r)) : std::nullopt;
    };
}

/// The time of all stages per frame after frame 0; that of frame 0 if it is the only one.
row_value frame_time(const times& t) {
    return [t](const row& r) -> optional_number {
        if (!(r.*t.update) || r.frames == 1) return r.*t.first;
        return (*(r.*t.update) + *(r.*t.search) + *(r.*t.detect)) / frames_after_first(r);
    };
}

/// The time of all frames, including frame 0 and the construction of the stages.
row_value whole_time(const times& t) {
    return [t](const row& r) -> optional_number {
        if (!(r.*t.update)) return std::nullopt;
        return *(r.*t.build) + *(r.*t.first) + *(r.*t.update) + *(r.*t.search) + *(r.*t.detect);
    };
}

optional_number global_cpu_ms(const row& r) {
    if (!r.update_cpu_ms || r.frames == 1) return std::nullopt;
    return (*r.update_cpu_ms + *r.search_cpu_ms) / frames_after_first(r);
}

optional_number global_share(const row& r) {
    if (!r.update_cpu_ms || !r.detect_cpu_ms || r.frames == 1) return std::nullopt;
    const double global = *r.update_cpu_ms + *r.search_cpu_ms;
    return 100 * global / (global + *r.detect_cpu_ms);
}

/// The share of the wall time in which the thread did not run, in percent: it shows that a machine was busy.
optional_number waiting(const row& r) {
    if (!r.update_cpu_ms || !r.update_ms) return std::nullopt;
    const double wall_ms = *r.first_ms + *r.update_ms + *r.search_ms + *r.detect_ms;
    const double cpu_ms = *r.first_cpu_ms + *r.update_cpu_ms + *r.search_cpu_ms + *r.detect_cpu_ms;
    return wall_ms > 0 ? optional_number(100 * std::max(0.0, 1 - cpu_ms / wall_ms)) : std::nullopt;
}

optional_number all_bytes(const row& r) {
    std::uint64_t sum = 0;
    for (std::size_t i = 0; i < byte_columns.size(); ++i)
        if (byte_columns[i] != "triangles" && byte_columns[i] != "vertices") sum += r.bytes[i].value_or(0);
    // Engines need not report bytes.
    return sum > 0 ? optional_number(static_cast<double>(sum)) : std::nullopt;
}

/// Empty for engines, because the share of the tree in their bytes is unknown.
optional_number tree_bytes(const row& r) {
    static const row_value bytes_per_triangle = per_triangle(bytes_of({"nodes", "indices"}));
    return r.name.is_reference() ? std::nullopt : bytes_per_triangle(r);
}

/// The errors relative to the number of pairs of the ground truth, or to one if it has none.
optional_number wrong_share(const row& r) {
    if (!r.false_negatives) return std::nullopt;
    const auto reported = static_cast<double>(r.contacts ? *r.contacts : r.candidates);
    const auto false_negatives = static_cast<double>(*r.false_negatives);
    const auto false_positives = static_cast<double>(*r.false_positives);
    return (false_negatives + false_positives) / std::max(reported - false_positives + false_negatives, 1.0);
}

/// The metrics of times, bytes and errors; those that count work are not among them.
std::vector<metric> row_metrics() {
    using enum metric_group;
    const std::string cpu = "processor ";
    const std::string to_update = "time per frame to update the boxes: sorting and partitioning";
    const std::string to_search = "time per frame to find overlapping boxes";
    const std::string to_detect = "time per frame to find intersecting triangles";
    const std::string to_build = "time to construct the stages and build the trees";
    const std::string of_frame = "time per frame after frame 0, of all stages; of frame 0 if it is the only one";
    const std::string of_whole = "time of all frames, including frame 0 and the construction of the stages";
    return {
        time_metric("frame_ms", of_frame, frame_time(wall)),
        time_metric("update_ms", to_update, per_frame(wall.update)),
        time_metric("search_ms", to_search, per_frame(wall.search)),
        time_metric("detect_ms", to_detect, per_frame(wall.detect)),
        {"global_share", "%", "share of the broad phase in the processor time of the frames after frame 0", time,
         better::neither, global_share},
        time_metric("build_ms", to_build, &row::build_ms),
        time_metric("first_ms", "time of frame 0", &row::first_ms),
        time_metric("whole_ms", of_whole, whole_time(wall)),
        time_metric("frame_cpu_ms", cpu + of_frame, frame_time(processor)),
        time_metric("update_cpu_ms", cpu + to_update, per_frame(processor.update)),
        time_metric("search_cpu_ms", cpu + to_search, per_frame(processor.search)),
        time_metric("global_cpu_ms", "processor time of the broad phase per frame after frame 0", global_cpu_ms),
        time_metric("detect_cpu_ms", cpu + to_detect, per_frame(processor.detect)),
        time_metric("build_cpu_ms", cpu + to_build, &row::build_cpu_ms),
        time_metric("whole_cpu_ms", cpu + of_whole, whole_time(processor)),
        {"waiting", "%", "share of the wall time of all frames in which the thread had no processor", time,
         better::less, waiting},
        {"all_bytes", "bytes", "memory of all parts except the meshes, which all compositions share", bytes,
         better::less, all_bytes},
        {"tree_bytes", "bytes per triangle", "memory of the trees", bytes, better::less, tree_bytes},
        error_metric("missing", "false negatives: pairs of the ground truth that are not reported, over all frames",
                     &row::false_negatives),
        error_metric("invented", "false positives: reported pairs that are not in the ground truth, over all frames",
                     &row::false_positives),
        error_metric("wrong_share",
                     "false negatives and false positives per pair of the ground truth; their number if it has no pair",
                     wrong_share),
        error_metric("box_inflation", "area of the boxes of a tree relative to that of the tightest boxes, minus 1",
                     &row::box_inflation),
    };
}

// Counters that describe the input or its partition rather than work.
bool describes_input(aabb::work counted) {
    using enum aabb::work;
    return counted == inversions || counted == subsets || counted == segments_wanted || counted == segments_got ||
           counted == pieces;
}

constexpr auto work_summaries = std::to_array<std::string_view>(
    {"key comparisons of the sort", "list entries moved by the sort", "inversions in the lists before the sort",
     "restarts of an incremental sweep from a sort", "overlap tests of two boxes", "subsets of the partition",
     "entries of boxes in subsets of the partition", "desired segments of an axial cut, over its axes,",
     "actual segments of an axial cut, over its axes,", "pieces of boxes or meshes that were split",
     "visited pairs of tree nodes", "tests of a leaf's triangle against a box", "tests of two triangles"});
static_assert(work_summaries.size() == aabb::work_names.size());

/// Adds one metric per work counter: its value per frame after frame 0; less is better if it counts work.
void add_work_metrics(std::vector<metric>& list) {
    for (std::size_t i = 0; i < aabb::work_names.size(); ++i) {
        list.push_back({std::string(aabb::work_names[i]), "",
                        std::string(work_summaries[i]) + " per frame after frame 0", metric_group::counts,
                        describes_input(static_cast<aabb::work>(i)) ? better::neither : better::less,
                        [i](const row& r) -> std::optional<double> {
                            if (!r.counts[i]) return std::nullopt;
                            return static_cast<double>(*r.counts[i]) / frames_after_first(r);
                        }});
    }
}

}  // namespace

/// All metrics: those of times, bytes and errors, then one per work counter.
std::span<const metric> metrics() {
    static const std::vector<metric> registered = [] {
        std::vector<metric> list = row_metrics();
        add_work_metrics(list);
        return list;
    }();
    return registered;
}

std::vector<std::string> metric_names() {
    std::vector<std::string> names;
    for (const metric& m : metrics()) names.push_back(m.name);
    return names;
}

const metric& metric_named(std::string_view name) {
    const auto match = std::ranges::find(metrics(), name, &metric::name);
    if (match == metrics().end()) throw aabb::input_error(aabb::unknown_name("metric", name, metric_names()));
    return *match;
}

const row_value& measured(std::string_view name) {
    return metric_named(name).value;
}

/// The function that sums the bytes of these parts of a composition in a row; empty if the row has none of them.
row_value bytes_of(std::vector<std::string> parts) {
    return [parts = std::move(parts)](const row& r) -> std::optional<double> {
        std::optional<double> sum;
        for (std::size_t i = 0; i < byte_columns.size(); ++i)
            if (r.bytes[i] && std::ranges::find(parts, byte_columns[i]) != parts.end())
                sum = sum.value_or(0) + static_cast<double>(*r.bytes[i]);
        return sum;
    };
}

/// The function that sums these metrics, at least one, of a row. Returns nothing if the row lacks the first one, which
/// every measured row has; the others count as 0 where a method has no such part.
row_value sum_of(const std::vector<std::string>& names) {
    std::vector<row_value> parts;
    for (const std::string& name : names) parts.push_back(measured(name));
    return [parts](const row& r) {
        optional_number sum = parts.front()(r);
        for (std::size_t i = 1; sum && i < parts.size(); ++i) *sum += parts[i](r).value_or(0);
        return sum;
    };
}

row_value per_object(row_value total) {
    return [total = std::move(total)](const row& r) -> optional_number {
        const optional_number value = total(r);
        return value ? optional_number(*value / static_cast<double>(r.objects)) : std::nullopt;
    };
}

row_value per_triangle(row_value total) {
    return [total = std::move(total)](const row& r) -> optional_number {
        const optional_number value = total(r);
        const std::uint64_t triangles = r.triangles.value_or(0);
        return value && triangles > 0 ? optional_number(*value / static_cast<double>(triangles)) : std::nullopt;
    };
}

}  // namespace aabblab
