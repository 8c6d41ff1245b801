module aabblab.picture;

import aabblab.fmt;
import aabblab.scenes;

namespace aabblab {

namespace {

constexpr std::size_t most_paths = 24;
constexpr std::size_t most_places = 200;  // per path

aabb::vec3d centre_of(const aabb::box& b) {
    aabb::vec3d centre{};
    for (int k = 0; k < 3; ++k) centre[k] = (double{b.min[k]} + double{b.max[k]}) / 2;
    return centre;
}

}  // namespace

/// Follows some objects, evenly spaced by index, in every frame or, of many frames, in every n-th.
picture_data::picture_data(std::size_t objects, std::size_t frames) {
    path_stride_ = std::max<std::size_t>(1, frames / most_places);
    const std::size_t count = std::min(objects, most_paths);
    for (std::size_t i = 0; i < count; ++i) followed_.push_back(i * objects / count);
    paths_.resize(count);
}

void picture_data::add_frame(std::span<const aabb::box> boxes, std::span<const std::uint8_t> present) {
    measure(boxes, present);
    extend_paths(boxes, present);
    last_.boxes.assign(boxes.begin(), boxes.end());
    last_.present.assign(present.begin(), present.end());
    if (frames_seen_++ == 0) first_ = last_;
}

/// Adds present boxes to the bounds of the world, and to the sums of longest extents and displacements, whose means the
/// caption states. An axis stays flat while all boxes of a frame are equal on it.
void picture_data::measure(std::span<const aabb::box> boxes, std::span<const std::uint8_t> present) {
    const aabb::box* first = nullptr;
    for (std::size_t i = 0; i < boxes.size(); ++i) {
        if (!takes_part(present, i)) continue;
        const aabb::box& b = boxes[i];
        if (first == nullptr) first = &b;
        for (int k = 0; k < 3; ++k)
            if (b.min[k] != first->min[k] || b.max[k] != first->max[k]) is_flat_[static_cast<std::size_t>(k)] = false;
        world_ = aabb::merged(world_, b);
        const int longest = aabb::longest_axis(b);
        extents_ += double{b.max[longest]} - double{b.min[longest]};
        ++boxes_counted_;
        if (frames_seen_ == 0 || !last_.has(i)) continue;
        const aabb::vec3d displacement = centre_of(b) - centre_of(last_.boxes[i]);
        displacements_ += std::sqrt(aabb::dot(displacement, displacement));
        ++displacements_counted_;
    }
}

void picture_data::extend_paths(std::span<const aabb::box> boxes, std::span<const std::uint8_t> present) {
    if (frames_seen_ % path_stride_ != 0) return;
    for (std::size_t p = 0; p < paths_.size(); ++p) {
        const std::size_t object = followed_[p];
        paths_[p].push_back(takes_part(present, object) ? std::optional(centre_of(boxes[object])) : std::nullopt);
    }
}

aabb::vec3d picture_data::sides() const {
    aabb::vec3d sides{};
    for (int k = 0; k < 3; ++k)
        if (!is_flat_[static_cast<std::size_t>(k)]) sides[k] = double{world_.max[k]} - double{world_.min[k]};
    return sides;
}

std::optional<double> picture_data::displacement_over(double length) const {
    if (displacements_counted_ == 0 || !(length > 0)) return std::nullopt;
    return displacements_ / static_cast<double>(displacements_counted_) / length;
}

std::optional<double> picture_data::displacement_over_extent() const {
    return displacement_over(boxes_counted_ == 0 ? 0 : extents_ / static_cast<double>(boxes_counted_));
}

std::optional<double> picture_data::displacement_over_spacing() const {
    return displacement_over(mean_spacing(sides(), last_.boxes.size()));
}

std::string displacement_text(const picture_data& data) {
    const auto shown = [](std::optional<double> value) { return value ? fmt::format("{:.3g}", *value) : "-"; };
    return fmt::format("mean displacement per frame: {} of the mean extent, {} of the mean spacing",
                       shown(data.displacement_over_extent()), shown(data.displacement_over_spacing()));
}

}  // namespace aabblab
