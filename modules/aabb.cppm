/// AABB Lab's core: what strategies are made of and what runs them. Strategies are modules of their own
/// (`aabb.sort.std`, …).
export module aabb;

export import :balanced_build;
export import :counters;
export import :digest;
export import :error;
export import :geometry;
export import :global_search;
export import :inversions;
export import :local_detection;
export import :membership;
export import :mesh;
export import :pair_set;
export import :pipeline;
export import :policy;
export import :pose;
export import :predicates;
export import :projection;
export import :projection_lists;
export import :scene;
export import :sort_policy;
export import :split_large;
export import :spread;
export import :stage;
export import :subset_lists;
export import :sweep_policy;
