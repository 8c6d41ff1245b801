module;
#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

module aabblab.claims;

import :measurements;
import aabb;
import aabblab.figures;
import aabblab.results;
import aabblab.statistics;

namespace aabblab {

namespace {

double frames_after_first(const row& r) {
    return r.frames > 1 ? static_cast<double>(r.frames - 1) : 1;
}

/// "objects=100 displacement=0.1 seed=3" into names and values; the seed apart.
std::pair<factors, std::string> parsed(const row& r) {
    factors all{{"scene", r.scene}};
    std::string seed;
    const std::string& text = r.scene_parameters;
    for (std::size_t at = 0; at < text.size();) {
        const std::size_t end = std::min(text.find(' ', at), text.size());
        const std::size_t equals = std::min(text.find('=', at), end);
        const std::string name = text.substr(at, equals - at);
        const std::string value = equals < end ? text.substr(equals + 1, end - equals - 1) : "";
        if (name == "seed")
            seed = value;
        else if (name != "frames")
            all.emplace_back(name, value);
        at = end + 1;
    }
    return {all, seed};
}

template <class Value>
void add_values(cells& to, const std::vector<const row*>& rows, const metric& of, Value value) {
    for (const row* r : rows)
        if (const std::optional<double> measured = of(*r); measured.value_or(0) > 0) value(to, *r, *measured);
}

}  // namespace

std::string value_of(const factors& all, std::string_view name) {
    const auto found = std::ranges::find(all, name, &std::pair<std::string, std::string>::first);
    return found != all.end() ? found->second : "";
}

double number_of(const factors& all, std::string_view name) {
    const std::string text = value_of(all, name);
    double value = 0;
    const char* end = text.data() + text.size();
    return std::from_chars(text.data(), end, value) == std::from_chars_result{end, std::errc{}} ? value : std::nan("");
}

metric frame_ms() {
    return [](const row& r) -> std::optional<double> {
        if (!r.update_ms) return std::nullopt;
        if (r.frames == 1) return r.first_ms;
        return (*r.update_ms + *r.search_ms + *r.detect_ms) / frames_after_first(r);
    };
}
metric update_ms() {
    return [](const row& r) -> std::optional<double> {
        return r.update_ms ? std::optional(*r.update_ms / frames_after_first(r)) : std::nullopt;
    };
}
metric detect_ms() {
    return [](const row& r) -> std::optional<double> {
        return r.detect_ms ? std::optional(*r.detect_ms / frames_after_first(r)) : std::nullopt;
    };
}
metric whole_ms() {
    return [](const row& r) -> std::optional<double> {
        if (!r.update_ms) return std::nullopt;
        return *r.build_ms + *r.first_ms + *r.update_ms + *r.search_ms + *r.detect_ms;
    };
}
metric build_ms() {
    return [](const row& r) { return r.build_ms; };
}
metric count_of(std::string_view column) {
    const auto place = static_cast<std::size_t>(std::ranges::find(aabb::work_names, column) - aabb::work_names.begin());
    return [place](const row& r) -> std::optional<double> {
        if (!r.counts.at(place)) return std::nullopt;
        return static_cast<double>(*r.counts[place]) / frames_after_first(r);
    };
}
metric bytes_of(std::vector<std::string> parts) {
    return [parts = std::move(parts)](const row& r) -> std::optional<double> {
        std::optional<double> sum;
        for (std::size_t i = 0; i < byte_columns.size(); ++i)
            if (r.bytes[i] && std::ranges::find(parts, byte_columns[i]) != parts.end())
                sum = sum.value_or(0) + static_cast<double>(*r.bytes[i]);
        return sum;
    };
}
metric tree_bytes() {
    return [trees = bytes_of({"nodes", "indices"})](const row& r) -> std::optional<double> {
        const std::optional<double> bytes = trees(r);
        if (!bytes || r.triangles.value_or(0) == 0) return std::nullopt;
        return *bytes / static_cast<double>(*r.triangles);
    };
}

bool selection::matches(const contender_name& name) const {
    const auto fits = [](const std::string& wanted, const std::string& there) {
        return wanted.empty() || wanted == there;
    };
    return name.engine.empty() && fits(sort, name.sort) && fits(partition, name.partition) && fits(sweep, name.sweep) &&
           fits(split_large, name.split_large) && fits(tree, name.tree);
}

condition::condition(factors of, std::vector<const row*> rows) : of_(std::move(of)), rows_(std::move(rows)) {
    for (const row* r : rows_) {
        const std::string seed = parsed(*r).second;
        if (std::ranges::find(seeds_, seed) == seeds_.end()) seeds_.push_back(seed);
        processes_ = std::max<std::size_t>(processes_, r->process + 1);
    }
    std::ranges::sort(seeds_);
}

std::size_t condition::seed_index(const row& r) const {
    return static_cast<std::size_t>(std::ranges::find(seeds_, parsed(r).second) - seeds_.begin());
}

std::vector<const row*> condition::rows_of(const selection& who) const {
    std::vector<const row*> found;
    for (const row* r : rows_)
        if (who.matches(r->name) && r->status == "exact") found.push_back(r);
    return found;
}

cells condition::log_ratios(const selection& arm, const selection& base, const metric& of) const {
    cells all(processes(), seeds());
    const std::vector<const row*> against = rows_of(base);
    add_values(all, rows_of(arm), of, [&](cells& to, const row& r, double value) {
        for (const row* b : against) {
            if (b->repeat != r.repeat || b->scene_parameters != r.scene_parameters) continue;
            if (const std::optional<double> other = of(*b); other.value_or(0) > 0)
                to.add(r.process, seed_index(r), std::log(value / *other));
        }
    });
    return all;
}

cells condition::logs(const selection& who, const metric& of) const {
    cells all(processes(), seeds());
    add_values(all, rows_of(who), of,
               [&](cells& to, const row& r, double value) { to.add(r.process, seed_index(r), std::log(value)); });
    return all;
}

std::optional<quartiles> condition::spread(const selection& who, const metric& of) const {
    std::vector<double> values;
    for (const row* r : rows_of(who))
        if (const std::optional<double> value = of(*r)) values.push_back(*value);
    return values.empty() ? std::nullopt : std::optional(quartiles_of(values));
}

std::optional<figure_point> condition::point(double x, const selection& who, const metric& of) const {
    const std::optional<quartiles> q = spread(who, of);
    if (!q) return std::nullopt;
    return figure_point{x, q->median, q->low, q->high};
}

const measurements::experiment_results& measurements::read(const std::string& experiment) const {
    std::unique_ptr<experiment_results>& results = read_[experiment];
    if (results) return *results;
    results = std::make_unique<experiment_results>();
    const std::filesystem::path file = folder_ / experiment / "results.csv";
    if (!std::filesystem::exists(file)) return *results;
    results->rows = aabblab::read_rows(file);
    std::vector<std::pair<factors, std::vector<const row*>>> groups;
    for (const row& r : results->rows) {
        const factors of = parsed(r).first;
        auto group = std::ranges::find(groups, of, &std::pair<factors, std::vector<const row*>>::first);
        if (group == groups.end()) group = groups.insert(group, {of, {}});
        group->second.push_back(&r);
    }
    for (auto& [of, rows] : groups) results->conditions.emplace_back(of, std::move(rows));
    return *results;
}

const std::vector<condition>& measurements::of(const std::string& experiment) const {
    return read(experiment).conditions;
}

}  // namespace aabblab
