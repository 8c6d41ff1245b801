module;
#include <cmath>

module aabblab.stiff;

import :rules;
import :shapes;
import :simulation;

namespace aabblab {

namespace {

constexpr double mass = 1;           // kg
constexpr double half_length = 0.5;  // a, m
constexpr double speed = 1;          // at which the rod slides, m/s
constexpr double slip_speed = 1e-6;  // below which friction is not full, m/s
constexpr double depth = 1e-9;       // of the tip at the start, m

/// How much a normal force N at the tip of a thin rod that slides pushes it up: the tip accelerates by p N/m.
/// @param tangent of the rod's angle θ from the floor
double push_of(double tangent, double friction) {
    const double cosine = 1 / std::hypot(1, tangent), sine = tangent * cosine;
    return 1 + 3 * cosine * (cosine - friction * sine);
}
/// How much it brakes the tip: the slip decreases by q N/m.
double brake_of(double tangent, double friction) {
    const double cosine = 1 / std::hypot(1, tangent), sine = tangent * cosine;
    return friction * (1 + 3 * sine * sine) - 3 * sine * cosine;
}
/// The friction beyond which p is negative.
double critical_friction(double tangent) {
    return (tangent * tangent + 4) / (3 * tangent);
}

/// A thin rod whose lower end slides ahead over a rough floor, without gravity.
stepped_world sliding_rod(double tangent, double friction, double stiffness) {
    const double c = 1 / std::hypot(1, tangent), s = tangent * c;
    stepped_world world;
    world.meshes = {floor_of(4), hanging_pyramid(1, 0.01F, static_cast<float>(half_length))};
    // Its axis, upwards, is (c, 0, s): the tip is behind the centre in x, and slides towards -x.
    const double across = mass * half_length * half_length / 3;
    world.bodies = {{},
                    {.mesh = 1,
                     .position = {0.3 + half_length * c, -0.2, half_length * s - depth},
                     .velocity = {-speed, 0, 0},
                     .mass = mass,
                     .rotation = {s, 0, c, 0, 1, 0, -c, 0, s},
                     .inertia = matrix3{across, 0, 0, 0, across, 0, 0, 0, 1e-3 * across}}};
    world.law.stiffness = stiffness;
    world.law.friction = friction;
    world.law.slip_speed = slip_speed;
    return world;
}

/// The rod with what is known of its tip.
class rod {
public:
    rod(const stepped_world& world, const stiff_setting& setting)
        : body_(world, setting, *integrator_named("runge_kutta_4")) {}

    void advance(double step) { body_.advance(step); }
    [[nodiscard]] double time() const { return body_.state().time; }
    [[nodiscard]] double tip_depth() const { return -(body_.state().position[5] + tip()[2]); }
    /// The speed of the tip towards -x, m/s.
    [[nodiscard]] double slip() const {
        const aabb::vec3d turning = body_.angular_velocity(1), arm = tip();
        return -(body_.state().velocity[3] + turning[1] * arm[2] - turning[2] * arm[1]);
    }
    /// The upward speed of the centre of mass, m/s.
    [[nodiscard]] double speed_up() const { return body_.state().velocity[5]; }

private:
    /// The vector from the centre of mass, in the world's axes.
    [[nodiscard]] aabb::vec3d tip() const {
        const matrix3 r = matrix_of(body_.state().orientation_of(0));
        return {-half_length * r[2], -half_length * r[5], -half_length * r[8]};
    }

    simulation body_;
};

/// How far a rod turns at most while a force presses its tip until this impulse over its mass, m/s, with a force that
/// grows at this rate, 1/s; and how much p and q change then, which are of the size of 6 (μ + 1).
double change_while_turning(double friction, double impulse, double rate) {
    const double turned = 3 * (friction + 1) * impulse / (half_length * rate);
    return 6 * (friction + 1) * turned;
}

constexpr double least_stiffness = 1e6, greatest_stiffness = 1e10;  // N/m

/// The depth of the tip after a time, over that at the start.
double depth_after(const stiff_setting& setting, double tangent, double friction, double stiffness, double time) {
    rod sliding(sliding_rod(tangent, friction, stiffness), setting);
    constexpr int steps = 200;
    for (int i = 0; i < steps; ++i) sliding.advance(time / steps);
    return sliding.tip_depth() / depth;
}

/// Compares the first motion of the tip with cos or cosh: pushed up or pulled in.
void judge_first_motion(const stiff_setting& setting, stiff_result& result) {
    constexpr double tangent = 2;
    for (const double friction : {0.5, 1.0, 1.25, 1.42, 1.6, 2.0}) {
        const double p = push_of(tangent, friction);
        const double rate = std::sqrt(std::abs(p) * least_stiffness / mass);
        const double expected = p > 0 ? std::cos(1) : std::cosh(1);
        const double impulse = least_stiffness * depth * std::cosh(1) / rate / mass;
        // Depths are rounded to a billionth of a millionth of a metre at worst.
        constexpr double rounding = 1e-15 / depth;
        const double tolerance =
            change_while_turning(friction, impulse, rate) / std::abs(p) * std::cosh(1) / expected + rounding;
        result.add(within("tan θ 2, μ " + short_number(friction), "depth after 1/√(|p|k/m) over the first",
                          depth_after(setting, tangent, friction, least_stiffness, 1 / rate), expected, tolerance));
    }
}

/// Finds the friction at which the force on the tip begins to pull it in.
void judge_critical_friction(const stiff_setting& setting, stiff_result& result) {
    for (const double tangent : {1.0, 2.0, 4.0}) {
        double pushed = 0.5, pulled = 3;
        constexpr double precision = 1e-5;
        while (pulled - pushed > precision) {
            const double middle = (pushed + pulled) / 2;
            const double after =
                depth_after(setting, tangent, middle, least_stiffness, 1 / std::sqrt(least_stiffness / mass));
            (after > 1 ? pulled : pushed) = middle;
        }
        result.add(within("tan θ " + short_number(tangent), "friction beyond which the tip is pulled in",
                          (pushed + pulled) / 2, critical_friction(tangent), precision));
    }
}

/// Lets the tip jam beyond the critical friction, on ever stiffer floors: the time until it stops tends to 0, the
/// impulse does not.
void judge_jam(const stiff_setting& setting, stiff_result& result) {
    constexpr double tangent = 2, friction = 2;
    const double p = push_of(tangent, friction), q = brake_of(tangent, friction);
    for (double stiffness = least_stiffness; stiffness <= greatest_stiffness; stiffness *= 100) {
        const double rate = std::sqrt(-p * stiffness / mass);
        constexpr double remaining = 0.01;  // share of the speed at which it counts as stopped
        const double stopped = speed * (1 - remaining);
        const double expected_time = std::asinh(stopped * mass * rate / (q * stiffness * depth)) / rate;
        rod sliding(sliding_rod(tangent, friction, stiffness), setting);
        double time = 0, slip = speed, up = 0;
        while (sliding.time() < 3 * expected_time) {
            sliding.advance(1e-3 / rate);
            const double next_slip = sliding.slip();
            if (next_slip <= speed * remaining) {
                const double share = (slip - speed * remaining) / (slip - next_slip);  // of the last step
                time += share * (sliding.time() - time);
                up += share * (sliding.speed_up() - up);
                break;
            }
            time = sliding.time();
            slip = next_slip;
            up = sliding.speed_up();
        }
        const double tolerance = change_while_turning(friction, stopped / q, rate) / std::min(-p, q);
        const std::string subject = "μ 2, k " + short_number(stiffness) + " N/m";
        result.add(within(subject, "time until the tip stops (s)", time, expected_time, tolerance));
        result.add(within(subject, "impulse until then (N s)", mass * up, mass * stopped / q, tolerance));
    }
}

}  // namespace

void run_painleve(const stiff_setting& setting, stiff_result& result) {
    judge_critical_friction(setting, result);
    judge_first_motion(setting, result);
    judge_jam(setting, result);
}

stiff_study painleve_study() {
    return {
        "painleve",
        "A thin rod of 1 kg and 1 m slides over a rough floor on its lower end, which is ahead, at 1 m/s and an "
        "angle θ. A normal force N accelerates its tip by p N/m. If p < 0, it pulls the tip in: a rigid rod then has "
        "no acceleration that obeys the laws of contact and friction, and one on a spring digs in at a rate that "
        "grows with the stiffness, until it stops. No integrator and no detection fails: the rigid model does",
        "p = 1 + 3 cos θ (cos θ - μ sin θ), below 0 if μ > (1 + 3 cos²θ)/(3 sin θ cos θ) (Painlevé 1895), least 4/3 at "
        "tan θ = 2. On a spring the depth goes as cos or cosh of √(|p|k/m) t; if p < 0, the slip v stops after "
        "asinh(v m σ/(q k d))/σ, with σ = √(-p k/m), the first depth d, and q = μ (1 + 3 sin²θ) - 3 sin θ cos θ, by "
        "the impulse m v/q. Tolerance: what the rod turns meanwhile",
        &run_painleve};
}

}  // namespace aabblab
