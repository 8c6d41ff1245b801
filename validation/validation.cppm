/// Reference systems that replace our stages, the ground truth, and the differences of their results from it.
export module aabb.validation;

export import aabb.engines;
export import aabb.truth;
