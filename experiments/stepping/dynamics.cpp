module;
#include <Eigen/Core>

module aabblab.stepping;

import aabb.geometry;
import aabblab.vectors;

namespace aabblab {

namespace {

/// Of a body among all, three numbers each.
auto vector_at(std::span<const double> all, std::size_t body) {
    return Eigen::Map<const Eigen::Vector3d>(all.subspan(3 * body, 3).data());
}
auto vector_at(std::span<double> all, std::size_t body) {
    return Eigen::Map<Eigen::Vector3d>(all.subspan(3 * body, 3).data());
}

}  // namespace

motion_state stepped_world::start() const {
    motion_state state;
    for (const body& b : bodies) {
        state.position.insert(state.position.end(), std::begin(b.position.at), std::end(b.position.at));
        state.velocity.insert(state.velocity.end(), std::begin(b.velocity.at), std::end(b.velocity.at));
    }
    return state;
}

std::vector<std::uint32_t> stepped_world::mesh_of() const {
    std::vector<std::uint32_t> meshes_of_bodies;
    for (const body& b : bodies) meshes_of_bodies.push_back(b.mesh);
    return meshes_of_bodies;
}

void stepped_world::place(std::span<const double> position, std::vector<aabb::pose>& poses) const {
    poses.resize(bodies.size());
    for (std::size_t i = 0; i < bodies.size(); ++i) poses[i] = {bodies[i].rotation, from_eigen(vector_at(position, i))};
}

void dynamics::accelerate(std::span<const double> position, std::span<const double> velocity,
                          std::span<const aabb::contact> contacts, std::span<double> acceleration) {
    const std::vector<body>& bodies = world_.bodies;
    world_.place(position, poses_);
    std::ranges::fill(acceleration, 0.0);
    for (std::size_t i = 0; i < bodies.size(); ++i)
        if (std::isfinite(bodies[i].mass)) acceleration[3 * i + 2] = -world_.gravity;
    spring_energy_ = 0;
    for (auto from = contacts.begin(); from != contacts.end();) {
        const std::uint32_t a = from->a;
        const std::uint32_t b = from->b;
        const auto to = std::find_if(from, contacts.end(), [&](const auto& c) { return c.a != a || c.b != b; });
        const contact_force found = force_of(world_.law, {from, to}, {&world_.meshes[bodies[a].mesh], poses_[a]},
                                             {&world_.meshes[bodies[b].mesh], poses_[b]},
                                             from_eigen(vector_at(velocity, b) - vector_at(velocity, a)));
        vector_at(acceleration, a) -= in_eigen(found.force) / bodies[a].mass;
        vector_at(acceleration, b) += in_eigen(found.force) / bodies[b].mass;
        spring_energy_ += found.energy;
        from = to;
    }
}

double dynamics::mechanical_energy(const motion_state& state) const {
    double sum = 0;
    for (std::size_t i = 0; i < world_.bodies.size(); ++i) {
        const double mass = world_.bodies[i].mass;
        if (!std::isfinite(mass)) continue;
        const auto v = vector_at(state.velocity, i);
        sum += mass * (dot(v, v) / 2 + world_.gravity * state.position[3 * i + 2]);
    }
    return sum;
}

}  // namespace aabblab
