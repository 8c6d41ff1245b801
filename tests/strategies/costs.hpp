#pragma once

#include <rapidcheck.h>

import aabb.std;
import aabb;

/// Costs in force for one test.
class these_costs {
public:
    explicit these_costs(const aabb::cost_model& costs) { set_machine_costs(costs); }
    these_costs(const these_costs&) = delete;
    these_costs& operator=(const these_costs&) = delete;
    ~these_costs() { aabb::set_machine_costs({}); }
};

/// From a billionth of a nanosecond to a second.
inline aabb::cost_model any_costs() {
    aabb::cost_model costs;
    for (const aabb::cost_info& cost : aabb::cost_infos) costs.*cost.value = std::pow(10.0, *rc::gen::inRange(-9, 10));
    return costs;
}
