#pragma once

import aabb.registry;
import aabblab.race;

namespace aabblab {

/// Prints what each strategy of a composition saves in the scene, and all that it leaves out: the composition is played
/// beside others that differ from it in one kind or its settings, and beside itself with its work counted. Says for
/// whom there was no time.
/// @returns whether all of them find the same
[[nodiscard]] bool print_savings(staged_scene& scene, const aabb::composition& selected, const time_limits& limits);

}  // namespace aabblab
