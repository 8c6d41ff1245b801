module;
#include <cassert>

export module aabb.base:frame_state;

import aabb.std;

export namespace aabb {

/// Invalid input: a malformed file, an unknown name, a NaN, a singular pose. `what()` is one sentence for the
/// user; the program prints it and exits with status 2.
class input_error : public std::runtime_error {
public:
    using std::runtime_error::runtime_error;
};

/// Tracks whether a stage has a frame to search, and whether it can take another one. Stages keep lists and pairs
/// between frames, so an exception in the middle of a change (mostly std::bad_alloc) would make later results silently
/// wrong. The stage is therefore unusable from then on.
class frame_state {
public:
    /// Must be called at the beginning of an update; it invalidates the previous frame.
    /// @throws input_error if an earlier change was interrupted by an exception
    void begin() {
        if (state_ == state::broken) throw_broken();
        state_ = state::none;
    }

    /// Runs a change of state that persists between frames; an exception in it makes the stage unusable.
    template <class Change>
    void change(Change make) {
        const state before = std::exchange(state_, state::broken);
        make();
        state_ = before;
    }

    /// Must be called at the end of an update.
    void taken() noexcept {
        assert(state_ == state::none);
        state_ = state::taken;
    }

    [[nodiscard]] bool is_taken() const noexcept { return state_ == state::taken; }

    /// Must be called before a search.
    /// @throws input_error if the last update failed or there was none
    void require_taken() const {
        if (state_ == state::broken) throw_broken();
        if (state_ == state::none)
            throw input_error("there is no frame to search: update was not called, or did not succeed");
    }

private:
    enum class state : std::uint8_t { none, taken, broken };

    [[noreturn]] static void throw_broken() {
        throw input_error(
            "an exception in an earlier frame left this stage in an inconsistent state; create a new one");
    }

    state state_ = state::none;
};

/// Removes what was appended to a list since its construction, unless `keep` was called, as after an exception.
template <class List>
class append_guard {
public:
    explicit append_guard(List& list) : list_(&list), before_(list.size()) {}
    append_guard(const append_guard&) = delete;
    append_guard& operator=(const append_guard&) = delete;
    ~append_guard() {
        if (list_ != nullptr) list_->resize(before_);
    }

    void keep() noexcept { list_ = nullptr; }

private:
    List* list_;
    std::size_t before_;
};

}  // namespace aabb
