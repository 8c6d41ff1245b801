module;
#include <Eigen/Geometry>

/// Rotations and poses in double precision for scenes of meshes. Products of quaternions, and of matrices and vectors,
/// are written out, since the rounding of Eigen's depends on the processor.
module aabblab.scenes:posed_meshes;

import aabb.eigen;
import aabb.pipeline;
import :parameters;
import :random;

namespace aabblab {

[[nodiscard]] inline double square_of(const Eigen::Quaterniond& q) {
    return q.w() * q.w() + q.x() * q.x() + q.y() * q.y() + q.z() * q.z();
}

[[nodiscard]] inline Eigen::Quaterniond normalised(const Eigen::Quaterniond& q) {
    return Eigen::Quaterniond(q.coeffs() / std::sqrt(square_of(q)));
}

/// The rotation p followed by q.
[[nodiscard]] inline Eigen::Quaterniond composed(const Eigen::Quaterniond& q, const Eigen::Quaterniond& p) {
    return normalised({q.w() * p.w() - q.x() * p.x() - q.y() * p.y() - q.z() * p.z(),
                       q.w() * p.x() + q.x() * p.w() + q.y() * p.z() - q.z() * p.y(),
                       q.w() * p.y() - q.x() * p.z() + q.y() * p.w() + q.z() * p.x(),
                       q.w() * p.z() + q.x() * p.y() - q.y() * p.x() + q.z() * p.w()});
}

/// A rotation about a unit axis by 2 atan(angle / 2), which is about `angle` radians; it avoids the sine.
[[nodiscard]] inline Eigen::Quaterniond turn(const Eigen::Vector3d& axis, double angle) {
    const double t = angle / 2;
    return normalised({1, t * axis[0], t * axis[1], t * axis[2]});
}

/// A rotation from the uniform distribution.
[[nodiscard]] inline Eigen::Quaterniond random_rotation(random_source& random) {
    while (true) {
        const Eigen::Quaterniond q{random.signed_unit(), random.signed_unit(), random.signed_unit(),
                                   random.signed_unit()};
        if (square_of(q) <= 1 && square_of(q) > 1e-6) return normalised(q);
    }
}

/// The pose that rotates a mesh about its centre, given in its local frame, and moves the centre to `place`.
[[nodiscard]] inline aabb::pose placed(const Eigen::Vector3d& centre, const Eigen::Quaterniond& q,
                                       const Eigen::Vector3d& place) {
    const Eigen::Matrix3d r = q.toRotationMatrix();
    Eigen::Isometry3d at;
    at.linear() = r;
    at.translation() = place - product(r, centre);
    return aabb::to_pose(at);
}

/// The centre of the mesh's box, in the coordinates of the mesh.
[[nodiscard]] inline Eigen::Vector3d centre_of(const aabb::mesh& m) {
    const aabb::box b = aabb::bounds_of(m);
    const Eigen::Vector3d centre = (in_eigen(b.min) + in_eigen(b.max)) / 2;
    return in_eigen(m.frame.vertex({centre[0], centre[1], centre[2]}));
}

/// The longest extent of the mesh's box.
[[nodiscard]] inline double longest_extent(const aabb::mesh& m) {
    const aabb::box b = aabb::bounds_of(m);
    const int k = aabb::longest_axis(b);
    return m.frame.scale * (double{b.max[k]} - double{b.min[k]});
}

/// Moves each vertex, as given, perhaps in double, to its image, rounded to float once; given vertices are dropped.
inline void set_floats(aabb::mesh& m, const auto& image_of) {
    for (std::size_t v = 0; v < m.vertices.size(); ++v) {
        Eigen::Vector3d image = image_of(in_eigen(m.given_vertex(v)));
        // A vertex that no triangle uses may lie anywhere, but must stay finite.
        for (double& x : image) x = std::fmin(std::fmax(x, -0x1p127), 0x1p127);
        m.vertices[v] = in_float(image);
    }
    m.given.clear();
    m.frame = {};
}

/// Centres a mesh at the origin and scales it to a longest extent; each vertex is rounded to float once.
inline void normalise(aabb::mesh& m, double wanted_extent = 1) {
    const Eigen::Vector3d centre = centre_of(m);
    const double extent = longest_extent(m);
    if (extent == 0) return;
    set_floats(m, [&](const Eigen::Vector3d& v) -> Eigen::Vector3d { return (v - centre) / extent * wanted_extent; });
}

/// A scene of meshes whose poses are generated frame by frame.
class generated_meshes : public aabb::mesh_scene {
public:
    [[nodiscard]] std::size_t frames() const final { return frames_; }

    bool next(std::vector<aabb::pose>& poses) final {
        if (frames_run_ == frames_) return false;
        if (frames_run_ > 0) advance();
        place(frames_run_, poses);
        ++frames_run_;
        return true;
    }

protected:
    /// @param frames after the first one
    generated_meshes(std::uint32_t frames, std::vector<aabb::mesh> models, scaling scaled)
        : frames_(std::size_t{frames} + 1) {
        meshes = std::move(models);
        if (scaled == scaling::yes)
            for (aabb::mesh& m : meshes) normalise(m);
    }

    virtual void advance() = 0;
    virtual void place(std::size_t frame, std::vector<aabb::pose>& poses) = 0;
    [[nodiscard]] std::size_t frames_run() const { return frames_run_; }

private:
    std::size_t frames_;
    std::size_t frames_run_ = 0;
};

}  // namespace aabblab
