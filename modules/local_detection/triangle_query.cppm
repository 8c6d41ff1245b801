export module aabb.local_detection:triangle_query;

import aabb.std;
import :model;

export namespace aabb {

/// The triangle test of one query. An exact test decides on the triangles of meshes that move against each other at
/// their poses (`PosedTrianglePolicy`); all others decide on A's triangle and the image of B's in A's frame.
template <TreePolicy Tree, TrianglePolicy Triangle>
class triangle_query {
public:
    /// @param poses empty for one mesh; all arguments must outlive this object
    triangle_query(const Triangle& test, const model<Tree>& a, const model<Tree>& b,
                   const std::optional<pose_pair>& poses, const relative_pose& to_a)
        : test_(test), a_(a), b_(b) {
        if (!PosedTrianglePolicy<Triangle> || !poses || !to_a.moves()) return;
        poses_ = &*poses;
        image_error_ = to_a.image_error();
    }

    /// @param pair_of returns the indices of the triangles; called only if the test needs them
    /// @param s,t the triangles in A's frame, that of B rounded to float
    template <class PairOf>
    [[nodiscard]] inline bool intersects(const PairOf& pair_of, const triangle3f& s, const triangle3f& t) const {
        if constexpr (requires { test_.intersects_if_certain(s, t, image_error_); })
            if (poses_)
                if (const std::optional<bool> known = test_.intersects_if_certain(s, t, image_error_)) return *known;
        return intersects_unfiltered(pair_of, s, t);
    }

    /// The same for pairs that a filter has left undecided.
    template <class PairOf>
    [[nodiscard]] inline bool intersects_unfiltered(const PairOf& pair_of, const triangle3f& s,
                                                    const triangle3f& t) const {
        if constexpr (PosedTrianglePolicy<Triangle>)
            if (poses_) {
                const index_pair pair = pair_of();
                return test_.intersects(*poses_, in_double(a_.triangles().triangle(pair.a)),
                                        in_double(b_.triangles().triangle(pair.b)));
            }
        return test_.intersects(s, t);
    }

    /// The error of B's corners in A's frame, along each axis: 0 if the rounded images are what is tested.
    [[nodiscard]] const vec3f& image_error() const noexcept { return image_error_; }
    [[nodiscard]] float greatest_error() const noexcept {
        return std::max({image_error_[0], image_error_[1], image_error_[2]});
    }

private:
    const Triangle& test_;
    const model<Tree>& a_;
    const model<Tree>& b_;
    const pose_pair* poses_ = nullptr;
    vec3f image_error_{};
};

}  // namespace aabb
