module;
#include <boost/math/special_functions/ellint_1.hpp>
#include <boost/math/special_functions/jacobi_elliptic.hpp>

module aabblab.stiff;

import :rules;
import :shapes;
import :simulation;

namespace aabblab {

namespace {

// Moments of inertia, kg m², about the axes of the mesh.
constexpr double least_moment = 2, middle_moment = 3, greatest_moment = 4;

/// The angular velocity of a free body about its principal axes (Jacobi 1849; Landau and Lifshitz, Mechanics, §37).
class free_rotation {
public:
    /// The body starts with components w1 and w3 > 0 about the axes of the least and the greatest moment.
    free_rotation(double w1, double w3) : first_(w1), third_(w3) {
        constexpr double a = least_moment, b = middle_moment, c = greatest_moment;
        second_ = w1 * std::sqrt(a * (c - a) / (b * (c - b)));
        rate_ = w3 * std::sqrt((c - b) * (c - a) / (a * b));
        modulus_ = std::sqrt((b - a) * a / ((c - b) * c)) * w1 / w3;
    }

    [[nodiscard]] aabb::vec3d angular_velocity(double time) const {
        double cn = 0;
        const double sn = boost::math::jacobi_elliptic(modulus_, rate_ * time, &cn, static_cast<double*>(nullptr));
        // Boost's dn loses all but three digits where cn vanishes.
        const double dn = std::sqrt(1 - modulus_ * modulus_ * sn * sn);
        return {first_ * cn, second_ * sn, third_ * dn};
    }
    /// The time between flips, at which the spin about the middle axis changes its sign: 2 K(m)/s.
    [[nodiscard]] double flip_interval() const { return 2 * boost::math::ellint_1(modulus_) / rate_; }

private:
    double first_, second_, third_;  // amplitudes
    double rate_;                    // s
    double modulus_;                 // k, with m = k²
};

constexpr double w3 = 5;  // rad/s
// The modulus k² = m is 0.9, so that the body mostly spins about its middle axis.
const double w1 = w3 * std::sqrt(0.9 * 2);

using vector = std::array<double, 3>;

vector cross(const vector& a, const vector& b) {
    return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}
vector sum(const vector& a, double factor, const vector& b) {
    return {a[0] + factor * b[0], a[1] + factor * b[1], a[2] + factor * b[2]};
}

/// The time of the third flip by explicit Euler with steps of h, up to terms of second order. The angular velocity w of
/// a step is as old as its start, on average half a step: the angular momentum in the body, l, follows the modified
/// equation l' = l × (w - h/2 w') (Hairer, Lubich and Wanner 2006, IX.1), here by Runge-Kutta steps. The energy grows
/// by h/2 Σ I w'² per second, and with it the time from flip to flip.
double third_flip_by_euler(double step) {
    const auto angular_velocity = [](const vector& l) -> vector {
        return {l[0] / least_moment, l[1] / middle_moment, l[2] / greatest_moment};
    };
    const auto rate = [&](const vector& l) {
        const vector w = angular_velocity(l);
        return cross(l, sum(w, -step / 2, angular_velocity(cross(l, w))));
    };
    constexpr double part = 1e-3;  // s: the error is below 1e-9
    vector l = {least_moment * w1, 0, greatest_moment * w3};
    double time = 0, previous = 0;
    for (int flips = 0; flips < 3; time += part) {
        previous = l[1];
        const vector k1 = rate(l), k2 = rate(sum(l, part / 2, k1)), k3 = rate(sum(l, part / 2, k2));
        const vector k4 = rate(sum(l, part, k3));
        l = sum(l, part / 6, sum(sum(sum(k1, 2, k2), 2, k3), 1, k4));
        if (previous * l[1] < 0) ++flips;
    }
    return time - part * l[1] / (l[1] - previous);
}

/// By how much longer the body takes from flip to flip, relative, if its energy is greater by a share, at the same
/// angular momentum: both give the amplitudes w1 and w3. Infinite from the energy on at which it spins about its middle
/// axis for ever.
double lengthening_by(double energy_share) {
    constexpr double a = least_moment, b = middle_moment, c = greatest_moment;
    const double twice_energy = (a * w1 * w1 + c * w3 * w3) * (1 + energy_share);
    const double momentum_squared = a * a * w1 * w1 + c * c * w3 * w3;
    if (b * twice_energy >= momentum_squared) return std::numeric_limits<double>::infinity();
    const free_rotation changed(std::sqrt((c * twice_energy - momentum_squared) / (a * (c - a))),
                                std::sqrt((momentum_squared - a * twice_energy) / (c * (c - a))));
    return changed.flip_interval() / free_rotation(w1, w3).flip_interval() - 1;
}

/// A bound of the relative error of the third flip with steps of h, to leading order. In a step of the angle y = Ω h,
/// with the greatest angular velocity Ω, that at the start, an integrator of order p turns the body with an error of
/// C y^(p+1), where C is that of its half period over π. The angular momentum is kept: so the error changes the energy,
/// per step by at most 2 C y^(p+1), with which the body takes longer from flip to flip, and the rate of turning, by
/// C y^p. Of explicit Euler, which gains energy in every step, the leading error is known; the next term is smaller by
/// a factor of y.
double flip_error_of(const integrator_info& i, double step) {
    const double third = 3 * free_rotation(w1, w3).flip_interval();
    const double y = std::hypot(w1, w3) * step;
    if (i.order == 1) return (1 + y) * std::abs(third_flip_by_euler(step) / third - 1);
    const double rate = i.half_period_error / std::numbers::pi * std::pow(y, i.order);
    return rate + lengthening_by(2 * rate * y * third / step);
}

/// A body that touches nothing. Its box meets that of an oblique plate whose springs reach it, so a contact that is not
/// there would turn it.
stepped_world free_body() {
    stepped_world world;
    world.meshes = {floor_of(4), slab(1, 0.25F)};
    const double s = std::sqrt(0.5);
    world.bodies = {{.position = {0, s, -s}, .rotation = {1, 0, 0, 0, s, -s, 0, s, s}},
                    {.mesh = 1,
                     .mass = 1,
                     .inertia = matrix3{least_moment, 0, 0, 0, middle_moment, 0, 0, 0, greatest_moment},
                     .angular_velocity = {w1, 0, w3}}};
    world.law = {.geometry = contact_geometry::each_vertex, .stiffness = 100, .rest = 2};
    return world;
}

/// The components of a vector along the axes of the body: Rᵀ v.
vector in_body(const motion_state& state, const aabb::vec3d& v) {
    const matrix3 r = matrix_of(state.orientation_of(0));
    vector components{};
    for (std::size_t i = 0; i < 3; ++i) components[i] = r[i] * v[0] + r[3 + i] * v[1] + r[6 + i] * v[2];
    return components;
}

double distance(const vector& a, const vector& b) {
    return std::hypot(a[0] - b[0], a[1] - b[1], a[2] - b[2]);
}

/// Angular momentum from the angular velocity.
struct momentum {
    vector in_body, in_world;
};
momentum momentum_of(const motion_state& state, const aabb::vec3d& angular_velocity) {
    vector l = in_body(state, angular_velocity);
    constexpr vector moments = {least_moment, middle_moment, greatest_moment};
    for (std::size_t i = 0; i < 3; ++i) l[i] *= moments[i];
    const matrix3 r = matrix_of(state.orientation_of(0));
    vector world{};
    for (std::size_t i = 0; i < 3; ++i) world[i] = r[3 * i] * l[0] + r[3 * i + 1] * l[1] + r[3 * i + 2] * l[2];
    return {l, world};
}

/// Errors of a run, relative.
struct free_run {
    double direction = 0;  // of the angular momentum in the body at the end
    double energy = 0;     // the greatest
    double momentum = 0;   // of the angular momentum in the world, the greatest
    std::vector<double> flips;
};

/// Lets the body turn freely for three flips and a half. Flips are interpolated between steps.
/// @param plotted the label of its line in the figure, or empty
free_run run_freely(const candidate& tested, const integrator_info& stepping, std::size_t steps, double tolerance,
                    std::string_view plotted, stiff_result& result) {
    const free_rotation exact(w1, w3);
    const double end = 3.5 * exact.flip_interval();
    const stepped_world world = free_body();
    simulation body(world, tested, stepping, tolerance);
    const double initial_energy = body.energy();
    const vector initial_momentum = momentum_of(body.state(), body.angular_velocity(1)).in_world;
    const double size = distance(initial_momentum, {});
    free_run run;
    double previous_spin = 0;
    for (std::size_t s = 1; s <= steps; ++s) {
        body.advance(end / static_cast<double>(steps));
        const aabb::vec3d turning = body.angular_velocity(1);
        const double spin = in_body(body.state(), turning)[1];
        if (spin * previous_spin < 0)
            run.flips.push_back(body.state().time - end / static_cast<double>(steps) * spin / (spin - previous_spin));
        previous_spin = spin;
        run.energy = std::max(run.energy, std::abs(body.energy() / initial_energy - 1));
        run.momentum =
            std::max(run.momentum, distance(momentum_of(body.state(), turning).in_world, initial_momentum) / size);
        if (!plotted.empty() && s % std::max<std::size_t>(steps / 100, 1) == 0) {
            result.plot("flips", plotted, body.state().time, spin);
        }
    }
    const aabb::vec3d w = exact.angular_velocity(end);
    const vector l = momentum_of(body.state(), body.angular_velocity(1)).in_body;
    run.direction = distance(l, {least_moment * w[0], middle_moment * w[1], greatest_moment * w[2]}) / size;
    return run;
}

/// Compares a fixed step with half of it.
void judge_fixed_steps(const stiff_setting& setting, const integrator_info& i, stiff_result& result) {
    // Steps at which the errors of each order are small.
    const std::size_t steps = i.order == 1 ? 25'000 : i.order == 2 ? 2000 : 500;
    const std::string name(i.name);
    const free_run whole = run_freely(setting.tested, i, steps, 0, {}, result);
    const free_run half = run_freely(setting.tested, i, 2 * steps, 0, name, result);
    const double interval = free_rotation(w1, w3).flip_interval();
    result.add(
        at_least(name, "order of the direction error", std::log2(whole.direction / half.direction), i.order - 0.2));
    result.add(at_least(name, "order of the energy error", std::log2(whole.energy / half.energy), i.order - 0.2));
    result.add(at_most(name, "angular momentum in the world, relative change", half.momentum, 1e-12));
    if (whole.flips.size() < 3 || half.flips.size() < 3) {
        result.add({name, "third flip (s)", std::numeric_limits<double>::quiet_NaN(), short_number(3 * interval),
                    stiff_verdict::fails});
        return;
    }
    // Half the step has at most half the error, so at most the difference of both.
    const double half_step = 3.5 * interval / static_cast<double>(2 * steps);
    const double tolerance =
        std::min(std::abs(half.flips[2] - whole.flips[2]) / (3 * interval), flip_error_of(i, half_step));
    result.add(within(name, "third flip (s)", half.flips[2], 3 * interval, tolerance));
}

}  // namespace

/// Lets a body turn freely with each way of turning bodies, and compares it with the closed form.
void run_free_body(const stiff_setting& setting, stiff_result& result) {
    const free_rotation exact(w1, w3);
    for (int s = 0; s <= 200; ++s) {
        const double time = 3.5 * exact.flip_interval() * s / 200;
        result.plot("flips", "closed form", time, exact.angular_velocity(time)[1]);
    }
    for (const integrator_info& i : integrators_of(setting)) {
        // These turn a free body as velocity_verlet does.
        if (i.name == "symplectic_euler" || i.name == "implicit_midpoint") continue;
        run_or_record_failure(result, i.name, [&] {
            if (!i.adaptive) {
                judge_fixed_steps(setting, i, result);
                return;
            }
            for (const double tolerance : {1e-6, 1e-9}) {
                const std::string subject = std::string(i.name) + ", tolerance " + short_number(tolerance);
                const free_run run = run_freely(setting.tested, i, 100, tolerance, {}, result);
                result.add(reported(subject, "direction error (relative)", run.direction));
                result.add(at_most(subject, "angular momentum in the world, relative change", run.momentum, 1e-12));
            }
        });
    }
}

stiff_study free_body_study() {
    return {
        "free_body",
        "A body with moments of inertia 2, 3 and 4 kg m² spins about its middle axis, touches nothing, and flips "
        "again and again (Dzhanibekov). Half the step divides errors by 2 to the power of the order: those of "
        "the direction of the angular momentum in the body after three flips and a half, and of the energy. The "
        "angular momentum in the world stays. symplectic_euler and implicit_midpoint turn it as velocity_verlet "
        "does",
        "Jacobi's solution (Landau and Lifshitz, Mechanics, §37): angular velocities in proportion to cn, sn and dn "
        "of s t, with s = w3 √((c-b)(c-a)/(ab)) and m = (b-a) a w1²/((c-b) c w3²) for moments a < b < c, so a flip "
        "every 2 K(m)/s; functions of Boost.Math. Tolerance of the third flip: the difference between a step and "
        "half of it, but at most the leading error of the integrator",
        &run_free_body,
        {figure{.name = "flips",
                .caption = "The spin of a free body about its middle axis, which changes its sign every 2 K(m)/s.",
                .x = {"time (s)"},
                .y = {"spin about the middle axis (rad/s)"},
                .lines = {{"closed form"},
                          {"explicit_euler", series_style::points},
                          {"velocity_verlet", series_style::points},
                          {"runge_kutta_4", series_style::points},
                          {"dormand_prince", series_style::points}}}}};
}

}  // namespace aabblab
