/// The room of the partition into columns and of its sweep: what the two strategies see of it. All else is behind.
export module aabb.columns;

export import aabb.columns.lists;
export import aabb.columns.search;
