#include "fakes.hpp"

import aabb.sort.std;

aabb::global_search<aabb::std_sort, fake_whole_partition, picky_sweep> rejected;
