module;
#include <oneapi/tbb/blocked_range.h>
#include <oneapi/tbb/info.h>
#include <oneapi/tbb/parallel_for.h>
#include <oneapi/tbb/parallel_invoke.h>
#include <oneapi/tbb/partitioner.h>
#include <oneapi/tbb/task_arena.h>

module aabb.base;

namespace aabb {

struct worker_threads::arena {
    tbb::task_arena of;
};

// TBB warns if it is asked for more threads than processors, so the number is limited.
worker_threads::worker_threads(unsigned count)
    : count_(count),
      arena_(count > 1 ? std::make_unique<arena>(
                             tbb::task_arena(std::min(static_cast<int>(count), tbb::info::default_concurrency())))
                       : nullptr) {}
worker_threads::worker_threads(worker_threads&&) noexcept = default;
worker_threads& worker_threads::operator=(worker_threads&&) noexcept = default;
worker_threads::~worker_threads() = default;

/// Calls `call(work, i, worker)` for each i < n on several threads, where `worker` is the number of the calling thread.
/// A function pointer with its argument `work`, instead of a template, spares importers the headers of TBB.
void worker_threads::run_in_arena(std::size_t n, void (*call)(void* work, std::size_t i, std::size_t worker),
                                  void* work) {
    const auto call_for_each = [&] {
        tbb::parallel_for(
            tbb::blocked_range<std::size_t>(0, n, 1),
            [&](const tbb::blocked_range<std::size_t>& range) {
                const auto worker = static_cast<std::size_t>(tbb::this_task_arena::current_thread_index());
                for (std::size_t i = range.begin(); i != range.end(); ++i) call(work, i, worker);
            },
            tbb::simple_partitioner());
    };
    // Isolated, so that a thread that waits for the rest of this work does not start another task, which may be long.
    arena_->of.execute([&] { tbb::this_task_arena::isolate(call_for_each); });
}

void worker_threads::run_both_in_arena(void (*first)(void*), void* of_first, void (*second)(void*), void* of_second) {
    arena_->of.execute([&] { tbb::parallel_invoke([&] { first(of_first); }, [&] { second(of_second); }); });
}

}  // namespace aabb
