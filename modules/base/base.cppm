/// What everything else stands on: how input is refused, what of a half-made change stays, the bytes that things hold,
/// and the arithmetic that answers need.
export module aabb.base;

import aabb.std;

export import :floating_point;
export import :frame_state;
export import :large_pages;
export import :memory;
export import :statement;
export import :worker_threads;
