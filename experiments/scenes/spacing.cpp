module aabblab.scenes;

import aabb.geometry;
import :drift;

namespace aabblab {

double mean_spacing(const aabb::vec3d& sides, std::size_t objects) {
    double volume = 1;
    int axes = 0;
    for (const double side : sides.at)
        if (side > 0) {
            volume *= side;
            ++axes;
        }
    if (axes == 0 || objects == 0) return 0;
    return edge_of(volume / static_cast<double>(objects), axes);
}

}  // namespace aabblab
