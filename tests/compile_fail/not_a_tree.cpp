#include <span>
#include <string_view>
#include <utility>
#include <vector>

#include "fakes.hpp"

import aabb;

aabb::local_detection<fake_triangle, fake_triangle> wrong;
