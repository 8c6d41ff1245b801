/// AABB Lab's core: the building blocks of strategies and the stages that run them. Each strategy is a module of its
/// own (`aabb.sort.std`, …).
export module aabb;

export import aabb.base;
export import aabb.collision_filter;
export import aabb.containment;
export import aabb.costs;
export import aabb.counters;
export import aabb.digest;
export import aabb.distance_stage;
export import aabb.eigen;
export import aabb.geometry;
export import aabb.global_search;
export import aabb.local_detection;
export import aabb.pipeline;
export import aabb.policy;
export import aabb.simd;
