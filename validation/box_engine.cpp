module;
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>

module aabb.validation;

import aabb;
import :parts;

namespace aabb {

void box_engine::insert(std::uint32_t id) {
    if (is_present(id)) throw input_error("object " + std::to_string(id) + " is inserted twice");
    if (id >= present_.size()) present_.resize(std::size_t{id} + 1);
    present_[id] = true;
    changed_ = true;
}

void box_engine::remove(std::uint32_t id) {
    if (!is_present(id)) throw input_error("object " + std::to_string(id) + " is removed but was never inserted");
    present_[id] = false;
    changed_ = true;
}

void box_engine::update(std::span<const box> boxes) {
    if (changed_) {
        ids_.clear();
        for (std::uint32_t id = 0; id < present_.size(); ++id)
            if (present_[id]) ids_.push_back(id);
        changed_ = false;
    }
    if (!ids_.empty() && ids_.back() >= boxes.size())
        throw input_error("object " + std::to_string(ids_.back()) + " is present, but the frame has only " +
                          std::to_string(boxes.size()) + " boxes");
    require_valid(boxes);
    take(boxes, ids_);
}

}  // namespace aabb
