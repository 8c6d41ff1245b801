module;
#include <array>
#include <span>

module aabblab.stiff;

import :study;
import aabb.registry;
import aabblab.play;

namespace aabblab {

stiff_study ball_bounces_study();
stiff_study stability_study();
stiff_study overdamped_study();

std::span<const stiff_study> stiff_studies() {
    static const std::array all = {ball_bounces_study(), stability_study(), overdamped_study()};
    return all;
}

contender usual_contender() {
    return contender_of(aabb::composition(), true);
}

}  // namespace aabblab
