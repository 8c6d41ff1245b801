module;
#include <cassert>

export module aabb.base:frame_state;

import aabb.std;
import :error;

export namespace aabb {

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

}  // namespace aabb
