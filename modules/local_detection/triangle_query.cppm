export module aabb.local_detection:triangle_query;

import aabb.std;
import :model;

export namespace aabb {

/// The triangle test of one query. An exact test decides on the triangles as they are given, at their poses if these
/// differ (`PosedTrianglePolicy`); all others decide on floats in A's frame.
template <TreePolicy Tree, TrianglePolicy Triangle>
class triangle_query {
public:
    /// @param poses equal for one mesh; all arguments must outlive this object
    triangle_query(const Triangle& test, const model<Tree>& a, const model<Tree>& b, const pose_pair& poses,
                   const relative_pose& to_a)
        : test_(test), poses_(poses), a_(a), b_(b) {
        if constexpr (PosedTrianglePolicy<Triangle>) image_error_ = to_a.image_error();
        floats_are_exact_ = greatest_error() == 0;
        are_posed_ = poses.a != poses.b;
    }

    /// @param pair_of returns the indices of the triangles; called only if the test needs them
    /// @param s,t the triangles in A's frame, that of B rounded to float
    template <class PairOf>
    [[nodiscard]] inline bool intersects(const PairOf& pair_of, const triangle3f& s, const triangle3f& t) const {
        if constexpr (requires { test_.intersects_if_certain(s, t, image_error_); })
            if (!floats_are_exact_)
                if (const std::optional<bool> known = test_.intersects_if_certain(s, t, image_error_)) return *known;
        return intersects_unfiltered(pair_of, s, t);
    }

    /// Decides whether two triangles intersect, without the floating-point filter. If their floats in A's frame are
    /// rounded, an exact test uses the vertices and poses as the user gave them; another test uses the floats.
    /// @param pair_of returns the indices of the triangles; called only if the test needs them
    /// @param s,t the triangles in A's frame, that of B rounded to float
    template <class PairOf>
    [[nodiscard]] inline bool intersects_unfiltered(const PairOf& pair_of, const triangle3f& s,
                                                    const triangle3f& t) const {
        if constexpr (PosedTrianglePolicy<Triangle>)
            if (!floats_are_exact_) {
                const index_pair pair = pair_of();
                const triangle3d given_s = a_.triangles().given_triangle(pair.a);
                const triangle3d given_t = b_.triangles().given_triangle(pair.b);
                // Equal poses are one invertible map of both triangles, which keeps whether they intersect.
                return are_posed_ ? test_.intersects(poses_, given_s, given_t) : test_.intersects(given_s, given_t);
            }
        return test_.intersects(s, t);
    }

    /// The error of corners in A's frame, along each axis: 0 if the floats are what is tested.
    [[nodiscard]] const vec3f& image_error() const noexcept { return image_error_; }
    [[nodiscard]] float greatest_error() const noexcept {
        return std::max({image_error_[0], image_error_[1], image_error_[2]});
    }

private:
    const Triangle& test_;
    const pose_pair& poses_;
    const model<Tree>& a_;
    const model<Tree>& b_;
    vec3f image_error_{};
    bool floats_are_exact_ = true;
    bool are_posed_ = false;
};

}  // namespace aabb
