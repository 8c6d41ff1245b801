module aabblab.stiff;

import :dropped_balls;
import :simulation;
import aabb.base;
import aabb.geometry;
import aabblab.scenes;
import aabblab.stepping;

namespace aabblab {

namespace {

constexpr double end = 0.48;  // s, of balls of 1 m

aabb::mesh ball_of(double diameter) {
    aabb::mesh ball = make_mesh("icosphere:triangles=80").mesh;
    for (aabb::vec3f& v : ball.vertices)
        for (float& coordinate : v.at) coordinate = static_cast<float>(coordinate * diameter / 2);
    return ball;
}

}  // namespace

dropped_balls::dropped_balls(std::size_t side, double diameter) : diameter_(diameter) {
    // The last half of a diameter; what is before it has a closed form.
    const double fallen = 4.5 * diameter;
    world_ = dropped_world(
        {.balls = static_cast<std::uint32_t>(side * side * side), .height = 0.5, .speed = std::sqrt(2 * 9.81 * fallen)},
        {make_mesh("square").mesh, ball_of(diameter)}, 1);
}

double dropped_balls::seconds(double of_large_ones) const {
    return of_large_ones * std::sqrt(diameter_);
}

trajectory dropped_balls::play(const contender& who, const integrator_info& stepping, double step, std::size_t kept,
                               bool with_energy) const {
    trajectory t;
    simulation balls(world_, who, stepping);
    const double began = dynamics(world_).mechanical_energy(balls.state());
    const auto steps = static_cast<std::size_t>(std::llround(seconds(end) / step));
    std::vector<double> squares;
    const std::size_t looks = std::max<std::size_t>(steps / 20, 1);
    for (std::size_t s = 1; s <= steps; ++s) {
        try {
            balls.advance(step);
        } catch (const aabb::input_error&) {
            if (t.depths.empty()) throw;
            break;
        }
        if (s % kept == 0) t.positions.push_back(balls.state().position);
        if (s % looks != 0) continue;
        t.times.push_back(balls.state().time);
        t.depths.push_back(greatest_depth(balls.state().position));
        if (with_energy) squares.push_back(std::pow(energy_of(balls) / began - 1, 2));
    }
    if (with_energy)
        t.energy_error =
            std::sqrt(std::accumulate(squares.begin(), squares.end(), 0.0) / static_cast<double>(squares.size()));
    t.detection_ms = balls.detection_ms();
    return t;
}

double dropped_balls::energy_of(simulation& balls) const {
    double sum = dynamics(world_).mechanical_energy(balls.state());
    std::vector<aabb::pose> poses;
    world_.place(balls.state().position, poses);
    const auto placed = [&](std::uint32_t body) {
        return placed_mesh{&world_.meshes[world_.bodies[body].mesh], poses[body]};
    };
    const std::span<const aabb::contact> contacts = balls.contacts();
    for (std::size_t i = 0; i < contacts.size(); ++i) {
        const auto& [a, b, s, t] = contacts[i];
        if (i > 0 && contacts[i - 1].a == a && contacts[i - 1].b == b) continue;
        sum += world_.law.stiffness * overlap_volume(placed(a), a == 0, placed(b));
    }
    return sum;
}

double dropped_balls::greatest_depth(const std::vector<double>& p) const {
    double least = diameter_;
    for (std::size_t i = 1; 3 * i < p.size(); ++i)
        for (std::size_t j = i + 1; 3 * j < p.size(); ++j)
            least = std::min(least,
                             std::hypot(p[3 * i] - p[3 * j], p[3 * i + 1] - p[3 * j + 1], p[3 * i + 2] - p[3 * j + 2]));
    return 1 - least / diameter_;
}

std::vector<double> dropped_balls::departures(const trajectory& t, const trajectory& right) const {
    std::vector<double> all;
    for (std::size_t s = 0; s < std::min(t.positions.size(), right.positions.size()); ++s) {
        double greatest = 0;
        for (std::size_t i = 0; i < t.positions[s].size(); ++i)
            greatest = std::max(greatest, std::abs(t.positions[s][i] - right.positions[s][i]) / diameter_);
        all.push_back(greatest);
    }
    all.resize(right.positions.size(), std::numeric_limits<double>::infinity());
    return all;
}

}  // namespace aabblab
