/// Compares a list with the ground truth, frame by frame, and finds out what its errors have in common.
module aabblab.checking:comparison;

import aabb.std;
import aabblab.checking;

namespace aabblab {

class list_comparison {
public:
    struct extent {
        std::size_t frames;
        std::size_t ids_a, ids_b;  ///< ids of a and of b are less
        bool is_symmetric;         ///< whether a and b may be exchanged, and must differ
    };
    /// Receives each wrong pair.
    using observer = std::function<void(const wrong_pair&)>;

    list_comparison(pair_list list, const extent& of);

    /// Compares a frame; all frames must be compared in order.
    /// @param truth sorted, without repetitions; with a < b if symmetric
    void compare(std::span<const aabb::index_pair> truth, const observer& on_wrong_pair);
    /// The result, after the last frame; without classes.
    /// @param common what wrong pairs have in common, reported unless a reason explains the whole list
    [[nodiscard]] check_result result(std::vector<std::string> common) const;

private:
    /// A way in which a whole list can be wrong, and whether it explains all frames so far.
    struct hypothesis {
        bool holds = true;
        std::uint32_t frames = 0;  ///< wrong frames that it explains
    };

    [[nodiscard]] std::string reason() const;
    void take_frame();
    void test_hypotheses(std::span<const aabb::index_pair> truth, bool is_wrong);

    extent of_;
    std::vector<aabb::index_pair> pairs_;  // by frame, in the order of the list
    std::vector<std::size_t> begins_;      // of each frame in `pairs_`, and their end
    check_result result_;
    std::uint32_t frame_ = 0;
    std::span<aabb::index_pair> rows_;        // of this frame, sorted
    std::vector<aabb::index_pair> listed_;    // of this frame, those that the scene can have, each once
    std::vector<aabb::index_pair> previous_;  // the ground truth of the previous frame
    std::vector<aabb::index_pair> repeated_;  // the list of the previous frame
    hypothesis from_one_, from_minus_one_, exchanged_, late_, constant_;
    bool has_early_rows_ = false;         // in frame 0
    std::uint32_t last_listed_ = 0;       // the last frame with rows
    std::uint64_t truth_after_last_ = 0;  // pairs of the ground truth in later frames
};

}  // namespace aabblab
