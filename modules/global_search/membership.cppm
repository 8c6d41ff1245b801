export module aabb.global_search:membership;

import aabb.base;
import aabb.std;

export namespace aabb {

/// The set of present objects, with the arrivals and departures since the previous frame and, if the caller says so,
/// the objects that have moved. Ids are stable.
class membership {
public:
    /// Makes an object present from the next frame on. It is `arriving` until that frame, then `known`.
    /// @throws input_error if the object is already present
    void insert(std::uint32_t id) {
        if (id == state_.size())
            state_.push_back(state::absent);
        else if (id > state_.size())
            state_.resize(std::size_t{id} + 1, state::absent);
        if (contains(id)) reject(id, " is inserted twice");
        // An object that is removed and inserted again between two frames counts as known.
        const bool arrives = state_[id] == state::absent;
        arrivals_ += arrives;
        any_returns_ |= !arrives;
        state_[id] = arrives ? state::arriving : state::known;
        ++size_;
    }

    /// The same for several objects. If one is already present, those before it are inserted.
    void insert_all(std::span<const std::uint32_t> ids) {
        if (ids.empty()) return;
        const std::size_t most = std::ranges::max(ids);
        if (most >= state_.size()) state_.resize(most + 1, state::absent);
        state* const states = state_.data();
        for (std::size_t i = 0; i < ids.size();) {
            // Counted apart, since members would be read and written for each object.
            const std::size_t first = i;
            while (i < ids.size() && states[ids[i]] == state::absent) states[ids[i++]] = state::arriving;
            arrivals_ += i - first;
            size_ += i - first;
            if (i < ids.size()) insert(ids[i++]);  // leaving, or already present
        }
    }

    /// Makes an object absent from the next frame on. Until that frame it is `leaving`, since lists still contain it.
    /// @throws input_error if the object is not present
    void remove(std::uint32_t id) {
        if (!contains(id)) reject(id, " is removed but was never inserted");
        --size_;
        if (state_[id] == state::arriving) {  // inserted since the last frame: no list contains it
            --arrivals_;
            state_[id] = state::absent;
        } else {
            state_[id] = state::leaving;
            any_departures_ = true;
        }
    }

    /// As `global_stage::moved`: the ids must exist until the frame is taken.
    void moved(std::span<const std::uint32_t> ids) noexcept { moved_ = ids; }
    /// The objects among which are all that have moved since the previous frame, in any order; nullopt if unknown.
    /// Arrivals need not be among them.
    [[nodiscard]] std::optional<std::span<const std::uint32_t>> moved() const noexcept {
        return any_returns_ ? std::nullopt : moved_;  // an object that was removed and inserted need not be among them
    }
    void forget_moved() noexcept { moved_.reset(); }

    [[nodiscard]] std::size_t size() const noexcept { return size_; }
    [[nodiscard]] inline bool contains(std::uint32_t id) const noexcept {
        return id < state_.size() && (state_[id] == state::arriving || state_[id] == state::known);
    }
    [[nodiscard]] std::size_t arrivals() const noexcept { return arrivals_; }
    [[nodiscard]] inline bool is_arrival(std::uint32_t id) const noexcept { return state_[id] == state::arriving; }
    [[nodiscard]] bool any_departures() const noexcept { return any_departures_; }
    [[nodiscard]] inline bool is_leaving(std::uint32_t id) const noexcept { return state_[id] == state::leaving; }

    /// Calls `take` with the id of each arrival, ascending.
    void for_each_arrival(auto take) const {
        if (arrivals_ == 0) return;
        for (std::size_t id = 0; id < state_.size(); ++id)
            if (state_[id] == state::arriving) take(static_cast<std::uint32_t>(id));
    }

    /// Rejects a frame in which an object that is present or has moved has no box, or which has boxes although `insert`
    /// was never called: a program without that call would silently get no pairs.
    /// @param boxes number of boxes in the frame, which are indexed by object id
    void require_boxes_for_all(std::size_t boxes) const {
        if (state_.empty() && boxes > 0)
            throw input_error("no object was inserted; call insert(id) for each box first");
        for (std::uint32_t id = static_cast<std::uint32_t>(std::min(boxes, state_.size())); id < state_.size(); ++id)
            if (contains(id)) reject_without_box(id, "is present", boxes);
        if (!moved_) return;
        for (const std::uint32_t id : *moved_)
            if (id >= boxes) reject_without_box(id, "has moved", boxes);
    }

    /// Marks arrivals, departures and motion as processed.
    void settle() {
        if (any_departures_) std::ranges::replace(state_, state::leaving, state::absent);
        if (arrivals_ > 0) std::ranges::replace(state_, state::arriving, state::known);
        any_departures_ = false;
        any_returns_ = false;
        arrivals_ = 0;
        forget_moved();
    }

    [[nodiscard]] std::size_t bytes() const noexcept { return bytes_of(state_); }

private:
    enum class state : std::uint8_t { absent, arriving, known, leaving };

    // Out of line, so that the functions called per object stay small enough to inline.
    [[noreturn]] static void reject(std::uint32_t id, const char* why) {
        throw input_error("object " + std::to_string(id) + why);
    }
    [[noreturn]] static void reject_without_box(std::uint32_t id, const std::string& what, std::size_t boxes) {
        throw input_error("object " + std::to_string(id) + " " + what + ", but the frame has only " +
                          std::to_string(boxes) + " boxes");
    }

    std::vector<state> state_;  // by id
    std::size_t size_ = 0;
    std::size_t arrivals_ = 0;
    bool any_departures_ = false;
    bool any_returns_ = false;  // an object was removed and inserted again since the previous frame
    std::optional<std::span<const std::uint32_t>> moved_;
};

}  // namespace aabb
