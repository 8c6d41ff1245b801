/// Classes of wrong pairs of boxes, and what all of them have in common.
module aabblab.checking:box_classes;

import :comparison;
import aabb.collision_filter;
import aabb.std;
import aabblab.checking;

namespace aabblab {

/// The boxes of a frame; those in double are empty if the scene has floats.
struct frame_boxes {
    std::span<const aabb::box> in_float;
    std::span<const aabb::boxd> in_double;
};

/// How two boxes lie.
struct box_gap {
    int axis = 0;                                           ///< on which they overlap least, or have the greatest gap
    double gap = -std::numeric_limits<double>::infinity();  ///< on this axis; negative if they overlap
    double greatest = 0;                                    ///< coordinate on this axis, without its sign
    unsigned axes = 0;                                      ///< with a gap, a bit each
    double distance = 0;                                    ///< Euclidean, rounded
};

/// Classifies wrong pairs, keeps the first of them, and collects what they have in common.
class box_classes {
public:
    /// @param within if the list is of boxes that are near each other
    /// @param filter leaves out pairs; null for none
    box_classes(const std::optional<nearness>& within, const aabb::collision_filter* filter);

    /// Counts the wrong pairs of a frame.
    void add(const frame_errors& errors, const frame_boxes& boxes);
    /// Adds classes and first pairs.
    void add_to(check_result& result) const;
    /// What all wrong pairs have in common, as far as their boxes show it.
    [[nodiscard]] std::vector<std::string> sentences() const;

private:
    /// A pair that is described at the end.
    struct first_pair {
        wrong_pair wrong;
        std::variant<std::array<aabb::box, 2>, std::array<aabb::boxd, 2>> boxes;
    };

    template <class Box>
    void count(const frame_errors& errors, std::span<const Box> boxes);
    template <class Box>
    void count_false_negative(const Box& a, const Box& b);
    template <class Box>
    void count_false_positive(const Box& a, const Box& b);
    template <class Box>
    void count_false_negatives(std::span<const aabb::index_pair> pairs, std::span<const Box> boxes);
    template <class Box>
    void count_false_positives(std::span<const aabb::index_pair> pairs, std::span<const Box> boxes);
    template <class Box>
    void keep(const frame_errors& errors, std::span<const Box> boxes);
    template <class Box>
    [[nodiscard]] std::string description(const Box& a, const Box& b) const;
    [[nodiscard]] double distance_of(const box_gap& g) const;
    template <class Real>
    [[nodiscard]] std::size_t class_of(const box_gap& g) const;
    [[nodiscard]] bool is_left_out(aabb::index_pair pair) const;
    void narrow_common(std::span<const aabb::index_pair> pairs);
    [[nodiscard]] std::string sentence_about_rounding() const;
    [[nodiscard]] std::string sentence_about_gaps() const;
    [[nodiscard]] std::string sentence_about_distances() const;

    std::optional<nearness> within_;
    const aabb::collision_filter* filter_;
    std::vector<class_counts> counts_;
    std::vector<first_pair> first_;
    std::uint64_t false_negatives_ = 0, false_positives_ = 0, left_out_ = 0;
    double greatest_gap_ = 0;       // of false positives
    unsigned all_gaps_ = 0;         // axes, a bit each, on which any false positive has a gap
    unsigned common_gaps_ = 7;      // and those on which all have one
    bool only_touching_ = true;     // false negatives
    bool only_near_ = true;         // touching, up to rounding
    bool only_at_distance_ = true;  // false negatives: at D, up to rounding
    bool is_of_floats_ = true;      // the scene is of doubles, and the list right for boxes rounded to float
    bool is_of_other_metric_ = true;
    std::optional<std::vector<std::uint32_t>> common_;  // objects of all wrong pairs
};

}  // namespace aabblab
