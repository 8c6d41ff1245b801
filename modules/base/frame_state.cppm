module;
#include <cassert>

export module aabb.base:frame_state;

import aabb.std;

export namespace aabb {

/// Input that cannot be used: a malformed file, an unknown name, a NaN, a pose that is not rigid.
/// `what()` is one sentence for the user; the program prints it and exits with status 2.
class input_error : public std::runtime_error {
public:
    using std::runtime_error::runtime_error;
};

/// Whether a stage has a frame to search, and whether it can take another one. Stages keep lists and pairs from frame
/// to frame, so one that an exception left half-changed (std::bad_alloc, mostly) would be wrong later on without a
/// word: it is refused for good.
class frame_state {
public:
    /// At the beginning of an update: whatever comes of it, the frame before is over.
    /// @throws input_error when a change was left half-made.
    void begin() {
        if (state_ == state::broken) throw_broken();
        state_ = state::none;
    }

    /// Makes a change of what is kept; an exception that leaves it ends the use of the stage.
    template <class Change>
    void change(Change make) {
        const state before = std::exchange(state_, state::broken);
        make();
        state_ = before;
    }

    /// At the end of an update.
    void taken() noexcept {
        assert(state_ == state::none);
        state_ = state::taken;
    }

    /// Before a search.
    /// @throws input_error when no update, or not the last one, came to its end.
    void require_taken() const {
        if (state_ == state::broken) throw_broken();
        if (state_ == state::none)
            throw input_error("there is no frame to search: update was not called, or did not succeed");
    }

private:
    enum class state : std::uint8_t { none, taken, broken };

    [[noreturn]] static void throw_broken() {
        throw input_error("an exception in an earlier frame left this stage half-changed; make a new one");
    }

    state state_ = state::none;
};

/// Calls `append`, which appends to a list; when it throws, what it had appended is taken back.
template <class T, class Allocator, class Append>
void append_whole(std::vector<T, Allocator>& list, Append append) {
    const std::size_t before = list.size();
    try {
        append();
    } catch (...) {
        list.resize(before);
        throw;
    }
    assert(list.size() >= before);
}

}  // namespace aabb
