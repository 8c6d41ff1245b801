module;
#include <algorithm>
#include <cstddef>
#include <oneapi/tbb/blocked_range.h>
#include <oneapi/tbb/info.h>
#include <oneapi/tbb/parallel_for.h>
#include <oneapi/tbb/partitioner.h>
#include <oneapi/tbb/task_arena.h>

module aabb.base;

namespace aabb::detail {

void share_out(std::size_t count, unsigned threads, void (*call)(void* work, std::size_t i, std::size_t worker),
               void* work) {
    // It warns when it is asked for more than there are processors.
    tbb::task_arena arena(std::min(static_cast<int>(threads), tbb::info::default_concurrency()));
    arena.execute([&] {
        tbb::parallel_for(
            tbb::blocked_range<std::size_t>(0, count, 1),
            [&](const tbb::blocked_range<std::size_t>& range) {
                const auto worker = static_cast<std::size_t>(tbb::this_task_arena::current_thread_index());
                for (std::size_t i = range.begin(); i != range.end(); ++i) call(work, i, worker);
            },
            tbb::simple_partitioner());
    });
}

}  // namespace aabb::detail
