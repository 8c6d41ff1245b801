module;
#include <sched.h>

/// Pins threads to processors.
export module aabblab.processor;

export namespace aabblab {

/// Pins this thread to one processor during its lifetime, so that caches stay warm: to the allowed processor that was
/// least busy in a short sample. If the system does not permit pinning, it has no effect.
class idlest_processor {
public:
    idlest_processor();
    idlest_processor(const idlest_processor&) = delete;
    idlest_processor& operator=(const idlest_processor&) = delete;
    ~idlest_processor() { unpin(); }

    /// Calls `work` without pinning, so that threads that it starts may run on all processors.
    void without(auto&& work) const {
        unpin();
        work();
        pin();
    }

private:
    void pin() const {
        if (is_pinned_) sched_setaffinity(0, sizeof idlest_, &idlest_);
    }
    void unpin() const {
        if (is_pinned_) sched_setaffinity(0, sizeof before_, &before_);
    }

    cpu_set_t before_, idlest_;
    bool is_pinned_ = false;
};

}  // namespace aabblab
