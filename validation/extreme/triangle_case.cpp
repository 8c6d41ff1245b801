module aabb.extreme;

import aabb.geometry;

namespace aabb {

namespace {

constexpr std::array<std::array<int, 3>, 6> orders{{{0, 1, 2}, {0, 2, 1}, {1, 0, 2}, {1, 2, 0}, {2, 0, 1}, {2, 1, 0}}};

template <class Real>
triangle3<Real> rounded(const triangle3d& t, const std::array<int, 3>& order) {
    triangle3<Real> made{};
    for (int i = 0; i < 3; ++i)
        for (int k = 0; k < 3; ++k) made[i][k] = static_cast<Real>(t[order[static_cast<std::size_t>(i)]][k]);
    return made;
}

}  // namespace

template <class Real>
std::vector<triangle_pair<Real>> every_order(const triangle_case& one) {
    std::vector<triangle_pair<Real>> all;
    for (const auto& order_a : orders)
        for (const auto& order_b : orders) {
            const triangle3<Real> a = rounded<Real>(one.first, order_a);
            const triangle3<Real> b = rounded<Real>(one.second, order_b);
            all.push_back({a, b});
            all.push_back({b, a});
        }
    return all;
}

template std::vector<triangle_pair<float>> every_order(const triangle_case& one);
template std::vector<triangle_pair<double>> every_order(const triangle_case& one);

}  // namespace aabb
