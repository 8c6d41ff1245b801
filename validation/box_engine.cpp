module;
#include <cstdint>
#include <span>

module aabb.validation;

import aabb;
import :parts;

namespace aabb {

void box_engine::update(std::span<const box> boxes) {
    objects_.require_boxes_for_all(boxes.size());
    require_valid(boxes);
    if (objects_.any_departures() || !objects_.arrivals().empty()) {
        ids_.clear();
        for (std::uint32_t id = 0; id < boxes.size(); ++id)
            if (is_present(id)) ids_.push_back(id);
        objects_.settle();
    }
    take(boxes, ids_);
}

}  // namespace aabb
