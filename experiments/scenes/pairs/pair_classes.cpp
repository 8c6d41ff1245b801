module;
#include <Eigen/Core>

module aabblab.scenes;

import :random;

namespace aabblab {

namespace {

using Eigen::Vector3d;
using triangle = std::array<Vector3d, 3>;
struct pair {
    triangle a;
    triangle b;
};

/// The floating-point format to which a pair is rounded.
struct format {
    double smallest;  ///< denormal
    double largest;
    double epsilon;  ///< from 1 to the next greater number
};
template <class Real>
constexpr format format_of{double{std::numeric_limits<Real>::denorm_min()}, double{std::numeric_limits<Real>::max()},
                           double{std::numeric_limits<Real>::epsilon()}};

pair changed(pair p, auto change) {
    for (triangle* t : {&p.a, &p.b})
        for (Vector3d& corner : *t) corner = change(corner);
    return p;
}

triangle any_triangle(random_source& random) {
    return {random.point(1), random.point(1), random.point(1)};
}

pair any_pair(random_source& random) {
    return {any_triangle(random), any_triangle(random)};
}

/// A point in the plane of a triangle, inside or near it.
Vector3d near_triangle(random_source& random, const triangle& t) {
    const double u = 2 * random.unit() - 0.5;
    const double v = 2 * random.unit() - 0.5;
    return t[0] + (t[1] - t[0]) * u + (t[2] - t[0]) * v;
}

/// A point with integer coordinates from 0 to `most`. As everywhere here, braces are evaluated from left to right.
Vector3d lattice_point(random_source& random, std::uint32_t most) {
    const auto coordinate = [&] { return static_cast<double>(random.below(most + 1)); };
    return Vector3d{coordinate(), coordinate(), coordinate()};
}
triangle lattice_triangle(random_source& random, std::uint32_t most) {
    return {lattice_point(random, most), lattice_point(random, most), lattice_point(random, most)};
}
pair lattice_pair(random_source& random, std::uint32_t most) {
    return {lattice_triangle(random, most), lattice_triangle(random, most)};
}

/// The second triangle lies in the first's plane, but for rounding and random changes by -1, 0 or 1 last places.
pair near_coplanar(random_source& random, const format& f) {
    pair p = any_pair(random);
    for (Vector3d& corner : p.b) {
        corner = near_triangle(random, p.a);
        for (int k = 0; k < 3; ++k) corner[k] *= 1 + (static_cast<double>(random.below(3)) - 1) * f.epsilon;
    }
    return p;
}

pair vertex_on_plane(random_source& random, const format&) {
    pair p = any_pair(random);
    p.b[0] = near_triangle(random, p.a);
    return p;
}

pair edge_on_edge(random_source& random, const format&) {
    pair p = any_pair(random);
    const Vector3d meeting = p.a[0] + (p.a[1] - p.a[0]) * (1.5 * random.unit() - 0.25);
    p.b[1] = meeting + (meeting - p.b[0]) * random.unit();
    return p;
}

pair shared_vertex(random_source& random, const format&) {
    pair p = any_pair(random);
    p.b[0] = p.a[1];
    return p;
}

pair shared_edge(random_source& random, const format&) {
    pair p = any_pair(random);
    p.b[0] = p.a[2];
    p.b[1] = p.a[1];
    return p;
}

/// Both lie in a plane z = m x + n y with integer coordinates, which are exact.
pair skew_coplanar(random_source& random, const format&) {
    const double m = static_cast<double>(random.below(7)) - 3;
    const double n = static_cast<double>(random.below(7)) - 3;
    return changed(lattice_pair(random, 1000),
                   [&](const Vector3d& p) -> Vector3d { return {p[0], p[1], m * p[0] + n * p[1]}; });
}

pair coplanar(random_source& random, const format&) {
    const double height = random.unit();
    return changed(any_pair(random), [&](const Vector3d& p) -> Vector3d { return {p[0], p[1], height}; });
}

/// Two triangles of length 1 and height up to 1e-6 whose long edges pass a common point within this height.
pair sliver(random_source& random, const format&) {
    constexpr double height = 1e-6;
    pair p = any_pair(random);
    const Vector3d meeting = random.point(1);
    for (triangle* t : {&p.a, &p.b}) {
        const Vector3d along = random.direction();
        const Vector3d off = random.direction();
        const double before_meeting = random.unit();
        const Vector3d start = meeting - along * before_meeting + off * (height * random.signed_unit());
        *t = {start, start + along, start + along * random.unit() + off * height};
    }
    return p;
}

/// Makes triangles of area 0: the second, and the first in half of the pairs, is a segment or, seldom, a point.
pair zero_area(random_source& random, const format&) {
    pair p = lattice_pair(random, /*most=*/4);
    const auto flatten = [&](triangle& t) {
        const double along = static_cast<double>(random.below(4)) - 1;  // -1 to 2: also beyond both ends of the edge
        t[2] = t[0] + (t[1] - t[0]) * along;
        if (random.below(4) == 0) t[1] = t[0];
        std::swap(t[0], t[random.below(3)]);
    };
    flatten(p.b);
    if (random.below(2) == 0) flatten(p.a);
    return p;
}

pair denormal(random_source& random, const format& f) {
    return changed(lattice_pair(random, 64), [&](const Vector3d& p) -> Vector3d { return p * f.smallest; });
}

pair huge(random_source& random, const format& f) {
    return changed(any_pair(random), [&](const Vector3d& p) -> Vector3d { return p * f.largest; });
}

/// Size 100 at a distance of a million, where floats have a spacing of 1/16.
pair far(random_source& random, const format&) {
    return changed(any_pair(random), [](const Vector3d& p) -> Vector3d { return p * 100 + Vector3d::Constant(1e6); });
}

/// The second triangle is up to a million times larger or smaller, and close to the first.
pair mixed_magnitudes(random_source& random, const format&) {
    pair p = any_pair(random);
    const Vector3d meeting = near_triangle(random, p.a);
    const double size = std::ldexp(1, static_cast<int>(random.below(41)) - 20);
    for (Vector3d& corner : p.b) corner = meeting + (corner - Vector3d::Constant(0.5)) * size;
    return p;
}

struct pair_class {
    pair_class_info info;
    pair (*make)(random_source&, const format&);
};

constexpr std::array<pair_class, 16> classes{{
    {{"random", "corners anywhere in a unit cube"},
     [](random_source& random, const format&) { return any_pair(random); }},
    {{"small", "the same at a thousandth of the size"},
     [](random_source& random, const format&) {
         return changed(any_pair(random), [](const Vector3d& p) -> Vector3d { return p * 1e-3; });
     }},
    {{"near_coplanar", "in one plane to within one unit in the last place"}, near_coplanar},
    {{"vertex_on_plane", "a corner in the other's plane, up to rounding"}, vertex_on_plane},
    {{"edge_on_edge", "an edge through a point of an edge, up to rounding"}, edge_on_edge},
    {{"shared_vertex", "one shared corner"}, shared_vertex},
    {{"shared_edge", "two shared corners"}, shared_edge},
    {{"skew_coplanar", "in one tilted plane, with integer coordinates"}, skew_coplanar},
    {{"coplanar", "in one horizontal plane"}, coplanar},
    {{"sliver", "with a height of a millionth of the length"}, sliver},
    {{"lattice", "corners on a lattice of 4 x 4 x 4 points, with many equal coordinates"},
     [](random_source& random, const format&) { return lattice_pair(random, 3); }},
    {{"zero_area", "one or both are segments or points"}, zero_area},
    {{"denormal", "with multiples of the smallest positive number"}, denormal},
    {{"huge", "with coordinates up to the greatest number"}, huge},
    {{"far", "of size 100, a million from the origin"}, far},
    {{"mixed_magnitudes", "one up to a million times as large as the other"}, mixed_magnitudes},
}};

template <class Real>
aabb::triangle3<Real> rounded(const triangle& t) {
    aabb::triangle3<Real> result{};
    for (int i = 0; i < 3; ++i)
        for (int k = 0; k < 3; ++k) result[i][k] = static_cast<Real>(t[static_cast<std::size_t>(i)][k]);
    return result;
}

}  // namespace

/// The names and summaries of all classes of pairs.
std::span<const pair_class_info> pair_classes() {
    static const std::vector<pair_class_info> infos = [] {
        std::vector<pair_class_info> list;
        for (const pair_class& c : classes) list.push_back(c.info);
        return list;
    }();
    return infos;
}

template <class Real>
struct pair_source<Real>::state {
    const pair_class* generator;
    random_source random;
};

/// A source of pairs of the class of this name. Each class has a seed of its own, or classes would share their corners.
template <class Real>
pair_source<Real>::pair_source(std::string_view name, std::uint64_t seed) {
    const auto entry = std::ranges::find(classes, name, [](const pair_class& c) { return c.info.name; });
    if (entry == classes.end()) {
        std::vector<std::string> names;
        for (const pair_class& c : classes) names.emplace_back(c.info.name);
        throw aabb::input_error(aabb::unknown_name("class of pairs", name, names, "aabblab list pairs"));
    }
    const auto number = static_cast<std::uint64_t>(entry - classes.begin());
    state_ = std::make_unique<state>(&*entry, random_source(seed * classes.size() + number));
}

template <class Real>
pair_source<Real>::~pair_source() = default;

template <class Real>
void pair_source<Real>::next(std::span<aabb::triangle_pair<Real>> pairs) {
    for (aabb::triangle_pair<Real>& p : pairs) {
        const pair unrounded = state_->generator->make(state_->random, format_of<Real>);
        p = {rounded<Real>(unrounded.a), rounded<Real>(unrounded.b)};
    }
}

template class pair_source<float>;
template class pair_source<double>;

}  // namespace aabblab
