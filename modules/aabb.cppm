/// AABB Lab's core: what strategies are made of and what runs them. Strategies are modules of their own
/// (`aabb.sort.std`, …).
export module aabb;

export import :balanced_build;
export import :counters;
export import :digest;
export import :error;
export import :geometry;
export import :global_search;
export import :local_detection;
export import :mesh;
export import :pipeline;
export import :policy;
export import :pose;
export import :predicates;
export import :scene;
export import :stage;
