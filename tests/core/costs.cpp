#include "../testing.hpp"

import aabb.costs;

using namespace aabb;

TEST_CASE("every cost has a name and a unit of its own, and none is free") {
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

TEST_CASE("costs are the defaults until others are set, for the whole process") {
    CHECK(machine_costs() == cost_model{});
    cost_model dear;
    dear.node_visit = 1000;
    set_machine_costs(dear);
    CHECK(machine_costs() == dear);
    set_machine_costs({});
    CHECK(machine_costs() == cost_model{});
}
