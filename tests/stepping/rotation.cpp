#include "../testing.hpp"

import aabb.geometry;
import aabblab.stepping;

using aabb::vec3d;

namespace {

/// A box without two equal moments, that is neither released along its axes nor turns about one of them.
aabblab::motion_state tumbling(const aabblab::rotor& r) {
    aabblab::motion_state state;
    const std::array<double, 4> orientation = {0.1, -0.5, 0.1, std::sqrt(0.73)};
    state.orientation.assign(orientation.begin(), orientation.end());
    const vec3d momentum = aabblab::angular_momentum_of(r, orientation, {0.4, 2, -0.7});
    state.angular_momentum = {momentum[0], momentum[1], momentum[2]};
    return state;
}

const aabblab::matrix3 box = aabblab::inertia_of_box(1, {1, 2, 3});

/// A force of constant direction on a point of the body off its centre.
aabblab::equations_of_motion pushed(const aabblab::rotor& r) {
    return {[](const aabblab::motion_state& s, aabblab::motion_rates& rates) {
                const aabblab::matrix3 rotation = aabblab::matrix_of(s.orientation_of(0));
                const vec3d arm{rotation[0], rotation[3], rotation[6]};  // the image of (1, 0, 0)
                const vec3d torque = cross(arm, vec3d{0.5, 0, -1});
                std::ranges::copy(torque.at, rates.torque.begin());
            },
            {r}};
}

aabblab::motion_state after_a_second(const aabblab::integrator_info& info,
                                     const aabblab::equations_of_motion& equations, aabblab::motion_state state,
                                     double step) {
    const auto stepper = info.make(1e-12);
    for (int i = 0; i < std::lround(1 / step); ++i) stepper->advance(equations, state, step);
    return state;
}

/// The greatest difference of a component of orientation or angular momentum; q and -q are the same orientation.
double difference(const aabblab::motion_state& s, const aabblab::motion_state& t) {
    double same = 0, opposite = 0, greatest = 0;
    for (std::size_t i = 0; i < 4; ++i) {
        same = std::max(same, std::abs(s.orientation[i] - t.orientation[i]));
        opposite = std::max(opposite, std::abs(s.orientation[i] + t.orientation[i]));
    }
    for (std::size_t i = 0; i < 3; ++i)
        greatest = std::max(greatest, std::abs(s.angular_momentum[i] - t.angular_momentum[i]));
    return std::max(greatest, std::min(same, opposite));
}

double energy(const aabblab::rotor& r, const aabblab::motion_state& s) {
    const vec3d w = aabblab::angular_velocity_of(r, s.orientation_of(0), s.momentum_of(0));
    return (w[0] * s.angular_momentum[0] + w[1] * s.angular_momentum[1] + w[2] * s.angular_momentum[2]) / 2;
}

}  // namespace

TEST_CASE("a torque turns a body with the order of every integrator, on the group of rotations") {
    const aabblab::rotor r = aabblab::rotor_of(box);
    const aabblab::equations_of_motion equations = pushed(r);
    const aabblab::motion_state start = tumbling(r);
    const aabblab::motion_state reference =
        after_a_second(*aabblab::integrator_named("dormand_prince"), equations, start, 1e-3);
    REQUIRE(difference(start, reference) > 0.5);
    for (const aabblab::integrator_info& info : aabblab::integrators()) {
        INFO(info.name);
        const aabblab::motion_state end = after_a_second(info, equations, start, 0.02);
        const double length = std::hypot(std::hypot(end.orientation[0], end.orientation[1]),
                                         std::hypot(end.orientation[2], end.orientation[3]));
        REQUIRE(std::abs(length - 1) < 1e-14);
        const double coarse = difference(end, reference);
        if (info.adaptive) {
            REQUIRE(coarse < 1e-8);
            continue;
        }
        const double order = std::log2(coarse / difference(after_a_second(info, equations, start, 0.01), reference));
        REQUIRE(order > info.order - 0.2);
        REQUIRE(coarse < 0.1);
    }
}

TEST_CASE("a free body keeps its angular momentum, and its energy does not drift with fixed steps of Euler or Verlet") {
    const aabblab::rotor r = aabblab::rotor_of(box);
    const aabblab::equations_of_motion free{[](const auto&, auto& rates) { rates.torque = {0, 0, 0}; }, {r}};
    for (const aabblab::integrator_info& info : aabblab::integrators()) {
        INFO(info.name);
        const auto stepper = info.make(1e-10);
        aabblab::motion_state state = tumbling(r);
        const std::vector<double> momentum = state.angular_momentum;
        const double initial = energy(r, state);
        double early = 0, late = 0;
        for (int i = 0; i < 20000; ++i) {
            stepper->advance(free, state, 0.05);
            double& greatest = i < 10000 ? early : late;
            greatest = std::max(greatest, std::abs(energy(r, state) / initial - 1));
        }
        for (std::size_t i = 0; i < 3; ++i) REQUIRE(std::abs(state.angular_momentum[i] - momentum[i]) < 1e-12);
        if (info.is_symplectic()) {
            REQUIRE(early < 0.01);
            REQUIRE(late < 1.05 * early);
        }
    }
}

TEST_CASE("bodies with two equal moments turn exactly, by any step") {
    // A symmetric top precesses about L by L/I₁ and spins about its axis e by (1/I₃ - 1/I₁) L·e.
    const aabblab::rotor disc = aabblab::rotor_of(aabblab::inertia_of_disc(2, 3));
    REQUIRE(disc.moments == vec3d{4.5, 4.5, 9});
    std::array<double, 4> by_one_step = {0, 0, 0, 1}, by_many_steps = by_one_step;
    const std::array<double, 3> momentum = {3, -1, 5};
    aabblab::turn_freely(disc, by_one_step, momentum, 4);
    for (int i = 0; i < 400; ++i) aabblab::turn_freely(disc, by_many_steps, momentum, 0.01);
    for (std::size_t i = 0; i < 4; ++i) REQUIRE(std::abs(by_one_step[i] - by_many_steps[i]) < 1e-13);
    // The axis circles about L: its angle to L stays, and it turns by |L|/I₁ per second.
    const aabblab::matrix3 rotation = aabblab::matrix_of(by_one_step);
    const vec3d axis{rotation[2], rotation[5], rotation[8]}, l{3, -1, 5};
    REQUIRE(std::abs(dot(axis, l) - 5) < 1e-13);
    const double length = std::sqrt(dot(l, l));
    const auto across = [&](const vec3d& v) { return cross(l, v); };
    const double cosine = dot(across(axis), across({0, 0, 1})) / dot(across({0, 0, 1}), across({0, 0, 1}));
    REQUIRE(std::abs(cosine - std::cos(4 * length / 4.5)) < 1e-12);
}

TEST_CASE("a tensor in turned axes has the same principal moments, and turns the body in the same way") {
    const std::array<double, 4> turn = {0.5, 0.1, -0.5, 0.7};
    const std::array<double, 4> unit = aabblab::of_length_1(turn);
    const aabblab::matrix3 q = aabblab::matrix_of(unit);
    aabblab::matrix3 turned{};  // Qᵀ I Q, of a mesh whose axes are turned by Q
    for (std::size_t i = 0; i < 3; ++i)
        for (std::size_t j = 0; j < 3; ++j)
            for (std::size_t k = 0; k < 3; ++k) turned[3 * i + j] += q[3 * k + i] * box[4 * k] * q[3 * k + j];
    const aabblab::rotor straight = aabblab::rotor_of(box), oblique = aabblab::rotor_of(turned);
    std::array<double, 3> moments = {oblique.moments[0], oblique.moments[1], oblique.moments[2]};
    std::ranges::sort(moments);
    REQUIRE(std::abs(moments[0] - 5.0 / 12) < 1e-12);
    REQUIRE(std::abs(moments[1] - 10.0 / 12) < 1e-12);
    REQUIRE(std::abs(moments[2] - 13.0 / 12) < 1e-12);
    std::array<double, 4> of_straight = {0, 0, 0, 1}, of_oblique = unit;
    const std::array<double, 3> momentum = {1, 2, 3};
    aabblab::turn_freely(straight, of_straight, momentum, 0.3);
    aabblab::turn_freely(oblique, of_oblique, momentum, 0.3);
    const aabblab::matrix3 a = aabblab::matrix_of(of_straight), b = aabblab::matrix_of(of_oblique);
    for (std::size_t i = 0; i < 3; ++i)
        for (std::size_t j = 0; j < 3; ++j)
            REQUIRE(std::abs(a[3 * i] * q[j] + a[3 * i + 1] * q[3 + j] + a[3 * i + 2] * q[6 + j] - b[3 * i + j]) <
                    1e-13);
    const vec3d w = aabblab::angular_velocity_of(oblique, of_oblique, momentum);
    const vec3d l = aabblab::angular_momentum_of(oblique, of_oblique, w);
    for (int i = 0; i < 3; ++i) REQUIRE(std::abs(l[i] - (i + 1)) < 1e-13);
}

TEST_CASE("homogeneous bodies have the moments of textbooks") {
    REQUIRE(std::abs(aabblab::inertia_of_ball(5, 2)[4] - 8) < 1e-14);
    const aabblab::matrix3 of_box = aabblab::inertia_of_box(12, {1, 2, 3});
    REQUIRE(of_box == aabblab::matrix3{13, 0, 0, 0, 10, 0, 0, 0, 5});
}
