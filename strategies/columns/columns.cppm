/// The interface of the column search for the two strategies that use it, the `columns` partition and the `simd` sweep.
export module aabb.columns;

export import aabb.columns.lists;
export import aabb.columns.search;
