#include "fakes.hpp"

import aabb.std;
import aabb;
import aabb.sort.std;

struct picky_sweep : fake_sweep {
    template <class Sort, class...>
    static constexpr std::string_view refuses() {
        return Sort::name == fake_sort::name ? "" : "picky works with the fake sort only";
    }
};

aabb::global_search<aabb::std_sort, fake_whole_partition, picky_sweep> refused;
