module;
#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

export module aabb.prepare.split_large;

import aabb.base;
import aabb.counters;
import aabb.geometry;
import aabb.global_search;
import aabb.pipeline;

export namespace aabb {

/// "off", or how many times the mean extent is the longest that is not split.
/// @throws input_error on anything else.
[[nodiscard]] std::optional<double> parse_split_large(std::string_view text);

/// The paper's pre-processing (section 2): "if a few objects are very large" each is divided into smaller ones. Stands
/// before a global search, which sees pieces; pairs of pieces are mapped back to pairs of objects.
///
/// On each axis on which a box is longer than `size` times the mean extent of all boxes it is cut into equal pieces no
/// longer than that (by more than a hundredth, so that rounding splits nothing), 16 at most. Pieces keep their ids from
/// frame to frame, and with them their places in sorted lists. They are closed and share their faces, so boxes overlap
/// exactly when some pieces do. Of those that do, one pair of pieces holds the corner of greater lower ends, half-open,
/// and only that one counts: no set is needed to find duplicates. A frame in which nothing is split goes to the search
/// as it is.
class split_large_stage final : public global_stage {
public:
    split_large_stage(std::unique_ptr<global_stage> search, double size, instrumentation counted);

    void insert(std::uint32_t id) override;
    void remove(std::uint32_t id) override;
    void update(std::span<const box> boxes) override;
    void search(std::vector<index_pair>& pairs) override;
    [[nodiscard]] work_counters counters() const override;
    [[nodiscard]] std::vector<part_bytes> bytes() const override;
    [[nodiscard]] std::vector<std::string> left_out() const override;

private:
    static constexpr std::size_t most_pieces = 16;  // on an axis
    /// Where the pieces of an interval begin, and the last one's end.
    struct cut_interval {
        std::size_t pieces;
        std::array<float, most_pieces + 1> at;
    };
    /// An object that is split, and into how many pieces on each axis.
    struct split {
        std::uint32_t object;
        std::array<std::uint8_t, 3> pieces;

        /// Beside the first, which has the object's own id.
        [[nodiscard]] std::size_t further_pieces() const { return std::size_t{pieces[0]} * pieces[1] * pieces[2] - 1; }
        friend bool operator==(const split&, const split&) = default;
    };

    [[nodiscard]] double longest_whole(std::span<const box> boxes) const;
    [[nodiscard]] static cut_interval cut(float lower, float upper, double longest);
    void find_splits(std::span<const box> boxes, double longest);
    void assign_slots();
    [[nodiscard]] std::uint32_t take_slot();
    void drop_pieces();
    void make_pieces(std::span<const box> boxes, double longest);
    /// Of two boxes of the search.
    [[nodiscard]] bool counts(std::uint32_t piece_a, std::uint32_t piece_b) const;
    [[nodiscard]] std::uint32_t object_of(std::uint32_t piece) const;

    std::unique_ptr<global_stage> search_;
    double size_;
    instrumentation counted_;
    std::uint64_t pieces_counted_ = 0;
    membership objects_;
    frame_state frame_;
    std::span<const box> boxes_;
    std::uint32_t first_slot_ = 0;      // ids below are objects, or the first pieces of objects; the others are slots
    std::vector<split> splits_;         // by object
    std::vector<std::uint32_t> slots_;  // of the further pieces, split after split
    std::vector<split> splits_now_;     // both, while they are found
    std::vector<std::uint32_t> slots_now_;
    std::vector<std::uint32_t> object_of_slot_;
    std::vector<std::uint32_t> free_slots_;
    std::vector<std::uint32_t> left_slots_;  // in this frame: the search must see them gone before others take them
    std::vector<box> pieces_;                // what the search sees
    std::vector<index_pair> found_;
};

}  // namespace aabb
