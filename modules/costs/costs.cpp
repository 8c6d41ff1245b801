module aabb.costs;

namespace aabb {

// Here, so that no program that imports the interface initialises it, and all that imports it, for nothing.
static cost_model in_force;

const cost_model& machine_costs() noexcept {
    return in_force;
}

void set_machine_costs(const cost_model& costs) noexcept {
    in_force = costs;
}

}  // namespace aabb
