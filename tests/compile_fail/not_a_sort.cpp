#include <span>
#include <string_view>
#include <utility>
#include <vector>

#include "fakes.hpp"

import aabb;

aabb::global_search<fake_sweep, fake_whole_partition, fake_sweep> wrong;
