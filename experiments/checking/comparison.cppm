/// Compares a list with the ground truth, frame by frame.
module aabblab.checking:comparison;

import :explanation;
import :pair_order;
import aabb.std;
import aabblab.checking;

namespace aabblab {

/// The wrong pairs of a frame, sorted.
struct frame_errors {
    std::uint32_t frame;
    std::span<const aabb::index_pair> false_negatives, false_positives;

    /// Passes each pair with whether it is listed, in ascending order, until `take` returns false.
    template <class Take>
    void each(Take take) const {
        auto lost = false_negatives.begin();
        auto listed = false_positives.begin();
        while (lost != false_negatives.end() || listed != false_positives.end()) {
            const bool is_listed =
                lost == false_negatives.end() || (listed != false_positives.end() && *listed < *lost);
            if (!take(is_listed ? *listed++ : *lost++, is_listed)) return;
        }
    }
};

class list_comparison {
public:
    /// Receives the wrong pairs of each frame that has some.
    using observer = std::function<void(const frame_errors&)>;

    /// @param list must outlive this object
    list_comparison(const pair_list& list, const list_extent& of);

    /// Compares a frame; all frames must be compared in order.
    /// @param truth sorted, without repetitions; with a < b if symmetric
    void compare(std::span<const aabb::index_pair> truth, const observer& on_errors);
    /// Whether the frames so far are right.
    [[nodiscard]] bool is_right() const { return result_.is_right(); }
    /// The result, after the last frame; without classes.
    /// @param common what wrong pairs have in common, reported unless a reason explains the whole list
    [[nodiscard]] check_result result(std::vector<std::string> common) const;

private:
    [[nodiscard]] aabb::index_pair pair_of(const listed_pair& row) const;
    [[nodiscard]] bool are_pairs(std::span<const aabb::index_pair> rows) const;
    void take_frame();
    [[nodiscard]] frame_errors find_errors(std::span<const aabb::index_pair> truth);

    list_extent of_;
    std::span<const listed_pair> list_;
    bool is_by_frame_;                     // whether the list is in the order of frames
    std::vector<aabb::index_pair> pairs_;  // of this frame; by frame if the list is in another order
    std::vector<std::size_t> begins_;      // of each frame in the ordered list, and their end
    check_result result_;
    list_explanation explanation_;
    pair_sorter sorter_;
    std::uint32_t frame_ = 0;
    std::span<aabb::index_pair> rows_;                                 // of this frame, sorted
    std::span<const aabb::index_pair> listed_;                         // those that the scene can have, each once
    std::vector<aabb::index_pair> accepted_;                           // the same, if not all rows are
    std::vector<aabb::index_pair> false_negatives_, false_positives_;  // begin with those of this frame
};

}  // namespace aabblab
