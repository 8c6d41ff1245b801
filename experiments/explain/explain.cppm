/// What a scene is like, which composition serves it and why, its bytes, what is left out, and what each choice saves.
export module aabblab.explain;

import aabb.pipeline;
import aabb.registry;
import aabb.std;
import aabblab.results;
import aabblab.tables;
import aabblab.trials;

export namespace aabblab {

struct explain_request {
    std::vector<std::string> what;  ///< a config, for what it composes, or what names a scene, for `auto`
    double seconds = 60;            ///< for which each scene is played
};

/// Prints it.
/// @returns the exit status: 1 where not all that was played in a scene finds the same
[[nodiscard]] int explain(const explain_request& request);

}  // namespace aabblab

// What the parts of the module share.
namespace aabblab {

/// What a configuration leaves out, in its stages and its strategies.
/// @param by_stages what its stages say of themselves
[[nodiscard]] std::vector<aabb::omission> omissions_of(const contender_name& who,
                                                       std::vector<aabb::omission> by_stages);

/// Prints what each strategy of a composition saves in the scene, and all that it leaves out: it is played beside
/// others, of which one kind or its settings differ, and beside itself with its work counted. Says who had no time.
/// @returns whether all of them find the same
[[nodiscard]] bool print_savings(staged_scene& scene, const aabb::composition& selected, const time_limits& limits);

/// Prints a table that fits the output, since the cells of one column are broken into lines.
void print_broken(const table& t, std::size_t column);

}  // namespace aabblab
