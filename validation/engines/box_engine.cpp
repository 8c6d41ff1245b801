module aabb.engines;

import aabb.base;
import aabb.global_search;
import :box_engine;

namespace aabb {

void box_engine::update(std::span<const box> boxes) {
    frame_.begin();
    require_ieee_arithmetic();
    objects_.require_boxes_for_all(boxes.size());
    require_valid(boxes);
    if (objects_.any_departures() || objects_.arrivals() > 0) {
        ids_.clear();
        for (std::uint32_t id = 0; id < boxes.size(); ++id)
            if (is_present(id)) ids_.push_back(id);
        objects_.settle();
    }
    frame_.change([&] { take(boxes, ids_); });
    frame_.taken();
}

void box_engine::search(std::vector<index_pair>& pairs) {
    frame_.require_taken();
    require_ieee_arithmetic();
    append_whole(pairs, [&] { find(pairs); });
}

}  // namespace aabb
