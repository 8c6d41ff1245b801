module;
#include <array>
#include <span>

module aabblab.stiff;

import :study;
import aabb.registry;
import aabblab.trials;

namespace aabblab {

stiff_study ball_bounces_study();
stiff_study stability_study();
stiff_study overdamped_study();
stiff_study bouncing_study();
stiff_study stack_study();
stiff_study plate_study();
stiff_study dropped_study();
stiff_study sliding_study();

std::span<const stiff_study> stiff_studies() {
    static const std::array all = {ball_bounces_study(), stability_study(), overdamped_study(), bouncing_study(),
                                   stack_study(),        plate_study(),     dropped_study(),    sliding_study()};
    return all;
}

contender usual_contender() {
    return contender_of(aabb::composition(), true);
}

}  // namespace aabblab
