module aabblab.stiff;

import :incline;
import :rules;
import :simulation;

namespace aabblab {

namespace {

constexpr double friction = 0.3;             // μ
constexpr double speed = 1;                  // R ω₀, m/s
constexpr double slip_speed = 1e-3 * speed;  // m/s
constexpr double stiffness = 1e6;            // of all tips, N/m
constexpr std::uint32_t tips = 400;

/// A thin disc that stands on tips, each a triangle that meets the floor only there. They share the area equally, on
/// the golden-angle spiral, and lie in the plane of the disc's centre of mass, so that friction does not tilt it.
aabb::mesh brush(double radius) {
    aabb::mesh teeth;
    const auto size = static_cast<float>(radius);
    const double golden_angle = std::numbers::pi * (3 - std::sqrt(5.0));
    for (std::uint32_t i = 0; i < tips; ++i) {
        const double r = radius * std::sqrt((i + 0.5) / tips);
        const auto x = static_cast<float>(r * std::cos(golden_angle * i));
        const auto y = static_cast<float>(r * std::sin(golden_angle * i));
        for (const aabb::vec3f& v : {aabb::vec3f{x, y, 0},
                                     {x + 0.01F * size, y + 0.02F * size, 0.1F * size},
                                     {x - 0.01F * size, y - 0.02F * size, 0.1F * size}})
            teeth.vertices.push_back(v);
        teeth.triangles.push_back({3 * i, 3 * i + 1, 3 * i + 2});
    }
    return teeth;
}

/// The shares of μ m g and μ m g R that a uniform disc's friction has against sliding by v = share · R ω, and against
/// spinning by ω: ∫ (v + y..)/|u| dA over the disc, by the midpoint rule in equal areas (Farkas et al. 2003).
std::pair<double, double> friction_against(double share) {
    double force = 0, torque = 0;
    constexpr int rings = 100, angles = 100;
    for (int i = 0; i < rings; ++i)
        for (int j = 0; j < angles; ++j) {
            const double r = std::sqrt((i + 0.5) / rings);
            // By symmetry, half of the disc has the torque and the force of the whole along the motion, x.
            const double angle = std::numbers::pi * ((j + 0.5) / angles - 0.5);
            const double x = r * std::cos(angle), y = r * std::sin(angle);
            const double slip_x = share - y, slip_y = x;
            const double slip = std::hypot(slip_x, slip_y);
            force += slip_x / slip / (rings * angles);
            torque += (x * slip_y - y * slip_x) / slip / (rings * angles);
        }
    return {force, torque};
}

/// v/(R ω) when v + R ω has fallen to a share of its start, by Runge-Kutta steps of v' = -μ g F, R ω' = -2 μ g T, as
/// the inertia is m R²/2. Only the ratio of both matters: with s = v + R ω, dv/ds = F/(F + 2T).
double ratio_by_farkas(double ratio, double fallen_to) {
    const auto slope = [](double s, double v) {
        const auto [force, torque] = friction_against(v / (s - v));
        return force / (force + 2 * torque);
    };
    double v = ratio / (1 + ratio), logarithm = 0;
    constexpr int steps = 40;
    const double step = std::log(fallen_to) / steps;
    for (int i = 0; i < steps; ++i) {
        // In the logarithm of s: dv/dln s = s dv/ds.
        const auto rate = [&](double at, double value) { return std::exp(at) * slope(std::exp(at), value); };
        const double k1 = rate(logarithm, v);
        const double k2 = rate(logarithm + step / 2, v + step / 2 * k1);
        const double k3 = rate(logarithm + step / 2, v + step / 2 * k2);
        const double k4 = rate(logarithm + step, v + step * k3);
        v += step / 6 * (k1 + 2 * k2 + 2 * k3 + k4);
        logarithm += step;
    }
    return v / (fallen_to - v);
}

stepped_world disc_on_floor(double radius, double sliding) {
    return {.meshes = {floor_of(8), brush(radius)},
            .bodies = {{},
                       {.mesh = 1,
                        .position = {0.013, 0.007, -earth_gravity / stiffness},
                        .velocity = {sliding, 0, 0},
                        .mass = 1,
                        .inertia = inertia_of_disc(1, radius),
                        .angular_velocity = {0, 0, speed / radius}}},
            .law = {.geometry = contact_geometry::each_vertex,
                    .stiffness = stiffness / tips,
                    .damping = 2 * std::sqrt(stiffness) / tips,
                    .may_pull = false,
                    .friction = friction,
                    .slip_speed = slip_speed},
            .gravity = earth_gravity};
}

double sliding_of(const simulation& disc) {
    return std::hypot(disc.state().velocity[3], disc.state().velocity[4]);
}
/// R ω, m/s
double spinning_of(const simulation& disc, double radius) {
    return radius * disc.angular_velocity(1)[2];
}

struct spun {
    double time = 0;              // until it stops, s
    double greatest_sliding = 0;  // m/s
    double rise = 0;              // greatest rise or fall over depth at rest
};

/// Lets a disc spin until only the slip speed is left, but not for longer than `end`.
spun spin(simulation& disc, double radius, double step, double end) {
    spun result;
    const double height = disc.state().position[5];
    while (spinning_of(disc, radius) > slip_speed && disc.state().time < end) {
        disc.advance(step);
        result.greatest_sliding = std::max(result.greatest_sliding, sliding_of(disc));
        result.rise = std::max(result.rise, std::abs(disc.state().position[5] / height - 1));
    }
    result.time = disc.state().time;
    return result;
}

}  // namespace

void run_spinning_disc(const stiff_setting& setting, stiff_result& result) {
    const double step = 0.2 * slip_speed / (friction * earth_gravity);
    // A disc that only spins: the torque is 2/3 μ m g R.
    const double until_stop = 3 * speed / (4 * friction * earth_gravity);
    constexpr double radius = 0.1;  // R, m
    for (const integrator_info& i : integrators_of(setting)) {
        if (!i.is_symplectic() || i.stable_below > 2) continue;  // others take the same way with more detections
        const std::string subject = std::string(i.name) + ", only spins";
        run_or_record_failure(result, i.name, [&] {
            simulation disc(disc_on_floor(radius, /*sliding=*/0), setting, i);
            const spun spinning = spin(disc, radius, step, 2 * until_stop);
            // Coulomb's law is exact until v_s, which leaves v_s/v₀ of the time, but for tips within v_s/ω of the axis:
            // they have the cube of that share of the torque. The tips' mean radius is 2/3 R to 1e-5.
            result.add(within(subject, "time until it stops (s)", spinning.time, until_stop,
                              slip_speed / speed + step / until_stop));
            // Of a spiral, at most one tip's friction is not in balance about the axis.
            result.add(
                at_most(subject, "greatest sliding speed over Rω₀", spinning.greatest_sliding / speed, 0.75 / tips));
            // The middle of the tips lies off the centre by e, at most a tip's share of R. The weight tilts the disc by
            // m g e over the stiffness k R²/4, which moves the centre by 4 (e/R)² of the depth.
            result.add(
                at_most(subject, "greatest rise or fall over depth at rest", spinning.rise, 4.0 / (tips * tips)));
        });
        for (const double start : {0.3, 0.653, 1.5}) {  // v/(R ω)
            run_or_record_failure(result, i.name, [&] {
                simulation disc(disc_on_floor(radius, start * speed), setting, i);
                const double fallen_to = 0.05;
                const std::string label = "v = " + short_number(start) + " Rω at first, " + std::string(i.name);
                const double total = speed * (1 + start);
                int steps = 0;
                while (sliding_of(disc) + spinning_of(disc, radius) > fallen_to * total && disc.state().time < 0.7) {
                    disc.advance(step);
                    if (i.order == 2 && steps++ % 50 == 0)
                        result.plot("disc", "from v = " + short_number(start) + " Rω",
                                    (sliding_of(disc) + spinning_of(disc, radius)) / total,
                                    sliding_of(disc) / spinning_of(disc, radius));
                }
                // Tips within v_s/ω of the pivot feel less friction, and the sum over tips differs from the integral
                // about there: both by their share of the area.
                const double ratio = sliding_of(disc) / spinning_of(disc, radius);
                const double error = std::pow(slip_speed / spinning_of(disc, radius), 2) + 1.0 / tips;
                result.add(within(label, "v/(Rω) at a twentieth of the speed", ratio, ratio_by_farkas(start, fallen_to),
                                  error));
                if (start == 0.653)  // a number of three digits
                    result.add(within(label, "v/(Rω) at a twentieth of the speed, against its limit", ratio, 0.653,
                                      error + 0.0005 / 0.653));
            });
        }
    }
}

stiff_study spinning_disc_study() {
    return {
        "spinning_disc",
        "A thin disc of 1 kg on 400 tips, which share its weight and area, slides and spins on level ground until "
        "friction stops both. Friction is regularised with a slip speed of a thousandth of the speed of the rim",
        "a disc that only spins stops after 3Rω₀/(4μg); sliding and spin end together, with v/(Rω) → 0.653 (Farkas, "
        "Bartels, Unger and Wolf, Phys. Rev. Lett. 90, 248302, 2003), along the solution of their equations",
        &run_spinning_disc,
        {figure{.name = "disc",
                .caption = "Sliding over spin of a disc, v/(Rω), while friction stops it; it tends to 0.653.",
                .x = {"v + Rω (relative to the start)", /*logarithmic=*/true},
                .y = {"v/(Rω)"},
                .lines = {{"0.653", series_style::level, {{0, 0.653}}}}}}};
}

}  // namespace aabblab
