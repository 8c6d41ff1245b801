#pragma once

import aabb.pipeline;
import aabb.registry;
import aabb.std;
import aabblab.race;
import aabblab.results;
import aabblab.trials;

namespace aabblab {

/// What a contender does without, by its stages and by its strategies.
/// @param by_stages what its stages say of themselves
[[nodiscard]] std::vector<aabb::omission> omissions_of(const contender_name& who,
                                                       std::vector<aabb::omission> by_stages);

/// Prints what each strategy of a composition saves in the scene, and all that it leaves out: it is played beside
/// others, of which one kind or its settings differ, and beside itself with its work counted. Says who had no time.
/// @returns whether all of them find the same
[[nodiscard]] bool print_savings(staged_scene& scene, const aabb::composition& selected, const time_limits& limits);

}  // namespace aabblab
