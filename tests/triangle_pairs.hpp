#pragma once

#include <random>
#include <type_traits>

#include "testing.hpp"

/// Generated pairs of triangles for tests: a pattern is how the two lie relative to each other, a placement is where
/// the pair lies, how large it is, and what rounding does to the pattern.
namespace triangle_pairs {

using point = std::array<double, 3>;
using triangle = std::array<point, 3>;
using pair = std::array<triangle, 2>;
using generator = std::mt19937_64;

inline constexpr std::array<std::string_view, 9> patterns = {
    "grid",         "shared corner", "shared edge",      "corner in plane of face", "corner on edge",
    "edge on edge", "coplanar",      "one of zero area", "both of zero area"};
inline constexpr std::array<std::string_view, 7> placements = {"as is",   "tenths", "far away",        "denormal",
                                                               "largest", "turned", "nudged by an ulp"};

/// The same as a triangle3, rounded to its numbers.
template <class Triangle>
Triangle as(const triangle& t) {
    Triangle result{};
    for (int i = 0; i < 3; ++i)
        for (int k = 0; k < 3; ++k)
            result[i][k] = static_cast<std::remove_cvref_t<decltype(result[i][k])>>(
                t[static_cast<std::size_t>(i)][static_cast<std::size_t>(k)]);
    return result;
}

inline int integer(generator& g, int low, int high) {
    return std::uniform_int_distribution<int>(low, high)(g);
}

inline point grid_point(generator& g, int most) {
    return {double(integer(g, -most, most)), double(integer(g, -most, most)), double(integer(g, -most, most))};
}

/// p + (q - p) · numerator / 4.
inline point quarter(const point& p, const point& q, int numerator) {
    point r{};
    for (std::size_t k = 0; k < 3; ++k) r[k] = p[k] + (q[k] - p[k]) * numerator / 4;
    return r;
}

inline triangle flattened(generator& g, const triangle& t) {
    triangle flat{t[0], t[1], quarter(t[0], t[1], integer(g, -4, 8))};
    if (integer(g, 0, 3) == 0) flat[1] = flat[2];
    if (integer(g, 0, 3) == 0) flat[0] = flat[2];
    std::shuffle(flat.begin(), flat.end(), g);
    return flat;
}

/// Corners are multiples of 1/16 within ±64, so the pattern holds exactly.
inline pair patterned(generator& g, std::size_t pattern) {
    const int most = integer(g, 1, 3);
    pair result{};
    for (triangle& t : result)
        for (point& p : t) p = grid_point(g, most);
    auto& [s, t] = result;
    switch (pattern) {
        case 1: t[0] = s[1]; break;
        case 2:
            t[0] = s[1];
            t[1] = s[2];
            break;
        case 3: t[0] = quarter(quarter(s[0], s[1], integer(g, -1, 5)), s[2], integer(g, -1, 5)); break;
        case 4: t[0] = quarter(s[0], s[1], integer(g, -1, 5)); break;
        case 5: {
            const point middle = quarter(s[0], s[1], integer(g, -1, 5));
            for (std::size_t k = 0; k < 3; ++k) t[1][k] = 2 * middle[k] - t[0][k];
            break;
        }
        case 6: {
            const int a = integer(g, -2, 2);
            const int b = integer(g, -2, 2);
            for (triangle& u : result)
                for (point& p : u) p[2] = a * p[0] + b * p[1];
            break;
        }
        case 7: t = flattened(g, t); break;
        case 8:
            s = flattened(g, s);
            t = flattened(g, t);
            if (integer(g, 0, 2) == 0)  // on the line of s
                for (point& p : t) p = quarter(s[0], s[1], integer(g, -8, 8));
            break;
        default: break;
    }
    std::shuffle(s.begin(), s.end(), g);
    std::shuffle(t.begin(), t.end(), g);
    if (integer(g, 0, 1) == 1) std::swap(s, t);
    return result;
}

/// The pattern moved to where the placement says, with values of type Real, stored in double.
template <class Real>
pair placed(generator& g, pair result, std::size_t placement) {
    using limits = std::numeric_limits<Real>;
    std::array<std::size_t, 3> axes{0, 1, 2};
    std::shuffle(axes.begin(), axes.end(), g);
    std::array<point, 3> turn{};
    for (point& row : turn)
        for (double& x : row) x = std::uniform_real_distribution(-1.0, 1.0)(g);
    const point offset = grid_point(g, 1'000'000);
    for (triangle& t : result)
        for (point& p : t) {
            point q{};
            for (std::size_t k = 0; k < 3; ++k) {
                const double x = p[axes[k]];
                switch (placement) {
                    case 1: q[k] = x * 0.1; break;
                    case 2: q[k] = x * 0.1 + offset[k]; break;
                    case 3: q[k] = x * 16 * double{limits::denorm_min()}; break;
                    case 4: q[k] = x / 64 * double{limits::max()}; break;
                    case 5: q[k] = turn[k][0] * p[0] + turn[k][1] * p[1] + turn[k][2] * p[2]; break;
                    default: q[k] = x; break;
                }
                auto rounded = static_cast<Real>(q[k]);
                if (placement == 6 && integer(g, 0, 5) == 0)
                    rounded = std::nextafter(rounded, static_cast<Real>(integer(g, -9, 9)));
                q[k] = double{rounded};
            }
            p = q;
        }
    return result;
}

/// Coordinates whose exponents are spread over the whole range of Real, many of them equal, zero or at its ends.
template <class Real>
pair spread(generator& g) {
    using limits = std::numeric_limits<Real>;
    std::array<Real, 6> values{0, limits::denorm_min(), limits::max(), 1};
    for (std::size_t i = 4; i < values.size(); ++i)
        values[i] = static_cast<Real>(
            std::ldexp(1 + integer(g, 0, 7) / 8.0, integer(g, limits::min_exponent - 20, limits::max_exponent - 1)));
    pair result{};
    for (triangle& t : result)
        for (point& p : t)
            for (double& x : p)
                x = double{values[static_cast<std::size_t>(integer(g, 0, 5))]} * (integer(g, 0, 1) == 0 ? -1 : 1);
    return result;
}

}  // namespace triangle_pairs
