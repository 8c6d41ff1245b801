/// Metrics: numbers computed from the rows of results after the run. metric_list.cpp defines them.
export module aabblab.metrics;

import aabb.std;
import aabblab.results;

export namespace aabblab {

/// The data that a run must record for a metric; configs request them by these names.
enum class metric_group : std::uint8_t { time, counts, bytes, error };

struct metric_group_info {
    std::string_view name;
    std::string_view summary;
};
inline constexpr std::array<metric_group_info, 4> metric_groups = {{
    {"time", "wall time of build, update, search and triangle tests, each on its own"},
    {"counts", "work done, counted in a separate pass"},
    {"bytes", "memory allocated, by part"},
    {"error", "false negatives and false positives, compared with the ground truth"},
}};

/// `neither` if a number describes the input.
enum class better : std::uint8_t { less, more, neither };

/// A number of a row; empty if the row has none.
using row_value = std::function<std::optional<double>(const row&)>;

struct metric {
    std::string name;  ///< in configs and columns
    std::string unit;  ///< "ms", "bytes"; empty for plain numbers
    std::string summary;
    metric_group group;
    better direction;
    row_value value;
};

/// All metrics in the order of that list, then the work counters.
[[nodiscard]] std::span<const metric> metrics();
[[nodiscard]] std::vector<std::string> metric_names();

/// @throws aabb::input_error on an unknown name, suggesting the nearest one.
[[nodiscard]] const metric& metric_named(std::string_view name);

[[nodiscard]] const row_value& measured(std::string_view name);

// Functions for values that no single metric provides.

/// The sum of the bytes of these parts; empty if a row has none of them.
[[nodiscard]] row_value bytes_of(std::vector<std::string> parts);
/// The sum of the named metrics: empty if the first is missing from a row; other missing ones count as 0.
[[nodiscard]] row_value sum_of(const std::vector<std::string>& names);
/// The value divided by the number of objects, or by the number of triangles of the scene's meshes.
[[nodiscard]] row_value per_object(row_value total);
[[nodiscard]] row_value per_triangle(row_value total);

}  // namespace aabblab
