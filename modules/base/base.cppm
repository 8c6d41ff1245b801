/// The foundation of all other modules: rejection of invalid input, exception safety, memory accounting, threads, and
/// the arithmetic that exact results require.
export module aabb.base;

import aabb.std;

export import :floating_point;
export import :frame_state;
export import :large_pages;
export import :memory;
export import :statement;
export import :worker_threads;
