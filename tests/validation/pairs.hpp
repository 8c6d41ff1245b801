#pragma once

#include "../triangle_pairs.hpp"

import aabb;
import aabb.validation;

// Imports modules, so it is included after every other header.

namespace triangle_pairs {

/// As a type of the library.
template <class Real>
aabb::triangle_pair<Real> of_type(const pair& p) {
    return {as<aabb::triangle3<Real>>(p[0]), as<aabb::triangle3<Real>>(p[1])};
}

/// Visits `count` pairs of every pattern in every placement.
/// @param after is called after each placement of a pattern, with the number of the pattern
template <class Real, class Visit, class After>
void for_each_pair(generator& g, int count, Visit visit, After after) {
    for (std::size_t pattern = 0; pattern < patterns.size(); ++pattern)
        for (std::size_t placement = 0; placement < placements.size(); ++placement) {
            CAPTURE(patterns[pattern], placements[placement]);
            for (int i = 0; i < count; ++i) visit(of_type<Real>(placed<Real>(g, patterned(g, pattern), placement)));
            after(pattern);
        }
}

/// Requires that `is_right` is true of every such pair.
template <class Real, class IsRight>
void check_each_pair(generator& g, int count, IsRight is_right) {
    int wrong = 0;
    for_each_pair<Real>(
        g, count, [&](const aabb::triangle_pair<Real>& pair) { wrong += is_right(pair) ? 0 : 1; },
        [&](std::size_t) {
            CHECK(wrong == 0);
            wrong = 0;
        });
}

}  // namespace triangle_pairs
