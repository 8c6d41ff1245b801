module;
#include <cstddef>

export module aabb.base:parallel;

namespace aabb::detail {

/// Calls `call(work, i, worker)`.
void share_out(std::size_t count, unsigned threads, void (*call)(void* work, std::size_t i, std::size_t worker),
               void* work);

}  // namespace aabb::detail

export namespace aabb {

/// Calls `work(i, worker)` for each i below `count`, in no particular order on more than one thread; no two calls with
/// one number of a worker, which is below `threads`, at a time. An exception ends it, and leaves it.
template <class Work>
void for_each_index(std::size_t count, unsigned threads, Work work) {
    const auto call = [](void* made, std::size_t i, std::size_t worker) { (*static_cast<Work*>(made))(i, worker); };
    if (threads > 1 && count > 1) return detail::share_out(count, threads, call, &work);
    for (std::size_t i = 0; i < count; ++i) work(i, std::size_t{0});
}

}  // namespace aabb
