#pragma once

import aabb.registry;
import aabblab.scenes;

namespace aabblab {

/// Prints what each strategy of a composition saves in the scene: the composition is played beside others that differ
/// from it in one kind.
void print_savings(const scene_choice& scene, const aabb::composition& selected);

}  // namespace aabblab
