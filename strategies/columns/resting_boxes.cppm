export module aabb.columns.resting_boxes;

export import aabb.columns.resting_index;
import aabb.costs;
import aabb.std;

export namespace aabb {

/// Sleep detection: boxes at rest are not searched again. The pairs among them are kept, and only the others, the
/// active boxes, are searched and looked up in an index of those at rest.
///
/// While most boxes move, a frame only compares a sample of them with the previous frame. If enough of it is at rest,
/// the frame is kept with its pairs. After it, a box that moves becomes active, and stays so until another frame is
/// kept. That happens once the active boxes that have come to rest have cost as much as keeping a frame does. Likewise,
/// no frame is kept any more once searching all boxes would have cost less by as much. After frames that were kept in
/// vain, ever more are skipped (exponential back-off).
class resting_boxes {
public:
    /// Takes the boxes of a frame. If only active boxes are to be searched, `accept` must follow once they were found
    /// to be valid; otherwise the kept frame is given up.
    /// @throws input_error if the box of an absent object is invalid
    /// @returns whether `active()` are to be searched and `append_pairs` to be called; otherwise all are to be searched
    template <ColumnPartition Partition>
    [[nodiscard]] bool update(const Partition& partition, std::span<const box> boxes, const membership& objects) {
        const bool was_kept = std::exchange(is_kept_, false);
        const bool same_objects = objects.arrivals() == 0 && !objects.any_departures() && boxes.size() == size_;
        size_ = boxes.size();
        wants_to_keep_ = false;
        if (was_kept && take_changes(boxes, objects)) {
            active_boxes_.resize(active_.size());
            for (std::size_t i = 0; i < active_.size(); ++i) active_boxes_[i] = boxes[active_[i]];
            if (!active_.empty() && !index_.is_built()) build_index(partition);
            return true;
        }
        if (was_kept) give_up();
        const bool at_rest = is_sample_at_rest(boxes);
        wants_to_keep_ = at_rest && same_objects && ++skipped_frames_ > backoff_;
        return false;
    }

    void accept() noexcept { is_kept_ = true; }

    /// The boxes that do not rest, ascending by id.
    [[nodiscard]] column_group active() const noexcept { return {active_boxes_, active_}; }
    [[nodiscard]] std::size_t resting() const noexcept { return resting_; }

    /// Appends the pairs with at least one box at rest.
    /// @returns whether that succeeded within the time of searching all boxes; otherwise some pairs are missing
    template <CounterPolicy Counters>
    [[nodiscard]] bool append_pairs(std::vector<index_pair>& pairs, Counters& counters) {
        pairs.insert(pairs.end(), pairs_.begin(), pairs_.end());
        tests_ = 0;
        if (active_.empty()) return true;
        const cost_model& ns = machine_costs();
        const double most = ns.search_box * static_cast<double>(resting_ + active_.size()) / ns.column_test;
        const auto most_tests = static_cast<std::uint64_t>(std::min(most, 0x1p62));
        const auto rests = [&](std::uint32_t id) { return states_[id] == state::resting; };
        const std::optional<std::uint64_t> tests = index_.look_up(active(), boxes_, most_tests, pairs, rests);
        tests_ = tests.value_or(most_tests);
        counters.add(work::box_tests, simd::width * tests_);
        return tests.has_value();
    }

    /// Ends the use of the kept frame, after `append_pairs` has returned false.
    void give_up() noexcept {
        is_kept_ = false;
        backoff_ = std::min(2 * backoff_ + 1, longest_backoff);
        skipped_frames_ = 0;
        search_all_.forget();
        keep_again_.forget();
    }

    /// Ends a frame of which all boxes were searched: keeps it with its pairs if the sample was at rest.
    void end_full_search(std::span<const box> boxes, std::span<const index_pair> pairs) {
        if (!wants_to_keep_) return;
        boxes_.assign(boxes.begin(), boxes.end());
        next_pairs_.assign(pairs.begin(), pairs.end());
        gain_ = 0;
        is_kept_ = is_new_ = true;
    }

    /// Ends a frame of which only the active boxes were searched: keeps it, or gives up, if that is worth its cost.
    /// @param pairs all pairs of the frame
    void end_partial_search(std::span<const index_pair> pairs) {
        if (!is_kept_) return;  // the frame is searched once more
        const cost_model& ns = machine_costs();
        const auto n = static_cast<double>(resting_ + active_.size());
        const auto active = static_cast<double>(active_.size());
        const double ns_of_all = n * ns.search_box + static_cast<double>(pairs_.size()) * ns.search_pair;
        const double ns_to_look_up = std::max(active * ns.active_box, static_cast<double>(tests_) * ns.column_test);
        const double ns_of_active = static_cast<double>(compared_) * ns.watch_box + ns_to_look_up;
        const double ns_to_keep = n * 3 * ns.column_entry + static_cast<double>(pairs.size()) * ns.test_pair;
        gain_ += ns_of_all - ns_of_active;
        if (gain_ > ns_to_keep) backoff_ = 0;
        if (search_all_.exceeds(ns_to_keep, ns_of_active - ns_of_all)) {
            give_up();
            return;
        }
        const double share_settled = active > 0 ? static_cast<double>(settled_) / active : 0;
        if (!keep_again_.exceeds(ns_to_keep, share_settled * ns_to_look_up)) return;
        next_pairs_.assign(pairs.begin(), pairs.end());
        is_new_ = true;
    }

    /// Calls `take` with the id of each present box, ascending, in a frame of which `update` returned true.
    template <class Take>
    void for_each_present(Take take) const {
        for (std::uint32_t id = 0; id < states_.size(); ++id)
            if (states_[id] != state::absent) take(id);
    }

    [[nodiscard]] std::size_t bytes() const noexcept {
        return bytes_of(boxes_, states_, pairs_, next_pairs_, active_, active_boxes_, moved_, indexed_boxes_,
                        indexed_ids_, index_);
    }

private:
    enum class state : std::uint8_t { absent, active, resting };

    static constexpr std::size_t sample_size = 64;
    static constexpr unsigned longest_backoff = 63;

    /// Compares a sample of the boxes with that of the last frame that was sampled.
    /// @returns whether so much of it has not moved that it is cheaper to search the others only
    [[nodiscard]] bool is_sample_at_rest(std::span<const box> boxes) noexcept {
        std::size_t at_rest = 0;
        if (!boxes.empty())
            for (std::size_t i = 0; i < sample_size; ++i) {
                const box& b = boxes[i * boxes.size() / sample_size];
                at_rest += !differ(b, sample_[i]);
                sample_[i] = b;
            }
        const cost_model& ns = machine_costs();
        return ns.watch_box * sample_size + ns.active_box * static_cast<double>(sample_size - at_rest) <
               ns.search_box * sample_size;
    }

    /// Whether two boxes differ in any bit, in three comparisons without a branch.
    [[nodiscard, gnu::always_inline]] static bool differ(const box& a, const box& b) noexcept {
        const auto words = [](const box& of) { return __builtin_bit_cast(std::array<std::uint64_t, 3>, of); };
        const std::array<std::uint64_t, 3> x = words(a), y = words(b);
        return ((x[0] ^ y[0]) | (x[1] ^ y[1]) | (x[2] ^ y[2])) != 0;
    }

    /// Finds what has changed since the kept frame: objects that left or came, and boxes that moved.
    /// @returns whether no more than half of the boxes are active
    [[nodiscard]] bool take_changes(std::span<const box> boxes, const membership& objects) {
        if (std::exchange(is_new_, false)) begin_rest(objects);
        boxes_.resize(boxes.size());
        states_.resize(std::max(states_.size(), boxes.size()),
                       state::absent);  // one that left may have no box any more
        if (objects.any_departures() || objects.arrivals() > 0) take_objects(objects);
        states_.resize(boxes.size());
        find_moved(boxes, objects);
        const std::size_t known = active_.size();
        std::size_t moving = 0;
        for (const std::uint32_t id : std::span(moved_).first(moved_count_)) {
            // The others are validated when they are searched.
            if (states_[id] == state::absent && !is_valid(boxes[id])) require_valid(boxes);  // throws
            moving += states_[id] == state::active;
            if (states_[id] != state::resting) continue;
            states_[id] = state::active;
            active_.push_back(id);
        }
        settled_ = known - moving;
        if (active_.size() > known) {
            std::ranges::inplace_merge(active_, active_.begin() + static_cast<std::ptrdiff_t>(known));
            resting_ -= active_.size() - known;
            drop_active_pairs();
        }
        return active_.size() <= resting_;
    }

    /// Lets all boxes of the kept frame rest that are still present.
    void begin_rest(const membership& objects) {
        pairs_.swap(next_pairs_);
        index_.clear();
        active_.clear();
        states_.assign(boxes_.size(), state::absent);
        resting_ = 0;
        for (std::uint32_t id = 0; id < states_.size(); ++id) {
            if (!objects.contains(id) || objects.is_arrival(id)) continue;
            states_[id] = state::resting;
            ++resting_;
        }
        drop_active_pairs();  // those of objects that have left
    }

    void take_objects(const membership& objects) {
        active_.clear();
        resting_ = 0;
        for (std::uint32_t id = 0; id < states_.size(); ++id) {
            if (!objects.contains(id))
                states_[id] = state::absent;
            else if (states_[id] == state::absent)
                states_[id] = state::active;
            if (states_[id] == state::active) active_.push_back(id);
            resting_ += states_[id] == state::resting;
        }
        drop_active_pairs();
    }

    /// Lists the boxes that differ from those of the previous frame, ascending by id, and takes them.
    void find_moved(std::span<const box> boxes, const membership& objects) {
        moved_count_ = 0;
        compared_ = objects.moved() ? objects.moved()->size() : boxes.size();
        if (objects.moved()) {
            find_moved_among(*objects.moved(), boxes);
            objects.for_each_arrival([&](std::uint32_t id) { find_moved_among({&id, 1}, boxes); });
            const auto moved = std::span(moved_).first(moved_count_);
            if (!std::ranges::is_sorted(moved)) std::ranges::sort(moved);
            return;
        }
        if (moved_.size() <= boxes.size()) moved_.resize(boxes.size() + 1);
        for (std::uint32_t id = 0; id < boxes.size(); ++id) {
            moved_[moved_count_] = id;
            moved_count_ += differ(boxes[id], boxes_[id]);
        }
        for (const std::uint32_t id : std::span(moved_).first(moved_count_)) boxes_[id] = boxes[id];
    }
    void find_moved_among(std::span<const std::uint32_t> ids, std::span<const box> boxes) {
        if (moved_.size() < moved_count_ + ids.size()) moved_.resize(moved_count_ + ids.size());
        for (const std::uint32_t id : ids) {
            if (!differ(boxes[id], boxes_[id])) continue;
            boxes_[id] = boxes[id];  // at once, since an id may be repeated
            moved_[moved_count_++] = id;
        }
    }

    /// Drops the kept pairs with a box that does not rest any more, without branches, which would be hard to predict.
    void drop_active_pairs() noexcept {
        std::size_t kept = 0;
        for (const index_pair p : pairs_) {
            pairs_[kept] = p;
            kept += static_cast<std::size_t>(states_[p.a] == state::resting) &
                    static_cast<std::size_t>(states_[p.b] == state::resting);
        }
        pairs_.resize(kept);
    }

    template <ColumnPartition Partition>
    void build_index(const Partition& partition) {
        indexed_boxes_.clear();
        indexed_ids_.clear();
        for (std::uint32_t id = 0; id < states_.size(); ++id)
            if (states_[id] == state::resting) {
                indexed_boxes_.push_back(boxes_[id]);
                indexed_ids_.push_back(id);
            }
        if (!indexed_boxes_.empty()) index_.build(partition, {indexed_boxes_, indexed_ids_});
    }

    std::size_t size_ = 0;  // of the last frame
    std::array<box, sample_size> sample_{};
    bool wants_to_keep_ = false;
    unsigned backoff_ = 0;  // number of frames that are not kept although the sample is at rest
    unsigned skipped_frames_ = 0;
    double gain_ = 0;  // ns saved since the first kept frame
    regret search_all_, keep_again_;
    bool is_kept_ = false;                // a frame is kept
    bool is_new_ = false;                 // it is the last frame, and `next_pairs_` are its pairs
    std::vector<box> boxes_;              // of the last frame, by id
    std::vector<state> states_;           // by id
    std::vector<index_pair> pairs_;       // of boxes that rest
    std::vector<index_pair> next_pairs_;  // of the next frame to be kept
    std::size_t resting_ = 0, settled_ = 0;
    std::vector<std::uint32_t> active_;  // ids, ascending
    std::vector<box> active_boxes_;      // of this frame
    std::vector<std::uint32_t> moved_;   // ids of boxes that differ from the previous frame's, ascending
    std::size_t moved_count_ = 0;
    std::size_t compared_ = 0;        // boxes of this frame
    std::vector<box> indexed_boxes_;  // those that rested when the index was built
    std::vector<std::uint32_t> indexed_ids_;
    resting_index index_;
    std::uint64_t tests_ = 0;  // vector tests of the last frame's queries
};

}  // namespace aabb
