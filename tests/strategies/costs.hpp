#pragma once

#include <rapidcheck.h>

import aabb.std;
import aabb;

/// Sets the machine's costs while it lives.
class scoped_costs {
public:
    explicit scoped_costs(const aabb::cost_model& costs) { set_machine_costs(costs); }
    scoped_costs(const scoped_costs&) = delete;
    scoped_costs& operator=(const scoped_costs&) = delete;
    ~scoped_costs() { aabb::set_machine_costs({}); }
};

/// From a billionth of a nanosecond to a second.
inline aabb::cost_model any_costs() {
    aabb::cost_model costs;
    for (const aabb::cost_info& cost : aabb::cost_infos) costs.*cost.value = std::pow(10.0, *rc::gen::inRange(-9, 10));
    return costs;
}
