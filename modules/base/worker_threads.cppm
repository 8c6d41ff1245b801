export module aabb.base:worker_threads;

import aabb.std;

export namespace aabb {

/// Threads that work for one object. They linger for a while after each call, and begin the next one at once.
class worker_threads {
public:
    explicit worker_threads(unsigned count);
    worker_threads(worker_threads&&) noexcept;
    worker_threads& operator=(worker_threads&&) noexcept;
    ~worker_threads();

    [[nodiscard]] unsigned count() const noexcept { return count_; }

    /// Calls `work(i, worker)` for each i below `n`, in no particular order on more than one thread; no two calls with
    /// one number of a worker, which is below `count`, at a time. An exception ends it, and leaves it.
    template <class Work>
    void for_each_index(std::size_t n, Work work) {
        const auto call = [](void* made, std::size_t i, std::size_t worker) { (*static_cast<Work*>(made))(i, worker); };
        if (count_ > 1 && n > 1) return share_out(n, call, &work);
        for (std::size_t i = 0; i < n; ++i) work(i, std::size_t{0});
    }

    /// Calls `work(begin, end)` for ranges of `size` numbers below `n`, the last one shorter, like `for_each_index`.
    template <class Work>
    void for_each_range(std::size_t n, std::size_t size, Work work) {
        for_each_index((n + size - 1) / size,
                       [&](std::size_t r, std::size_t) { work(r * size, std::min(n, (r + 1) * size)); });
    }

    /// Calls both, on two threads where a second is free. Either may call this again, or share out work that does not
    /// ask for the worker. An exception leaves it; whether the other one is called then is not said.
    template <class First, class Second>
    void both(First first, Second second) {
        const auto call_first = [](void* made) { (*static_cast<First*>(made))(); };
        const auto call_second = [](void* made) { (*static_cast<Second*>(made))(); };
        if (count_ > 1) return share_both(call_first, &first, call_second, &second);
        first();
        second();
    }

private:
    struct arena;

    void share_out(std::size_t n, void (*call)(void* work, std::size_t i, std::size_t worker), void* work);
    void share_both(void (*first)(void*), void* of_first, void (*second)(void*), void* of_second);

    unsigned count_;
    std::unique_ptr<arena> arena_;  // none for one thread
};

}  // namespace aabb
