module aabblab.stiff;

import :incline;
import :rules;
import :simulation;
import aabb.geometry;
import aabblab.scenes;
import aabblab.statistics;

namespace aabblab {

namespace {

constexpr double friction = 0.3;

/// A mesh that slides without spin on level ground like a ball, pushed by a pressure on its surface inside the floor.
struct sliding_ball {
    double radius;  ///< R, m
    std::uint32_t facets;

    /// The depth at rest, m: more than the height of the coarsest facets.
    [[nodiscard]] double depth() const { return 0.05 * radius; }
    /// The lever of the friction about the centre, m.
    [[nodiscard]] double lever() const { return radius - depth(); }
    [[nodiscard]] double speed() const { return std::sqrt(10 * radius); }  // v₀, m/s
    [[nodiscard]] double slip_speed() const { return 0.01 * speed(); }
    /// I/(m r²) with the lever r.
    [[nodiscard]] double inertia_share() const { return 0.4 * radius * radius / (lever() * lever()); }
    [[nodiscard]] double rolling_speed() const { return speed() / (1 + inertia_share()); }
    /// The slip falls by μ g (1 + m r²/I).
    [[nodiscard]] double until_rolling() const {
        return speed() / (friction * earth_gravity * (1 + 1 / inertia_share()));
    }

    /// A smooth ball shares a disc of area π (2Rδ - δ²) with the floor's plane. The dashpot is critical.
    [[nodiscard]] stepped_world world() const {
        const double area = std::numbers::pi * (2 * radius * depth() - depth() * depth());
        const double pressure = earth_gravity / area;
        const double stiffness = pressure * 2 * std::numbers::pi * lever();  // change of force by depth, N/m
        aabb::mesh ball = make_mesh("icosphere:triangles=" + std::to_string(facets)).mesh;
        const aabb::vec3f& v = ball.vertices[0];  // all are on a sphere about the origin
        const double size = std::hypot(double{v[0]}, double{v[1]}, double{v[2]});
        return {.meshes = {floor_of(40 * radius), scaled(std::move(ball), radius / size)},
                .bodies = {{},
                           {.mesh = 1,
                            .position = {-0.3 * radius, 0.2 * radius, lever()},
                            .velocity = {speed(), 0, 0},
                            .mass = 1,
                            .inertia = inertia_of_ball(1, radius)}},
                .law = {.geometry = contact_geometry::shared_volume,
                        .stiffness = pressure,
                        .damping = 2 * std::sqrt(stiffness) / area,
                        .may_pull = false,
                        .friction = friction,
                        .slip_speed = slip_speed()},
                .gravity = earth_gravity};
    }
};

struct rolled {
    double time = 0;   // until it rolls, s
    double speed = 0;  // after that, m/s
    double depth = 0;  // mean after that, m
};

rolled roll(const sliding_ball& ball, const stiff_setting& setting) {
    simulation rolling(ball.world(), setting, *integrator_named("velocity_verlet"));
    const double step = 0.1 * 0.01 * ball.until_rolling();  // a tenth of the time in which the slip falls by v_s
    rolled result;
    int samples = 0;
    while (rolling.state().time < 2 * ball.until_rolling()) {
        rolling.advance(step);
        const motion_state& state = rolling.state();
        const double slip = state.velocity[3] - ball.lever() * rolling.angular_velocity(1)[1];
        // From the slip speed on, Coulomb's law would take another hundredth of the time.
        if (result.time == 0 && slip < ball.slip_speed()) result.time = state.time + 0.01 * ball.until_rolling();
        if (state.time < 1.5 * ball.until_rolling()) continue;
        ++samples;
        result.speed += state.velocity[3];
        result.depth += ball.radius - state.position[5];
    }
    result.speed /= samples;
    result.depth /= samples;
    return result;
}

/// How fast an error falls with the number of facets: the negative slope of their logarithms.
double order_in_facets(std::span<const double> facets, std::span<const double> errors) {
    std::vector<double> x, y;
    for (const double n : facets) x.push_back(std::log(n));
    for (const double error : errors) y.push_back(std::log(std::abs(error)));
    return -line_through(x, y).slope;
}

/// Rolls meshes with more and more facets. A facet lies below the sphere by the square of its edge, in inverse
/// proportion to their number.
void measure_convergence(const stiff_setting& setting, stiff_result& result) {
    std::vector<double> numbers, speed_errors, depth_errors;
    for (const std::uint32_t facets : {80U, 320U, 1280U, 5120U}) {
        if (setting.quick && facets > 1280) break;
        const sliding_ball ball{/*radius=*/0.1, facets};
        const rolled measured = roll(ball, setting);
        numbers.push_back(facets);
        speed_errors.push_back(measured.speed / ball.rolling_speed() - 1);
        depth_errors.push_back(measured.depth / ball.depth() - 1);
        const std::string subject = std::to_string(facets) + " facets";
        result.add(reported(subject, "rolling speed, error", speed_errors.back()));
        result.add(reported(subject, "depth, error", depth_errors.back()));
        result.plot("facets", "rolling speed", facets, std::abs(speed_errors.back()));
        result.plot("facets", "depth", facets, std::abs(depth_errors.back()));
        if (facets < 1000) continue;
        // The depth's error is that of the lever r. Twice its share changes m r²/I, of which the time and the rolling
        // speed change by less; the time is measured to a step.
        const double of_lever = 2 * std::abs(depth_errors.back()) * ball.depth() / ball.lever();
        result.add(within(subject, "time until it rolls (s)", measured.time, ball.until_rolling(), of_lever + 1e-3));
        result.add(within(subject, "rolling speed (m/s)", measured.speed, ball.rolling_speed(), of_lever));
    }
    result.add(at_least("80 facets and more", "order of the rolling speed's error",
                        order_in_facets(numbers, speed_errors), 0.9));
    result.add(
        at_least("80 facets and more", "order of the depth's error", order_in_facets(numbers, depth_errors), 0.9));
}

}  // namespace

/// Friction acts at the height of the floor, R - δ below the centre: with the lever r = R - δ, the angular momentum
/// m r v + I ω is kept, and the ball rolls with v = r ω = v₀/(1 + I/(m r²)).
void run_facets(const stiff_setting& setting, stiff_result& result) {
    measure_convergence(setting, result);
}

stiff_study facets_study() {
    return {"facets",
            "Meshes of 80 to 5,120 facets (1,280 with --quick) slide without spin until they roll, as a ball does. A "
            "pressure on the surface inside the floor carries the weight of 1 kg at a twentieth of the radius, and "
            "friction acts at its centre, with force and torque by Stokes' theorem from the detected pairs",
            "the smooth ball: v₀/(1 + I/(m r²)) after v₀/(μg (1 + m r²/I)), with r = R - δ; errors fall as the inverse "
            "of the number of facets",
            &run_facets,
            {figure{.name = "facets",
                    .caption = "Error of the rolling speed and of the depth of a mesh against a smooth ball, over its "
                               "number of facets.",
                    .x = {"facets", /*logarithmic=*/true},
                    .y = {"relative error", /*logarithmic=*/true}}}};
}

}  // namespace aabblab
