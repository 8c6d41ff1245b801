module aabblab.metrics;

import aabb.base;
import aabb.counters;
import aabb.policy;

namespace aabblab {

double frames_after_first(const row& r) {
    return r.frames > 1 ? static_cast<double>(r.frames - 1) : 1;
}

row_value a_frame(std::optional<double> row::* sum) {
    return [sum](const row& r) -> std::optional<double> {
        return r.*sum && r.frames > 1 ? std::optional(*(r.*sum) / frames_after_first(r)) : std::nullopt;
    };
}

// What is no work but says how the input, or its cut, was.
static bool describes(aabb::work counted) {
    using enum aabb::work;
    return counted == inversions || counted == subsets || counted == segments_wanted || counted == segments_got ||
           counted == pieces;
}

std::vector<metric> work_metrics() {
    std::vector<metric> all;
    for (std::size_t i = 0; i < aabb::work_names.size(); ++i) {
        std::string spaced(aabb::work_names[i]);
        std::ranges::replace(spaced, '_', ' ');
        all.push_back({std::string(aabb::work_names[i]), "", spaced + " a frame after frame 0", metric_group::counts,
                       describes(static_cast<aabb::work>(i)) ? better::neither : better::less,
                       [i](const row& r) -> std::optional<double> {
                           if (!r.counts[i]) return std::nullopt;
                           return static_cast<double>(*r.counts[i]) / frames_after_first(r);
                       }});
    }
    return all;
}

std::vector<std::string> metric_names() {
    std::vector<std::string> names;
    for (const metric& m : metrics()) names.push_back(m.name);
    return names;
}

const metric& metric_named(std::string_view name) {
    const auto found = std::ranges::find(metrics(), name, &metric::name);
    if (found == metrics().end()) throw aabb::input_error(aabb::unknown_name("metric", name, metric_names()));
    return *found;
}

const row_value& measured(std::string_view name) {
    return metric_named(name).of;
}

row_value bytes_of(std::vector<std::string> parts) {
    return [parts = std::move(parts)](const row& r) -> std::optional<double> {
        std::optional<double> sum;
        for (std::size_t i = 0; i < byte_columns.size(); ++i)
            if (r.bytes[i] && std::ranges::find(parts, byte_columns[i]) != parts.end())
                sum = sum.value_or(0) + static_cast<double>(*r.bytes[i]);
        return sum;
    };
}

row_value sum_of(const std::vector<std::string>& names) {
    std::vector<row_value> parts;
    for (const std::string& name : names) parts.push_back(measured(name));
    return [parts](const row& r) -> std::optional<double> {
        std::optional<double> sum;
        for (const row_value& part : parts) {
            const std::optional<double> value = part(r);
            if (&part == parts.data() && !value) return std::nullopt;
            sum = sum.value_or(0) + value.value_or(0);
        }
        return sum;
    };
}

row_value an_object(row_value of) {
    return [of = std::move(of)](const row& r) -> std::optional<double> {
        const std::optional<double> all = of(r);
        return all ? std::optional(*all / static_cast<double>(r.objects)) : std::nullopt;
    };
}

row_value a_triangle(row_value of) {
    return [of = std::move(of)](const row& r) -> std::optional<double> {
        const std::optional<double> all = of(r);
        return all && r.triangles.value_or(0) > 0 ? std::optional(*all / static_cast<double>(*r.triangles))
                                                  : std::nullopt;
    };
}

}  // namespace aabblab
