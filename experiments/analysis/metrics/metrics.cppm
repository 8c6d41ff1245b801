/// Metrics: numbers computed from the rows of results, after the run that wrote them. They stand
/// in metric_list.cpp.
export module aabblab.metrics;

import aabb.std;
import aabblab.results;

export namespace aabblab {

/// What a run must have recorded for a metric: a config asks for it by these names.
enum class metric_group : std::uint8_t { time, counts, bytes, error };

struct metric_group_info {
    std::string_view name;
    std::string_view summary;
};
inline constexpr std::array<metric_group_info, 4> metric_groups = {{
    {"time", "wall time of build, update, search and triangle tests, apart"},
    {"counts", "work done, counted in a pass of its own"},
    {"bytes", "memory allocated, by part"},
    {"error", "pairs missed and invented against the exact answer"},
}};

/// `neither` where a number describes what was played.
enum class better : std::uint8_t { less, more, neither };

/// One number of a row; empty where it has none.
using row_value = std::function<std::optional<double>(const row&)>;

struct metric {
    std::string name;  ///< as configs and columns have it
    std::string unit;  ///< "ms", "bytes"; empty for plain numbers
    std::string summary;
    metric_group group;
    better direction;
    row_value of;
};

/// All of them, work counters too, in the order of that list.
[[nodiscard]] std::span<const metric> metrics();
[[nodiscard]] std::vector<std::string> metric_names();

/// @throws aabb::input_error on an unknown name, with the nearest one.
[[nodiscard]] const metric& metric_named(std::string_view name);

/// Its function.
[[nodiscard]] const row_value& measured(std::string_view name);

// What no metric has, from what some have.

/// Bytes of these parts together.
[[nodiscard]] row_value bytes_of(std::vector<std::string> parts);
/// Of metrics by name; those that a row has not count as 0 beside the first.
[[nodiscard]] row_value sum_of(const std::vector<std::string>& names);
/// Over the number of objects, or of triangles of the scene's meshes.
[[nodiscard]] row_value an_object(row_value of);
[[nodiscard]] row_value a_triangle(row_value of);

}  // namespace aabblab
