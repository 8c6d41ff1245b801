#pragma once

import aabb.registry;
import aabblab.scenes;

namespace aabblab {

/// Prints what each strategy of a composition saves in the scene, and all that it leaves out: the composition is played
/// beside others that differ from it in one kind or its settings, and beside itself with its work counted.
/// @returns whether all of them find the same
[[nodiscard]] bool print_savings(const scene_choice& scene, const aabb::composition& selected);

}  // namespace aabblab
