module aabb.costs;

namespace aabb {

namespace {

cost_model in_force;

}  // namespace

const cost_model& machine_costs() noexcept {
    return in_force;
}

void set_machine_costs(const cost_model& costs) noexcept {
    in_force = costs;
}

}  // namespace aabb
