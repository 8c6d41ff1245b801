module aabb.prepare.split_large;

import aabb.prepare.mean_extent;

#pragma clang fp contract(off) reassociate(off) reciprocal(off)  // see aabb.base:floating_point

namespace aabb {

namespace {

bool is_longer(const box& b, double longest) {
    for (int k = 0; k < 3; ++k)
        if (double{b.max[k]} - double{b.min[k]} > longest) return true;
    return false;
}

class split_large_stage final : public global_stage {
public:
    split_large_stage(std::unique_ptr<global_stage> search, double size, instrumentation counted)
        : search_(std::move(search)), size_(size), counted_(counted) {}

    /// Inserts an object. In the inner search, the ids from `first_slot_` on are those of pieces.
    void insert(std::uint32_t id) override {
        objects_.insert(id);
        frame_.change([&] {
            // If the new id is that of a piece, all pieces are removed; the next update makes them anew.
            if (id >= first_slot_) drop_pieces();
            search_->insert(id);
        });
    }
    void remove(std::uint32_t id) override {
        objects_.remove(id);
        search_->remove(id);
    }

    /// Divides boxes longer than `size_` mean extents, which would overlap many others on every axis, into pieces.
    void update(std::span<const box> boxes) override {
        frame_.begin();
        objects_.require_boxes_for_all(boxes.size());
        require_valid(boxes);
        objects_.settle();
        const double longest = mean_extents(size_, boxes, objects_);
        find_splits(boxes, longest);
        boxes_ = boxes;
        frame_.change([&] {
            if (first_slot_ != boxes.size()) drop_pieces();  // ids of pieces follow those of objects
            first_slot_ = static_cast<std::uint32_t>(boxes.size());
            assign_slots();
        });
        if (!splits_.empty()) make_pieces(boxes, longest);
        if (counted_ == instrumentation::counters) pieces_counted_ += slots_.size() + splits_.size();
        search_->update(splits_.empty() ? boxes : pieces_);
        frame_.taken();
    }

    /// Appends the objects of the pairs of pieces found; of several pairs of the same objects, one reports them.
    void search(std::vector<index_pair>& pairs) override {
        frame_.require_taken();
        if (splits_.empty()) return search_->search(pairs);
        piece_pairs_.clear();
        search_->search(piece_pairs_);
        append_guard guard(pairs);
        for (const auto [a, b] : piece_pairs_)
            if (owns_pair(a, b)) pairs.push_back(ordered_pair(object_of(a), object_of(b)));
        guard.keep();
    }

    [[nodiscard]] double share_of_update() const override { return search_->share_of_update(); }
    [[nodiscard]] work_counters counters() const override {
        work_counters total = search_->counters();
        total.add(work::pieces, pieces_counted_);
        return total;
    }
    [[nodiscard]] std::vector<part_bytes> bytes() const override {
        std::vector<part_bytes> parts = search_->bytes();
        parts.push_back({"prepare", bytes_of(objects_, splits_, slots_, splits_now_, slots_now_, object_of_slot_,
                                             free_slots_, left_slots_, pieces_, piece_pairs_)});
        return parts;
    }
    [[nodiscard]] std::vector<stage_plan> plans() const override { return search_->plans(); }
    [[nodiscard]] std::vector<omission> left_out() const override {
        std::vector<omission> absent = search_->left_out();
        if (splits_.empty()) absent.push_back({absence::division, "none is large"});
        return absent;
    }

private:
    /// The ends of an interval's pieces: where each begins, then where the last one ends.
    struct cut_interval {
        std::size_t pieces;
        std::array<float, most_pieces + 1> at;
    };
    /// A divided object and its number of pieces on each axis.
    struct split {
        std::uint32_t object;
        std::array<std::uint8_t, 3> pieces;

        /// The number of pieces beside the first one, which keeps the object's id.
        [[nodiscard]] std::size_t further_pieces() const { return std::size_t{pieces[0]} * pieces[1] * pieces[2] - 1; }
        friend bool operator==(const split&, const split&) = default;
    };

    /// Cuts an interval into equal pieces no longer than `longest`, but into `most_pieces` at most (`piece_count`).
    [[nodiscard]] static cut_interval cut(float lower, float upper, double longest) {
        const double extent = double{upper} - double{lower};
        cut_interval interval{.pieces = piece_count(extent, longest), .at = {lower}};
        const auto wanted = static_cast<double>(interval.pieces);
        for (std::size_t i = 1; i < interval.pieces; ++i) {
            interval.at[i] = static_cast<float>(double{lower} + extent * static_cast<double>(i) / wanted);
            // The interval is not divided if it contains too few floats.
            if (!(interval.at[i] > interval.at[i - 1] && interval.at[i] < upper))
                return {.pieces = 1, .at = {lower, upper}};
        }
        interval.at[interval.pieces] = upper;
        return interval;
    }

    /// Lists the objects with boxes longer than `longest` in `splits_now_`, ascending, with their pieces per axis.
    void find_splits(std::span<const box> boxes, double longest) {
        splits_now_.clear();
        std::size_t total = 0;
        for (std::uint32_t id = 0; id < boxes.size(); ++id) {
            if (!objects_.contains(id) || !is_longer(boxes[id], longest)) continue;
            split division{.object = id, .pieces = {}};
            for (int k = 0; k < 3; ++k)
                division.pieces[static_cast<std::size_t>(k)] =
                    static_cast<std::uint8_t>(cut(boxes[id].min[k], boxes[id].max[k], longest).pieces);
            if (division.further_pieces() == 0) continue;
            total += division.further_pieces() + 1;
            require_few_pieces(split_large_prepare::name, total, boxes.size());
            splits_now_.push_back(division);
        }
    }

    /// Gives each piece of a divided object but the first a slot: its id is `first_slot_` + slot. Splits are merged
    /// with those of the last frame: an unchanged one keeps its slots, and with them its places in sorted lists.
    void assign_slots() {
        // Slots freed in the last frame can be reused now, since the search has removed their pieces.
        free_slots_.insert(free_slots_.end(), left_slots_.begin(), left_slots_.end());
        left_slots_.clear();
        slots_now_.clear();
        std::size_t known = 0;  // index of a split of the last frame
        std::size_t first = 0;  // index in `slots_` of its first slot
        const auto pass_known = [&](auto use) {
            for (std::size_t end = first + splits_[known].further_pieces(); first < end; ++first) use(slots_[first]);
            ++known;
        };
        const auto free_slot = [&](std::uint32_t slot) {
            search_->remove(first_slot_ + slot);
            left_slots_.push_back(slot);
        };
        for (const split& current : splits_now_) {
            while (known < splits_.size() && splits_[known].object < current.object) pass_known(free_slot);
            if (known < splits_.size() && splits_[known] == current) {
                pass_known([&](std::uint32_t slot) { slots_now_.push_back(slot); });
                continue;
            }
            for (std::size_t i = current.further_pieces(); i > 0; --i) {
                slots_now_.push_back(take_slot());
                object_of_slot_[slots_now_.back()] = current.object;
                search_->insert(first_slot_ + slots_now_.back());
            }
        }
        while (known < splits_.size()) pass_known(free_slot);
        splits_.swap(splits_now_);
        slots_.swap(slots_now_);
    }

    /// A slot for a piece: a free one or, if there is none, a new one behind all others.
    [[nodiscard]] std::uint32_t take_slot() {
        if (free_slots_.empty()) {
            object_of_slot_.push_back(0);
            return static_cast<std::uint32_t>(object_of_slot_.size() - 1);
        }
        const std::uint32_t slot = free_slots_.back();
        free_slots_.pop_back();
        return slot;
    }

    void drop_pieces() {
        for (const std::uint32_t slot : slots_) search_->remove(first_slot_ + slot);
        for (auto* list : {&slots_, &object_of_slot_, &free_slots_, &left_slots_}) list->clear();
        splits_.clear();
    }

    /// Cuts divided boxes into grids of `pieces_`: the first takes the id of its object, the others those of slots.
    void make_pieces(std::span<const box> boxes, double longest) {
        pieces_.assign(boxes.begin(), boxes.end());
        pieces_.resize(boxes.size() + object_of_slot_.size(), box{});
        auto slot = slots_.begin();
        for (const auto& [object, pieces] : splits_) {
            const box& whole = boxes[object];
            std::array<cut_interval, 3> cuts;
            for (int k = 0; k < 3; ++k) cuts[static_cast<std::size_t>(k)] = cut(whole.min[k], whole.max[k], longest);
            for (std::size_t x = 0; x < pieces[0]; ++x)
                for (std::size_t y = 0; y < pieces[1]; ++y)
                    for (std::size_t z = 0; z < pieces[2]; ++z)
                        pieces_[x + y + z == 0 ? object : first_slot_ + *slot++] = {
                            {cuts[0].at[x], cuts[1].at[y], cuts[2].at[z]},
                            {cuts[0].at[x + 1], cuts[1].at[y + 1], cuts[2].at[z + 1]}};
        }
    }

    /// Whether this pair of overlapping pieces is the one that reports its objects. It is the one whose pieces both
    /// contain the lower corner of the objects' overlap (the reference point method of Dittrich and Seeger, "Data
    /// redundancy and duplicate detection in spatial join processing", 2000). Only one does, since pieces count as open
    /// at their upper ends, except for the last ones.
    [[nodiscard]] bool owns_pair(std::uint32_t piece_a, std::uint32_t piece_b) const {
        const std::uint32_t a = object_of(piece_a);
        const std::uint32_t b = object_of(piece_b);
        if (a == b) return false;
        for (int k = 0; k < 3; ++k) {
            const float reference = std::max(boxes_[a].min[k], boxes_[b].min[k]);
            for (const auto& [piece, object] : {std::pair{piece_a, a}, std::pair{piece_b, b}}) {
                const bool is_last = pieces_[piece].max[k] == boxes_[object].max[k];
                if (pieces_[piece].min[k] > reference) return false;
                if (!is_last && pieces_[piece].max[k] <= reference) return false;
            }
        }
        return true;
    }

    [[nodiscard]] std::uint32_t object_of(std::uint32_t piece) const {
        return piece < first_slot_ ? piece : object_of_slot_[piece - first_slot_];
    }

    std::unique_ptr<global_stage> search_;
    double size_;
    instrumentation counted_;
    std::uint64_t pieces_counted_ = 0;
    membership objects_;
    frame_state frame_;
    std::span<const box> boxes_;
    std::uint32_t first_slot_ = 0;      // smaller ids are objects or their first pieces; larger ones are slots
    std::vector<split> splits_;         // sorted by object
    std::vector<std::uint32_t> slots_;  // slots of the further pieces, split after split
    std::vector<split> splits_now_;     // splits of the current frame, while they are matched with the known ones
    std::vector<std::uint32_t> slots_now_;
    std::vector<std::uint32_t> object_of_slot_;
    std::vector<std::uint32_t> free_slots_;
    std::vector<std::uint32_t> left_slots_;  // freed in this frame; reused only after the search has removed them
    std::vector<box> pieces_;                // the boxes of the inner search
    std::vector<index_pair> piece_pairs_;
};

}  // namespace

std::unique_ptr<global_stage> split_large_prepare::before(std::unique_ptr<global_stage> search,
                                                          instrumentation counted) const {
    return std::make_unique<split_large_stage>(std::move(search), config_.size, counted);
}

}  // namespace aabb
