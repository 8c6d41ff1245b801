/// Reference systems in place of our pipeline, the exact answer, and what theirs differ in from it.
export module aabb.validation;

export import aabb.engines;
export import aabb.truth;
