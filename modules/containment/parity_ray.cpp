module;
#include <cassert>

module aabb.containment;

#pragma clang fp contract(off) reassociate(off) reciprocal(off)  // see aabb.base:floating_point

namespace aabb {

namespace {

/// A bijection of 64 bits (the finalizer of Steele, Lea and Flood, "Fast splittable pseudorandom number generators",
/// 2014), so that successive attempts visit all points of a grid in no particular order.
std::uint64_t scattered(std::uint64_t x) noexcept {
    x = (x ^ x >> 30U) * 0xbf58476d1ce4e5b9U;
    x = (x ^ x >> 27U) * 0x94d049bb133111ebU;
    return x ^ x >> 31U;
}

/// A coordinate of grid point `i` around `centre`: a multiple of a power of two, computed without rounding.
/// @param magnitude of the greatest coordinate, that of the centre included
double grid_coordinate(std::uint32_t i, double centre, double extent, double magnitude) noexcept {
    // The multiplier stays below 2^53, and the grid is at least as large as the extent, which may exceed the doubles.
    const double least_step = std::clamp(std::max(extent * 0x1p-32, magnitude * 0x1p-51), 0x1p-1000, 0x1p990);
    const double step = std::ldexp(1, std::ilogb(least_step) + 1);
    return step * (std::round(centre / step) + (static_cast<double>(i) - 0x1p31));
}

/// The whole range of float.
box boundless() noexcept {
    constexpr float most = std::numeric_limits<float>::max();
    return {{-most, -most, -most}, {most, most, most}};
}

/// The next float towards a bound from one that is nearest to x, so that x plus the rounding of a sum lies within.
float rounded_towards(double x, float bound) noexcept {
    constexpr double most = std::numeric_limits<float>::max();
    return std::nextafter(static_cast<float>(std::clamp(x, -most, most)), bound);
}

bool has_area(const triangle3d& t) noexcept {
    for (int axis = 0; axis < 3; ++axis)
        if (exact_turn(t[0], t[1], t[2], axis) != 0) return true;
    return false;
}

/// Whether a point in the plane of a triangle with area lies in it.
/// @param point,t the indices of the point and of the first corner
bool is_in_triangle(const exact_corners& corners, int point, int t) noexcept {
    for (int axis = 0; axis < 3; ++axis) {
        const int turn = corners.turn(t, t + 1, t + 2, axis);
        if (turn == 0) continue;
        for (int i = 0; i < 3; ++i)
            if (corners.turn(t + i, t + (i + 1) % 3, point, axis) == -turn) return false;
        return true;
    }
    return false;
}

}  // namespace

void parity_ray::set_image(const vec3f& image, const vec3f& error) {
    image_ = in_double(image);
    image_error_ = in_double(error);
}

bool parity_ray::starts_outside() const noexcept {
    if (!image_) return false;
    for (int k = 0; k < 3; ++k) {
        // Twice the error exceeds it by more than these sums round.
        const double margin = 2 * image_error_[k];
        if ((*image_)[k] + margin < bounds_.min[k] || (*image_)[k] - margin > bounds_.max[k]) return true;
    }
    return false;
}

void parity_ray::aim(std::uint64_t attempt) {
    if (!image_ || !aim_beyond_box(attempt)) aim_far_away(attempt);
}

/// Aims beyond the face of the box that is nearest to the start, so that the ray leaves the box before the target. The
/// grid is at most a thousandth as wide as the surface, unless it lies far from the origin: `reach` then is about as
/// slender as a triangle of a million.
/// @returns whether the target is a number, and certainly beyond the box
bool parity_ray::aim_beyond_box(std::uint64_t attempt) {
    const vec3d low = in_double(bounds_.min), high = in_double(bounds_.max);
    int axis = 0;
    bool is_up = true;
    double nearest = std::numeric_limits<double>::infinity(), extent = 0;
    for (int k = 0; k < 3; ++k) {
        extent = std::max(extent, high[k] - low[k]);
        for (const bool up : {false, true})
            if (const double distance = up ? high[k] - (*image_)[k] : (*image_)[k] - low[k]; distance < nearest) {
                nearest = distance;
                axis = k;
                is_up = up;
            }
    }
    const double margin =
        extent + 8 * image_error_[axis] + 0x1p-20 * std::max(std::abs(low[axis]), std::abs(high[axis]));
    vec3d image = *image_;
    image[axis] = is_up ? high[axis] + margin : low[axis] - margin;
    const vertex_frame& frame = surface_->frame;
    vec3d target = frame.vertex(image);
    if (attempt > 0) {
        const vec3d first = frame.vertex(low), last = frame.vertex(high);
        const std::uint64_t number = scattered(attempt);
        for (int i = 0; i < 2; ++i) {
            const int k = (axis + 1 + i) % 3;
            target[k] = grid_coordinate(static_cast<std::uint32_t>(number >> 32U * static_cast<unsigned>(i)), target[k],
                                        0x1p-10 * frame.scale * extent,
                                        std::max({std::abs(first[k]), std::abs(last[k]), std::abs(target[k])}));
        }
    }
    if (!is_finite(target)) return false;
    aim_at(target);
    const double reached = image_of_target_[axis], error = 4 * error_[axis];
    return is_bounded_ && (is_up ? reached - error > high[axis] : reached + error < low[axis]);
}

/// Aims out of the range in which floats decide, at a grid in a plane without the start.
void parity_ray::aim_far_away(std::uint64_t attempt) {
    double height = 0x1p1000;
    const vec3d origin{height, 0, 0}, side{height, 1, 0}, top{height, 0, 1};
    const exact_corners corners({{{&vertex_, &pose_of_vertex_},
                                  {&origin, &pose_of_surface_},
                                  {&side, &pose_of_surface_},
                                  {&top, &pose_of_surface_},
                                  {&top, &pose_of_surface_},
                                  {&top, &pose_of_surface_}}});
    if (corners.side(1, 2, 3, 0) == 0) height = -height;
    const std::uint64_t number = scattered(attempt);
    const auto coordinate = [](std::uint64_t i) {
        return (static_cast<double>(static_cast<std::uint32_t>(i)) - 0x1p31) * 0x1p960;
    };
    aim_at({height, coordinate(number), coordinate(number >> 32U)});
    is_bounded_ = false;
    reach_ = boundless();
}

/// The ray lies in the box of both ends, up to the error of these and of corners on each axis.
void parity_ray::aim_at(const vec3d& target) {
    assert(is_finite(target));
    target_ = target;
    is_bounded_ = image_.has_value();
    reach_ = boundless();
    if (!image_) return;
    const vertex_frame& frame = surface_->frame;
    for (int k = 0; k < 3; ++k) {
        image_of_target_[k] = (target[k] - frame.origin[k]) / frame.scale;
        // The difference rounds once, and the quotient may underflow.
        error_[k] = image_error_[k] + 0x1p-51 * std::abs(image_of_target_[k]) + 0x1p-1070;
        is_bounded_ = is_bounded_ && std::abs(image_of_target_[k]) < 0x1p200;
    }
    if (!is_bounded_) return;
    constexpr float infinity = std::numeric_limits<float>::infinity();
    for (int k = 0; k < 3; ++k) {
        const auto [low, high] = std::minmax((*image_)[k], image_of_target_[k]);
        reach_.min[k] = rounded_towards(low - 2 * error_[k], -infinity);
        reach_.max[k] = rounded_towards(high + 2 * error_[k], infinity);
    }
}

ray_crossing parity_ray::crossing(std::uint32_t triangle) const noexcept {
    if (is_bounded_)
        if (const std::optional<ray_crossing> certain = certain_crossing(triangle)) return *certain;
    return exact_crossing(triangle);
}

/// Decides in double, in the frame of the surface's floats; nothing if a sign is within its error.
std::optional<ray_crossing> parity_ray::certain_crossing(std::uint32_t triangle) const noexcept {
    const triangle3d t = in_double(surface_->triangle(triangle));
    const vec3d& start = *image_;
    vec3d extent{};
    for (int k = 0; k < 3; ++k) {
        const auto [low, high] = std::minmax({start[k], image_of_target_[k], t[0][k], t[1][k], t[2][k]});
        extent[k] = high - low + 2 * error_[k];
        if (!(extent[k] >= 0x1p-200 && extent[k] <= 0x1p200)) return std::nullopt;
    }
    constexpr double unit = std::numeric_limits<double>::epsilon() / 2;
    double error = determinant_errors::rounding_of_side * unit * extent[0] * extent[1] * extent[2];
    for (int k = 0; k < 3; ++k)
        error += determinant_errors::displacement_of_side * error_[k] * extent[(k + 1) % 3] * extent[(k + 2) % 3];
    const auto side = [&](const vec3d& a, const vec3d& b, const vec3d& c, const vec3d& d) {
        const double volume = dot(cross(b - a, c - a), d - a);
        return static_cast<int>(volume > error) - static_cast<int>(volume < -error);
    };
    int left = 0, right = 0;
    for (int i = 0; i < 3; ++i) {
        const int passing = side(start, image_of_target_, t[i], t[(i + 1) % 3]);
        left += static_cast<int>(passing > 0);
        right += static_cast<int>(passing < 0);
    }
    if (left > 0 && right > 0) return ray_crossing::none;
    if (left + right < 3) return std::nullopt;
    // A line that passes all edges on the left goes from below the triangle to above it.
    const int height = side(t[0], t[1], t[2], start);
    if (height == 0) return std::nullopt;
    if (height != (left > 0 ? -1 : 1)) return ray_crossing::none;
    return left > 0 ? ray_crossing::leaves : ray_crossing::enters;
}

ray_crossing parity_ray::exact_crossing(std::uint32_t triangle) const noexcept {
    const triangle3d t = surface_->given_triangle(triangle);
    constexpr int start = 0, target = 1, first = 2;
    const exact_corners corners({{{&vertex_, &pose_of_vertex_},
                                  {&target_, &pose_of_surface_},
                                  {&t[0], &pose_of_surface_},
                                  {&t[1], &pose_of_surface_},
                                  {&t[2], &pose_of_surface_},
                                  {&t[2], &pose_of_surface_}}});
    int left = 0, right = 0;
    for (int i = 0; i < 3; ++i) {
        const int passing = corners.side(start, target, first + i, first + (i + 1) % 3);
        left += static_cast<int>(passing > 0);
        right += static_cast<int>(passing < 0);
    }
    // The line passes beside the triangle.
    if (left > 0 && right > 0) return ray_crossing::none;
    const int height = corners.side(first, first + 1, first + 2, start);
    const int height_before = left > 0 ? -1 : 1;  // of the start, if the ray gets to the plane
    if (left + right == 3) {
        if (height == 0) return ray_crossing::starts_on;
        if (height != height_before) return ray_crossing::none;
        // A mirror turns normals over.
        return (left > 0) == (determinant_sign(pose_of_surface_) > 0) ? ray_crossing::leaves : ray_crossing::enters;
    }
    if (!has_area(t)) return ray_crossing::none;
    // The line meets an edge or its extension, or lies in the plane.
    if (height == 0) {
        if (is_in_triangle(corners, start, first)) return ray_crossing::starts_on;
        return left + right > 0 ? ray_crossing::none : ray_crossing::unclear;
    }
    return height == height_before ? ray_crossing::unclear : ray_crossing::none;
}

}  // namespace aabb
