#include "fakes.hpp"

import aabb.std;
import aabb;

aabb::local_detection<fake_triangle, fake_triangle> wrong;
