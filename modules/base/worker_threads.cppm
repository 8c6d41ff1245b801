export module aabb.base:worker_threads;

import aabb.std;

export namespace aabb {

/// A thread pool of one object. Threads stay awake for a while after each call, so that the next one starts at once.
class worker_threads {
public:
    explicit worker_threads(unsigned count);
    worker_threads(worker_threads&&) noexcept;
    worker_threads& operator=(worker_threads&&) noexcept;
    ~worker_threads();
    [[nodiscard]] unsigned count() const noexcept { return count_; }

    /// Calls `work(i, worker)` for each i < `n`, in unspecified order on more than one thread. Calls with the same
    /// worker, a number < `count`, never run concurrently. The first exception stops the loop and is rethrown.
    template <class Work>
    void for_each_index(std::size_t n, Work work) {
        const auto call = [](void* of, std::size_t i, std::size_t worker) { (*static_cast<Work*>(of))(i, worker); };
        if (count_ > 1 && n > 1) return run_in_arena(n, call, &work);
        for (std::size_t i = 0; i < n; ++i) work(i, std::size_t{0});
    }

    /// Calls `work(begin, end)` for ranges of `size` indices < `n`, the last one shorter, like `for_each_index`.
    template <class Work>
    void for_each_range(std::size_t n, std::size_t size, Work work) {
        for_each_index((n + size - 1) / size,
                       [&](std::size_t r, std::size_t) { work(r * size, std::min(n, (r + 1) * size)); });
    }

    /// Calls both functions, on two threads if a second one is idle. Either may call `both` again, or distribute work
    /// that does not use the worker's number. An exception is rethrown; the other function may then not be called.
    template <class First, class Second>
    void both(First first, Second second) {
        const auto call_first = [](void* of) { (*static_cast<First*>(of))(); };
        const auto call_second = [](void* of) { (*static_cast<Second*>(of))(); };
        if (count_ > 1) return run_both_in_arena(call_first, &first, call_second, &second);
        first();
        second();
    }

private:
    struct arena;

    void run_in_arena(std::size_t n, void (*call)(void* work, std::size_t i, std::size_t worker), void* work);
    void run_both_in_arena(void (*first)(void*), void* of_first, void (*second)(void*), void* of_second);

    unsigned count_;
    std::unique_ptr<arena> arena_;  // null for one thread
};

}  // namespace aabb
