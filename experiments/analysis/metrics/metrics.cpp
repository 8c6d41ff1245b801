module;
#include <algorithm>
#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

module aabblab.metrics;

import aabb;
import aabblab.results;

namespace aabblab {

double frames_after_first(const row& r) {
    return r.frames > 1 ? static_cast<double>(r.frames - 1) : 1;
}

std::vector<metric> work_metrics() {
    std::vector<metric> all;
    for (std::size_t i = 0; i < aabb::work_names.size(); ++i) {
        std::string spaced(aabb::work_names[i]);
        std::ranges::replace(spaced, '_', ' ');
        all.push_back({std::string(aabb::work_names[i]), "", spaced + " a frame after frame 0", metric_group::counts,
                       better::less, [i](const row& r) -> std::optional<double> {
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

}  // namespace aabblab
