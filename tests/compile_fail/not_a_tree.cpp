#include "fakes.hpp"

aabb::local_detection<fake_triangle, fake_triangle> wrong;
