/// Explains a scene: its measures, the selected composition with its reasons, bytes and omissions, and what it saves.
export module aabblab.explain;

import aabb.pipeline;
import aabb.registry;
import aabb.std;
import aabblab.filters;
import aabblab.results;
import aabblab.tables;
import aabblab.trials;

export namespace aabblab {

struct explain_request {
    std::vector<std::string> what;  ///< a config, or the arguments that name a scene, for `auto`
    filter_files filter;            ///< leaves out pairs of a scene; a config names its own
    double seconds = 60;            ///< budget of each scene
};

/// @returns the exit status: 1 if the results of a scene differ
[[nodiscard]] int explain(const explain_request& request);

}  // namespace aabblab

// Internals of the module; comments are at the definitions.
namespace aabblab {

[[nodiscard]] std::vector<aabb::omission> omissions_of(const candidate_name& name,
                                                       std::vector<aabb::omission> by_stages);
[[nodiscard]] bool print_savings(staged_scene& scene, const aabb::composition& selected, const time_limits& limits);
void print_wrapped_table(const table& t, std::size_t column);

}  // namespace aabblab
