#include "../testing.hpp"

import aabb.costs;

using namespace aabb;

TEST_CASE("every cost has a unique name, a unit and a positive default") {
    static_assert(sizeof(cost_model) == cost_infos.size() * sizeof(double));
    std::set<std::string_view> names;
    cost_model other;
    for (const cost_info& cost : cost_infos) {
        CHECK(names.insert(cost.name).second);
        CHECK(cost.unit.starts_with("ns/"));
        CHECK(cost_model{}.*cost.value > 0);
        other.*cost.value = 0;
    }
    for (const cost_info& cost : cost_infos) CHECK(other.*cost.value == 0);
}

TEST_CASE("machine costs are the defaults until others are set") {
    CHECK(machine_costs() == cost_model{});
    cost_model expensive;
    expensive.node_visit = 1000;
    set_machine_costs(expensive);
    CHECK(machine_costs() == expensive);
    set_machine_costs({});
    CHECK(machine_costs() == cost_model{});
}
