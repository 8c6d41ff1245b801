/// Classes of wrong pairs of triangles.
module aabblab.checking:triangle_classes;

import aabb.std;
import aabblab.checking;

namespace aabblab {

/// A mesh at a pose, with its name in reports: "A", "object 3".
struct posed_surface {
    const aabb::mesh& mesh;
    const aabb::pose& pose;
    std::string name;
};

/// Classifies wrong pairs, and keeps the first of them with their triangles.
class triangle_classes {
public:
    /// @param within if the list is of triangles that are near each other
    /// @param touching whether pairs count that only touch
    triangle_classes(const std::optional<nearness>& within, bool touching);

    void add(wrong_pair wrong, const posed_surface& a, const posed_surface& b);
    /// Counts a contact of objects that the filter leaves out.
    void add_left_out(wrong_pair wrong);
    /// Adds classes, first pairs, and what all wrong pairs have in common.
    void add_to(check_result& result) const;
    /// The time that classes took, whose arithmetic is exact.
    [[nodiscard]] double ms() const { return ms_; }

private:
    [[nodiscard]] bool is_beyond_most();
    void count(std::size_t kind, const wrong_pair& wrong);
    void show(wrong_pair wrong);

    std::optional<nearness> within_;
    bool touching_;
    std::vector<class_counts> counts_;
    std::vector<wrong_pair> first_;
    std::uint64_t wrong_pairs_ = 0;
    double ms_ = 0;
};

}  // namespace aabblab
