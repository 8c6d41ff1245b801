#include "fakes.hpp"

aabb::global_search<fake_sweep, fake_whole_partition, fake_sweep> wrong;
