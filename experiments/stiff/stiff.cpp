module aabblab.stiff;

import aabb.registry;
import aabblab.trials;

namespace aabblab {

contender usual_contender() {
    return contender_of(aabb::composition(), true);
}

}  // namespace aabblab
