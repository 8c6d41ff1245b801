/// Explains a scene: its measures, the selected composition with its reasons, bytes and omissions, and what it saves.
export module aabblab.explain;

import aabb.pipeline;
import aabb.registry;
import aabb.std;
import aabblab.results;
import aabblab.tables;
import aabblab.trials;

export namespace aabblab {

struct explain_request {
    std::vector<std::string> what;  ///< a config, or the arguments that name a scene, for `auto`
    double seconds = 60;            ///< budget of each scene
};

/// @returns the exit status: 1 if the results of a scene differ
[[nodiscard]] int explain(const explain_request& request);

}  // namespace aabblab

// Internals of the module.
namespace aabblab {

/// All omissions of a configuration.
/// @param by_stages the omissions that its stages report
[[nodiscard]] std::vector<aabb::omission> omissions_of(const candidate_name& name,
                                                       std::vector<aabb::omission> by_stages);

/// Prints what each strategy of a composition saves in the scene, and its omissions. The composition runs interleaved
/// with variants in which one strategy or its settings differ, and with itself with counters. Lists unfinished runs.
/// @returns whether the results of all agree
[[nodiscard]] bool print_savings(staged_scene& scene, const aabb::composition& selected, const time_limits& limits);

/// Prints a table with the cells of one column wrapped, so that it fits the width of the output.
void print_wrapped_table(const table& t, std::size_t column);

}  // namespace aabblab
