/// The ways in which a whole list can be wrong: which of them explains every wrong frame.
module aabblab.checking:explanation;

import aabb.std;
import aabblab.checking;

namespace aabblab {

/// What the rows of a list may be.
struct list_extent {
    std::size_t frames;
    std::size_t ids_a, ids_b;  ///< ids of a and of b are less
    bool is_symmetric;         ///< whether a and b may be exchanged, and must differ
};

/// A frame of a list, compared with the ground truth; all of it is sorted, with a < b if symmetric.
struct compared_frame {
    std::span<const aabb::index_pair> truth;
    std::span<const aabb::index_pair> rows;    ///< all rows of the list
    std::span<const aabb::index_pair> listed;  ///< those that the scene can have, each once
    bool is_wrong;                             ///< whether these are not the ground truth
};

class list_explanation {
public:
    explicit list_explanation(const list_extent& of) : of_(of) {}

    /// Tests a frame; all frames must be added in order.
    void add(const compared_frame& frame);
    /// The reason that explains every wrong frame, in a sentence; empty if there is none.
    [[nodiscard]] std::string reason(const check_result& result) const;
    /// A sentence about errors that grow from a frame on; empty if they do not.
    [[nodiscard]] std::string growth(const check_result& result) const;
    /// A sentence about frames that have pairs, but no rows in the list; empty if there are none.
    [[nodiscard]] std::string lacking_frames() const;

private:
    /// Whether something explains all frames so far.
    struct hypothesis {
        bool holds = true;
        std::uint32_t frames = 0;  ///< wrong frames that it explains
    };

    void test_ids(const compared_frame& frame);
    void test_order(const compared_frame& frame);
    [[nodiscard]] std::string reason_of_ids(const check_result& result) const;
    [[nodiscard]] std::string reason_of_frames(const check_result& result) const;

    list_extent of_;
    std::uint32_t frame_ = 0;
    std::vector<aabb::index_pair> previous_truth_, previous_list_;  // as long as a hypothesis needs them
    hypothesis from_one_, from_minus_one_, reversed_, mirrored_, late_, constant_;
    bool is_early_ = true;
    /// Two objects whose ids may be exchanged from the first wrong frame on; empty before it.
    std::optional<std::vector<aabb::index_pair>> exchanges_;
    bool has_early_rows_ = false;         // in frame 0
    bool has_later_pairs_ = false;        // in the ground truth of a later frame
    std::uint32_t last_listed_ = 0;       // the last frame with rows
    std::uint64_t truth_after_last_ = 0;  // pairs of the ground truth in later frames
    std::vector<std::uint32_t> lacking_;  // frames that have pairs, but no rows
    std::uint64_t lacking_pairs_ = 0;
};

}  // namespace aabblab
