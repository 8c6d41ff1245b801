module aabb.costs;

namespace aabb {

// Defined here, so that importers of the interface do not initialize it.
static cost_model in_force;

const cost_model& machine_costs() noexcept {
    return in_force;
}

void set_machine_costs(const cost_model& costs) noexcept {
    in_force = costs;
}

}  // namespace aabb
