module aabblab.stiff;

import aabb.registry;

namespace aabblab {

contender usual_contender() {
    return contender_of(aabb::composition(), true);
}

}  // namespace aabblab
