module;
#include <cmath>

module aabblab.stiff;

import :incline;
import :rules;
import :simulation;

namespace aabblab {

namespace {

constexpr double friction = 0.3;             // μ
constexpr double adaptive_tolerance = 1e-9;  // of adaptive integrators
constexpr aabb::vec3d flat = {0.2, 0.2, 0.1};
constexpr aabb::vec3d upright = {0.2, 0.2, 0.4};

/// The time in which friction at the slip speed would stop a slip of this speed.
double decay_of_slip(const rubbing& contact) {
    return contact.slip_speed / (contact.friction * earth_gravity);
}

/// How far friction tilts a block, and so moves its lower face against its centre, m. The moment μ m g h/2 is against
/// the stiffness k b² of springs of k/4 at the distance b/2 on each side, hence k b²/4.
double shift_by_tilt(const rubbing& contact, const aabb::vec3d& sides) {
    const double moment = contact.friction * earth_gravity * sides[2] / 2;
    const double stiffness = contact.frequency * contact.frequency * sides[0] * sides[0] / 4;
    return moment / stiffness * sides[2] / 2;
}

/// Slides a block on level ground until it stops: after v₀/(μ g), having moved by v₀²/(2 μ g).
void measure_stop(const stiff_setting& setting, stiff_result& result) {
    constexpr double speed = 1;  // v₀, m/s
    const incline ground;
    const rubbing contact{.friction = friction, .slip_speed = 1e-3 * speed};
    const double until_stop = speed / (friction * earth_gravity);
    const double distance = speed * until_stop / 2;
    const double step = 0.2 * decay_of_slip(contact);
    const stepped_world world = block_on_incline(ground, contact, flat, speed);
    for (const integrator_info& i : integrators_of(setting)) {
        run_or_record_failure(result, i.name, [&] {
            simulation block(world, setting, i, adaptive_tolerance);
            double time = 0, velocity = speed, lift = 0;
            const double height = ground.height(block.state(), 1);
            const double depth = flat[2] / 2 - height;
            while (block.state().time < 1.2 * until_stop) {
                block.advance(step);
                lift = std::max(lift, std::abs(ground.height(block.state(), 1) - height) / depth);
                const double before = std::exchange(velocity, ground.speed(block.state(), 1));
                if (time == 0 && velocity <= contact.slip_speed)
                    time = block.state().time - step * (contact.slip_speed - velocity) / (before - velocity);
            }
            const std::string subject = std::string(i.name) + ", level";
            // Coulomb's law is exact until v_s. The springs take their share of μ g back only after the tilt.
            const double tilt = 2 * shift_by_tilt(contact, flat) / distance;
            const double late = contact.slip_speed / speed + step / until_stop;
            result.add(within(subject, "time until it stops (s)", time, until_stop, late + tilt));
            // From v_s on, the speed falls exponentially, over twice the path of Coulomb's law: v_s²/(μ g).
            const double creeps = contact.slip_speed * contact.slip_speed / (speed * speed);
            result.add(within(subject, "path until it stops (m)", ground.path(block.state(), 1), distance,
                              creeps + step / until_stop + tilt));
            // Friction only tilts the block about its middle; its vertices are rounded to float. A missed contact would
            // let it fall.
            const double rounding = flat[2] / 2 * std::numeric_limits<float>::epsilon() / 2 / depth;
            result.add(at_most(subject, "greatest rise or fall over depth at rest", lift, rounding));
        });
    }
}

/// Releases a block on an incline with tan θ > μ, where it slides with g (sin θ - μ cos θ).
void measure_slide(const stiff_setting& setting, stiff_result& result) {
    constexpr double duration = 0.5;  // s
    const rubbing contact{.friction = friction, .slip_speed = 1e-3};
    const incline floor{std::atan(0.6)};
    const double sine = std::sin(floor.angle), cosine = std::cos(floor.angle);
    const double step = 0.2 * decay_of_slip(contact);
    const double slides = earth_gravity * (sine - friction * cosine);
    for (const integrator_info& i : integrators_of(setting)) {
        run_or_record_failure(result, i.name, [&] {
            simulation block(block_on_incline(floor, contact, flat, /*speed=*/0), setting, i, adaptive_tolerance);
            const double start = floor.path(block.state(), 1);
            while (block.state().time < duration) block.advance(step);
            const double time = block.state().time;
            const double path = floor.path(block.state(), 1) - start;
            // Where the speed reaches v_s, it is at most v_s ahead of one under Coulomb's law.
            const double error =
                2 * contact.slip_speed / (slides * time) + step / time + 2 * shift_by_tilt(contact, flat) / path;
            result.add(within(std::string(i.name) + ", tan θ = 2 μ", "acceleration (m/s²)", 2 * path / (time * time),
                              slides, error));
        });
    }
}

/// Releases a block on an incline with tan θ < μ, where the linear law lets it creep with v_s tan θ/μ.
void measure_creep(const stiff_setting& setting, stiff_result& result) {
    const incline floor{std::atan(0.5 * friction)};
    for (const double slip_speed : {1e-2, 1e-3, 1e-4}) {
        const rubbing contact{.friction = friction, .slip_speed = slip_speed};
        const double step = std::min(0.2 * decay_of_slip(contact), 0.1 / contact.frequency);
        // The slip settles to e^-12. The slowest motion of the springs, a tilt with the frequency √2.4 ω and 1.55 of
        // the critical damping, decays at 0.57 ω: to e^-17.
        const double end = std::max(12 * decay_of_slip(contact) / std::cos(floor.angle), 30 / contact.frequency);
        for (const integrator_info& i : integrators_of(setting)) {
            run_or_record_failure(result, i.name, [&] {
                simulation block(block_on_incline(floor, contact, flat, /*speed=*/0), setting, i,
                                 adaptive_tolerance * slip_speed);
                while (block.state().time < end) block.advance(step);
                const double creep = floor.speed(block.state(), 1);
                const std::string subject = std::string(i.name) + ", v_s " + short_number(slip_speed) + " m/s";
                result.add(within(subject, "creep over v_s tan θ/μ", creep / (slip_speed * 0.5), 1, 1e-4));
            });
        }
    }
}

/// Whether a block that is released on an incline lies on its side, or on the way, after a second.
bool tips_over(const stiff_setting& setting, const integrator_info& stepping, const incline& floor,
               const rubbing& contact, double step) {
    simulation block(block_on_incline(floor, contact, upright, /*speed=*/0), setting, stepping);
    while (block.state().time < 1) {
        block.advance(step);
        const matrix3 rotation = matrix_of(block.state().orientation_of(0));
        const double leaning = dot(floor.normal(), {rotation[2], rotation[5], rotation[8]});  // the cosine of its angle
        if (leaning < 0.9) return true;
    }
    return false;
}

/// A block tips iff tan θ > b/h, if friction holds it, μ > b/h: its weight points outside of its lower face. Bisection
/// finds the angle. The springs' energy m g δ/2 may lift the centre over the pivot where the barrier is as low: at an
/// angle β below the limit it is R β²/2, with the half diagonal R.
void measure_tipping(const stiff_setting& setting, stiff_result& result) {
    const double limit = upright[0] / upright[2];
    const rubbing contact{.friction = 1, .slip_speed = 1e-2, .frequency = 3e3, .damping = 2};
    const double half_diagonal = std::hypot(upright[0], upright[2]) / 2;
    const double depth = earth_gravity / (contact.frequency * contact.frequency);
    const double angle = std::sqrt(depth / half_diagonal);
    // Relative to the limit: d tan θ = (1 + tan² θ) β.
    const double barrier = angle * (1 + limit * limit) / limit;
    // A block at an angle β above the limit falls as β (cosh pt - 1), with p² = 3g/4R: to 0.45 rad after a second.
    const double growth = std::cosh(std::sqrt(0.75 * earth_gravity / half_diagonal)) - 1;
    const double slow = 0.45 / growth * (1 + limit * limit) / limit;
    const double step = 0.2 / contact.frequency;
    for (const integrator_info& i : integrators_of(setting)) {
        if (!i.is_symplectic() || i.stable_below > 2) continue;  // others take the same way with more detections
        run_or_record_failure(result, i.name, [&] {
            double stands = 0.9, tips = 1.1;  // tan θ h/b
            while (tips - stands > 2e-3) {
                const double middle = (stands + tips) / 2;
                (tips_over(setting, i, {std::atan(middle * limit)}, contact, step) ? tips : stands) = middle;
            }
            result.add(within(std::string(i.name), "least tan θ at which it tips", (stands + tips) / 2 * limit, limit,
                              std::max(barrier, slow) + 1e-3));
        });
    }
}

}  // namespace

void run_block(const stiff_setting& setting, stiff_result& result) {
    measure_stop(setting, result);
    measure_slide(setting, result);
    measure_creep(setting, result);
    measure_tipping(setting, result);
}

stiff_study block_study() {
    return {"block",
            "A block of 1 kg on springs at its four lower vertices slides on level ground until it stops, and is "
            "released on inclines, where it slides, creeps or tips. Friction is regularised: linear up to a slip "
            "speed v_s",
            "closed forms: it stops after v₀/(μg) and v₀²/(2μg), slides with g(sin θ - μ cos θ) if tan θ > μ, tips iff "
            "tan θ > b/h if μ > b/h, with its length b and height h; with the linear law it creeps with v_s tan θ/μ "
            "otherwise",
            &run_block};
}

}  // namespace aabblab
