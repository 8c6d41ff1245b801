#pragma once

#include <rapidcheck.h>

#include "testing.hpp"

import aabb;

/// Uniform in [low, high), from RapidCheck's generator.
inline double uniform(double low, double high) {
    return low + (high - low) * (*rc::gen::inRange(0, 1 << 30) / static_cast<double>(1 << 30));
}

/// Each coordinate is uniform in [-most, most).
inline aabb::vec3d any_vector(double most) {
    return {uniform(-most, most), uniform(-most, most), uniform(-most, most)};
}

/// A rotation by a quaternion w, x, y, z of any length but 0, then a translation.
inline aabb::pose turned_by(std::array<double, 4> q, const aabb::vec3d& translation) {
    double square = 0;
    for (const double c : q) square += c * c;
    for (double& c : q) c /= std::sqrt(square);
    const auto [w, x, y, z] = q;
    return {{1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y), 2 * (x * y + w * z),
             1 - 2 * (x * x + z * z), 2 * (y * z - w * x), 2 * (x * z - w * y), 2 * (y * z + w * x),
             1 - 2 * (x * x + y * y)},
            translation};
}

inline aabb::pose any_turned(const aabb::vec3d& translation) {
    return turned_by({1.01 + uniform(-1, 1), uniform(-1, 1), uniform(-1, 1), uniform(-1, 1)}, translation);
}

/// Rotated about any axis, by a quaternion of 1 and numbers up to `turn`.
inline aabb::pose turned_up_to(double turn, const aabb::vec3d& translation) {
    return turned_by({1, uniform(-turn, turn), uniform(-turn, turn), uniform(-turn, turn)}, translation);
}
