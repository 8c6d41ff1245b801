#pragma once

import aabb.std;
import aabblab.queries;

namespace aabblab {

/// Prints the distances of two meshes, by pose if there are several, as text or as one JSON object.
void print_distances(const std::vector<std::string>& meshes, const distances_result& result, bool by_pose, bool json);

}  // namespace aabblab
