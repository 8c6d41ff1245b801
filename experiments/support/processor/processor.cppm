module;
#include <sched.h>

/// Where this process runs.
export module aabblab.processor;

export namespace aabblab {

/// Keeps this thread on one processor while it lives, so that its caches stay warm: of those that it may run on the one
/// that has been the least busy for the last moment. Where the system does not allow it, all stays as it is.
class idlest_processor {
public:
    idlest_processor();
    idlest_processor(const idlest_processor&) = delete;
    idlest_processor& operator=(const idlest_processor&) = delete;
    ~idlest_processor();

    /// Calls `work` while this thread, and threads that it starts, may run wherever this one might before.
    void without(auto&& work) const {
        leave();
        work();
        stay();
    }

private:
    void stay() const;
    void leave() const;

    cpu_set_t before_;
    cpu_set_t idlest_;
    bool stays_ = false;
};

}  // namespace aabblab
