module;
#include <oneapi/tbb/blocked_range.h>
#include <oneapi/tbb/info.h>
#include <oneapi/tbb/parallel_for.h>
#include <oneapi/tbb/partitioner.h>
#include <oneapi/tbb/task_arena.h>
#include <algorithm>
#include <cstddef>
#include <map>
#include <mutex>

module aabb.base;

namespace aabb::detail {

namespace {

/// Kept from call to call: threads linger in it for a while, and begin at once when they are needed again.
tbb::task_arena& arena_of(unsigned threads) {
    static std::mutex only_one;
    static std::map<unsigned, tbb::task_arena> arenas;
    const std::scoped_lock lock(only_one);
    // It warns when it is asked for more than there are processors.
    return arenas.try_emplace(threads, std::min(static_cast<int>(threads), tbb::info::default_concurrency()))
        .first->second;
}

}  // namespace

void share_out(std::size_t count, unsigned threads, void (*call)(void* work, std::size_t i, std::size_t worker),
               void* work) {
    arena_of(threads).execute([&] {
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
