export module aabb.geometry:pose;

import aabb.std;
import :box;
import :predicates;
import :vertex_frame;

#pragma clang fp contract(off) reassociate(off) reciprocal(off)  // see aabb.base:floating_point

export namespace aabb {

/// An affine map x -> R x + t in double, by default a rigid motion; `rotation` is row-major.
struct pose {
    std::array<double, 9> rotation = {1, 0, 0, 0, 1, 0, 0, 0, 1};
    vec3d translation = {0, 0, 0};

    friend bool operator==(const pose&, const pose&) = default;
};

/// max |(R Rᵀ - I)[i][j]|, 0 for an exact rotation.
[[nodiscard]] inline double orthonormality_error(const pose& p) noexcept {
    double worst = 0;
    for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j) {
            double sum = i == j ? -1.0 : 0.0;
            for (int k = 0; k < 3; ++k) sum += p.rotation[3 * i + k] * p.rotation[3 * j + k];
            worst = std::max(worst, std::isnan(sum) ? std::numeric_limits<double>::infinity() : std::abs(sum));
        }
    return worst;
}

/// The sign of det R, exactly.
[[nodiscard]] inline int determinant_sign(const pose& p) noexcept {
    const auto row = [&](std::size_t i) {
        return vec3d{p.rotation[3 * i], p.rotation[3 * i + 1], p.rotation[3 * i + 2]};
    };
    return exact_side({0, 0, 0}, row(0), row(1), row(2));
}

/// Whether R is orthonormal within 1e-6, and no reflection.
[[nodiscard]] inline bool is_rigid(const pose& p) noexcept {
    return orthonormality_error(p) <= 1e-6 && determinant_sign(p) > 0;
}

/// Rejects poses that are no affine maps of full rank.
/// @throws input_error with the fault
inline void require_full_rank(const pose& p) {
    if (!std::ranges::all_of(p.rotation, [](double r) { return std::isfinite(r); }))
        throw input_error("the pose has a matrix with an entry that is not finite");
    for (const double t : p.translation.at)
        if (!std::isfinite(t)) throw input_error("the pose has a translation that is not finite");
    if (determinant_sign(p) == 0) throw input_error("the pose is singular: the determinant of its matrix is 0");
}

/// A motion x -> Σ columns[j] x[j] + shift of boxes, whose bounds must be moved outward by the margin.
struct box_motion {
    std::array<vec3d, 3> columns;
    vec3d shift;
    vec3d margin;
    vec3d image_error;  ///< as `relative_pose::image_error`
};

/// A bound on the distance between a vertex's image in float and its true image.
[[nodiscard]] inline double rounding_bound(const box_motion& p) noexcept {
    return (p.image_error[0] + p.image_error[1] + p.image_error[2]) * (1 + 0x1p-50);
}

/// A bound on the distance between the rounded images of a vertex under two poses (`relative_pose::to_boxes`), and so
/// between those of any point of a triangle.
/// @param bounds box of the vertices
[[nodiscard]] inline double displacement_bound(const box_motion& p, const box_motion& q, const box& bounds) noexcept {
    const auto length = [](const vec3d& v) { return std::sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]); };
    // A point is the centre of the box, plus on each axis at most half of its extent.
    vec3d between{};
    double distance = rounding_bound(p) + rounding_bound(q);
    for (int k = 0; k < 3; ++k) between[k] = p.shift[k] - q.shift[k];
    for (int j = 0; j < 3; ++j) {
        const double centre = (double{bounds.min[j]} + double{bounds.max[j]}) / 2;
        vec3d turned{};
        for (int k = 0; k < 3; ++k) {
            turned[k] = p.columns[static_cast<std::size_t>(j)][k] - q.columns[static_cast<std::size_t>(j)][k];
            between[k] += turned[k] * centre;
        }
        distance += length(turned) * (double{bounds.max[j]} - double{bounds.min[j]}) / 2;
    }
    return distance + length(between);
}

/// Transforms vertices and boxes of mesh B into the frame of mesh A: y = Rᴬ⁻¹(Rᴮ x + (tᴮ - tᴬ)).
///
/// Exact tests decide on the true images, in real arithmetic; here these are rounded, with bounds of the error. Other
/// tests get the images as they are: in double, each sum left to right without fused multiply-add, rounded to float
/// once. Translations are subtracted first, so that two meshes of floats moved together keep their images bit for bit,
/// as long as tᴮ - tᴬ does not change. Under equal poses and frames, the images are the vertices.
///
/// With floats x of a vertex frame, a vertex is o + s x: R becomes s R, and t becomes t + R o.
class relative_pose {
public:
    /// The motion from the frame of mesh B at pose b to that of mesh A at pose a, of full rank (`require_full_rank`).
    /// @param bounds box of the floats of B; only boxes and vertices inside it may be transformed
    /// @param frame_a,frame_b of the meshes' floats
    /// @throws input_error if their images may exceed the range of float, or if rounding leaves no inverse of a's
    /// matrix
    relative_pose(const pose& a, const pose& b, const box& bounds, const vertex_frame& frame_a = {},
                  const vertex_frame& frame_b = {}) {
        if (a == b)
            set(pose{}, pose{}, bounds, frame_a, frame_b);
        else
            set(a, b, bounds, frame_a, frame_b);
    }

    /// False if every image is known to equal the vertex.
    [[nodiscard]] inline bool moves() const noexcept { return moves_; }

    /// Whether lengths are kept, within 2^-18 of their size.
    [[nodiscard]] inline bool is_rigid() const noexcept { return is_rigid_; }

    /// A bound on the distance, along each axis, between a vertex's image and its true image, plus that between a
    /// vertex of A and its float. Zero without motion if all vertices are floats.
    [[nodiscard]] inline const vec3f& image_error() const noexcept { return image_error_; }

    /// The image of a vertex of B, as defined above.
    [[nodiscard]] inline vec3f operator()(const vec3f& x) const noexcept {
        const lanes turned =
            (columns_b_[0] * double{x[0]} + columns_b_[1] * double{x[1]}) + columns_b_[2] * double{x[2]};
        const lanes world = turned + between_;
        return in_float((inverse_a_[0] * world[0] + inverse_a_[1] * world[1]) + inverse_a_[2] * world[2]);
    }

    [[nodiscard]] inline triangle3f operator()(const triangle3f& t) const noexcept {
        return {(*this)(t[0]), (*this)(t[1]), (*this)(t[2])};
    }

    /// The images of several vertices at once, by coordinate: leaving out an identity rotation changes no result.
    template <class Doubles>
    [[nodiscard]] inline std::array<Doubles, 3> images(const std::array<Doubles, 3>& x) const noexcept {
        std::array<Doubles, 3> world = x;
        if (turns_b_)
            for (int i = 0; i < 3; ++i)
                world[i] = (columns_b_[0][i] * x[0] + columns_b_[1][i] * x[1]) + columns_b_[2][i] * x[2];
        for (int i = 0; i < 3; ++i) world[i] += between_[i];
        if (!turns_a_) return world;
        std::array<Doubles, 3> image;
        for (int i = 0; i < 3; ++i)
            image[i] = (inverse_a_[0][i] * world[0] + inverse_a_[1][i] * world[1]) + inverse_a_[2][i] * world[2];
        return image;
    }

    /// A box in A's frame that overlaps every box of floats in which the true image of a point in `b` lies, and
    /// contains the image of every vertex in `b`. The bounds are computed in double, grown by the margin derived below
    /// and rounded to nearest: rounding is monotone and keeps floats.
    [[nodiscard]] inline box operator()(const box& b) const noexcept {
        lanes centre = shift_;
        lanes radius = margin_;
        for (int j = 0; j < 3; ++j) {
            centre += turn_[j] * ((double{b.min[j]} + double{b.max[j]}) / 2);
            radius += absolute_turn_[j] * ((double{b.max[j]} - double{b.min[j]}) / 2);
        }
        return {in_float(centre - radius), in_float(centre + radius)};
    }

    /// The motion of boxes to A's frame, with bounds to be rounded to nearest as above.
    [[nodiscard]] inline box_motion to_boxes() const noexcept {
        box_motion there;
        for (int i = 0; i < 3; ++i) {
            there.shift[i] = shift_[i];
            there.margin[i] = margin_[i];
            there.image_error[i] = image_error_[i];
            for (int j = 0; j < 3; ++j) there.columns[static_cast<std::size_t>(j)][i] = turn_[j][i];
        }
        return there;
    }

    /// The motion of A's boxes to B's frame: if a box contains a point of the image of a triangle of B, the moved box
    /// contains that point of the triangle.
    ///
    /// The inverse is the adjugate over the determinant. Each entry is within 16 u of the true inverse, and the
    /// inverted matrix within 3 u; sums of six terms round five times, so 64 u of all magnitudes covers these errors.
    /// The rest of the margin is what rounding to float and the errors of both meshes' floats add to an image.
    /// @param bounds box of A; `is_rigid` must hold
    [[nodiscard]] inline box_motion back_to_boxes(const box& bounds) const noexcept {
        const auto cross = [](const lanes& p, const lanes& q) {
            return vec3d{p[1] * q[2] - p[2] * q[1], p[2] * q[0] - p[0] * q[2], p[0] * q[1] - p[1] * q[0]};
        };
        const std::array<vec3d, 3> rows{cross(turn_[1], turn_[2]), cross(turn_[2], turn_[0]),
                                        cross(turn_[0], turn_[1])};
        double determinant = 0, magnitude = 0;
        for (int i = 0; i < 3; ++i) {
            determinant += turn_[0][i] * rows[0][i];
            magnitude +=
                std::abs(shift_[i]) + std::max(std::abs(double{bounds.min[i]}), std::abs(double{bounds.max[i]}));
        }
        box_motion back{};
        for (int i = 0; i < 3; ++i) {
            const vec3d& row = rows[static_cast<std::size_t>(i)];
            back.margin[i] = 64 * (std::numeric_limits<double>::epsilon() / 2) * magnitude + 0x1p-146;
            for (int j = 0; j < 3; ++j) {
                const double entry = row[j] / determinant;
                back.columns[static_cast<std::size_t>(j)][i] = entry;
                back.shift[i] -= entry * shift_[j];
                back.margin[i] += std::abs(entry) * 2 * (margin_[j] + image_error_[j]);
            }
        }
        return back;
    }

    /// The factor by which the box of a cube grows in the other frame, averaged over the axes: from 1 to 5/3.
    [[nodiscard]] inline double growth() const noexcept {
        const lanes sum = absolute_turn_[0] + absolute_turn_[1] + absolute_turn_[2];
        return (sum[0] + sum[1] + sum[2]) / 3;
    }

private:
    using lanes = double __attribute__((vector_size(32)));  // x, y, z and an unused lane
    static constexpr double unit = std::numeric_limits<double>::epsilon() / 2;

    /// Sets the map of images, x -> Rᴬ⁻¹ (Rᴮ x + between), as its factors and as their product, turn x + shift, for
    /// vertices and boxes, and bounds the rounding errors of both. The scales of frames are put into the matrices.
    void set(pose a, pose b, const box& bounds, const vertex_frame& frame_a, const vertex_frame& frame_b) {
        double between_error = 0;
        between_ = translation_between(a, frame_a.origin, b, frame_b.origin, between_error);
        is_rigid_ = frame_a.scale == frame_b.scale && is_near_rotation(a) && is_near_rotation(b);
        for (double& r : a.rotation) r *= frame_a.scale;
        for (double& r : b.rotation) r *= frame_b.scale;
        for (std::size_t k = 0; k < 3; ++k) columns_b_[k] = lanes{b.rotation[k], b.rotation[3 + k], b.rotation[6 + k]};
        turns_a_ = turns(a);
        turns_b_ = turns(b);
        moves_ = turns_a_ || turns_b_ || a.translation != b.translation || frame_a.origin != frame_b.origin;
        const double inverse_error = invert(a);
        // The magnitudes of the terms of an image add up to these sums, before and after the map into A's frame.
        lanes world_sum = magnitudes(between_);
        for (int j = 0; j < 3; ++j)
            world_sum +=
                magnitudes(columns_b_[j]) * std::max(std::abs(double{bounds.min[j]}), std::abs(double{bounds.max[j]}));
        lanes image_sum{}, inverse_sum{};
        for (int k = 0; k < 3; ++k) {
            image_sum += magnitudes(inverse_a_[k]) * world_sum[k];
            inverse_sum += magnitudes(inverse_a_[k]);
            shift_ += inverse_a_[k] * between_[k];
            for (int j = 0; j < 3; ++j) turn_[j] += inverse_a_[k] * columns_b_[j][k];
        }
        for (int j = 0; j < 3; ++j) absolute_turn_[j] = magnitudes(turn_[j]);
        double extent = 1;
        for (int j = 0; j < 3; ++j)
            extent += std::max(std::abs(double{bounds.min[j]}), std::abs(double{bounds.max[j]}));
        const double greatest = std::max({image_sum[0], image_sum[1], image_sum[2]});
        for (int i = 0; i < 3; ++i) {
            // An image rounds any term at most 7 times, a box at most 10 times (3 in the product of the matrices or the
            // shift, 5 to the centre or 6 to the radius with the margin, and their sum): the errors are within
            // γ_k = k u / (1 - k u) times the sum of the terms' magnitudes, and 32 u covers both. The true image
            // y = Rᴬ⁻¹ w is further from X w, by (I - X Rᴬ) y: at most ρ |y| <= ρ / (1 - ρ) |X w| < 2 ρ |X w|.
            // What underflows in the world is less than 2^-1072, before the inverse, and in the matrices' product,
            // before the vertices.
            margin_[i] =
                32 * unit * image_sum[i] + 2 * inverse_error * greatest + 0x1p-1070 * (inverse_sum[i] + extent);
            // The rounding errors of the floats of both meshes.
            double error_of_floats = frame_a.rounding[i] + inverse_sum[i] * between_error;
            for (int j = 0; j < 3; ++j) error_of_floats += absolute_turn_[j][i] * double{frame_b.rounding[j]};
            margin_[i] += error_of_floats * (1 + 0x1p-20);
        }
        const box image = (*this)(bounds);
        if (!is_valid(image)) throw input_error("seen from one mesh, the other lies beyond the range of float");
        // Rounding to float adds 2^-24 of the magnitude, or half the least denormal.
        if (moves_ || !frame_a.is_exact() || !frame_b.is_exact())
            for (int i = 0; i < 3; ++i) {
                const double largest = std::max(std::abs(double{image.min[i]}), std::abs(double{image.max[i]}));
                const double of_rounding = moves_ ? largest * 0x1p-24 : 0;
                image_error_[i] = static_cast<float>((of_rounding + margin_[i]) * (1 + 0x1p-20) + 0x1p-148);
            }
    }

    /// tᴮ + Rᴮ oᴮ - tᴬ - Rᴬ oᴬ. Around origins other than 0, the sum is computed as if in twice the precision (Ogita,
    /// Rump and Oishi, "Accurate sum and dot product", 2005): then its error is u of the result, as without origins,
    /// and at most γ²₁₆ of the terms' magnitudes.
    /// @param error set to a bound on the latter
    [[nodiscard]] static lanes translation_between(const pose& a, const vec3d& origin_a, const pose& b,
                                                   const vec3d& origin_b, double& error) noexcept {
        lanes between{};
        if (a == b && origin_a == origin_b) return between;
        for (int i = 0; i < 3; ++i) {
            between[i] = b.translation[i] - a.translation[i];
            if (origin_a == vec3d{} && origin_b == vec3d{}) continue;
            double sum = 0, rest = 0, magnitude = 0;
            const auto add = [&](double x) {
                const double total = sum + x;
                const double of_x = total - sum;
                rest += (sum - (total - of_x)) + (x - of_x);
                sum = total;
                magnitude += std::abs(x);
            };
            const auto add_product = [&](double x, double y) {
                const double product = x * y;
                add(product);
                rest += __builtin_fma(x, y, -product);
            };
            add(b.translation[i]);
            add(-a.translation[i]);
            for (int j = 0; j < 3; ++j) {
                add_product(b.rotation[static_cast<std::size_t>(3 * i + j)], origin_b[j]);
                add_product(-a.rotation[static_cast<std::size_t>(3 * i + j)], origin_a[j]);
            }
            between[i] = sum + rest;
            error = std::max(error, 256 * unit * unit * magnitude + 0x1p-1070);
        }
        return between;
    }

    /// Sets `inverse_a_` to X ≈ Rᴬ⁻¹, the adjugate over the determinant.
    /// @returns ρ, a bound on the greatest sum of magnitudes in a row of I - X Rᴬ
    [[nodiscard]] double invert(const pose& a) {
        if (!turns_a_) {
            for (int k = 0; k < 3; ++k) inverse_a_[k][k] = 1;
            return 0;
        }
        // Rows are scaled by powers of two, so that the determinant neither overflows nor underflows.
        std::array<vec3d, 3> rows{};
        std::array<int, 3> exponents{};
        for (std::size_t i = 0; i < 3; ++i) {
            const double* const r = &a.rotation[3 * i];
            static_cast<void>(std::frexp(std::max({std::abs(r[0]), std::abs(r[1]), std::abs(r[2])}), &exponents[i]));
            for (int j = 0; j < 3; ++j) rows[i][j] = std::ldexp(r[j], -exponents[i]);
        }
        const double determinant = dot(rows[0], cross(rows[1], rows[2]));
        for (std::size_t k = 0; k < 3; ++k) {
            const vec3d column = cross(rows[(k + 1) % 3], rows[(k + 2) % 3]);
            for (int i = 0; i < 3; ++i) inverse_a_[k][i] = std::ldexp(column[i] / determinant, -exponents[k]);
        }
        lanes sums{};
        for (int j = 0; j < 3; ++j) {
            lanes entry{};
            entry[j] = 1;
            lanes magnitude = entry;  // of the terms of an entry; each is rounded at most four times
            for (int k = 0; k < 3; ++k) {
                const lanes term = inverse_a_[k] * a.rotation[static_cast<std::size_t>(3 * k + j)];
                entry -= term;
                magnitude += magnitudes(term);
            }
            sums += magnitudes(entry) + 5 * unit * magnitude;
        }
        const double error = std::max({sums[0], sums[1], sums[2]});
        const bool is_finite = std::isfinite(sums[0]) && std::isfinite(sums[1]) && std::isfinite(sums[2]);
        if (!is_finite || error > 0.25) throw input_error("the pose of the first mesh is too close to a singular one");
        return error;
    }

    [[nodiscard]] static inline lanes magnitudes(const lanes& v) noexcept { return __builtin_elementwise_abs(v); }
    [[nodiscard]] static inline vec3f in_float(const lanes& v) noexcept {
        return {static_cast<float>(v[0]), static_cast<float>(v[1]), static_cast<float>(v[2])};
    }

    [[nodiscard]] static bool turns(const pose& p) noexcept { return p.rotation != pose{}.rotation; }
    [[nodiscard]] static bool is_near_rotation(const pose& p) noexcept {
        return !turns(p) || orthonormality_error(p) <= 1e-6;
    }

    // Identity rotations are skipped, since multiplying by 1 and 0 would change nothing.
    bool turns_a_ = false;
    bool turns_b_ = false;
    bool moves_ = false;
    bool is_rigid_ = false;
    std::array<lanes, 3> columns_b_{};
    std::array<lanes, 3> inverse_a_{};  // columns of X
    lanes between_{};                   // tᴮ - tᴬ
    std::array<lanes, 3> turn_{};       // columns of X Rᴮ
    std::array<lanes, 3> absolute_turn_{};
    lanes shift_{};  // X (tᴮ - tᴬ)
    lanes margin_{};
    vec3f image_error_{};
};

/// The world box of a mesh at a pose, for the broad phase: it contains every R x + t, for x in the mesh's box, up to
/// the rounding of its bounds to nearest, which is monotone, so that boxes of meshes that meet always overlap.
///
/// A bound has at most eight roundings of a term, so that 2^-48 of the magnitudes, 32 u, covers them.
/// @param frame of the floats of the mesh
[[nodiscard]] inline box world_bounds(const box& local, const pose& p, const vertex_frame& frame = {}) noexcept {
    const vec3d rounding = in_double(frame.rounding);
    const vec3d lowest = frame.vertex(in_double(local.min) - rounding);
    const vec3d highest = frame.vertex(in_double(local.max) + rounding);
    box world;
    for (int i = 0; i < 3; ++i) {
        double low = p.translation[i];
        double high = p.translation[i];
        double magnitude = std::abs(p.translation[i]);
        for (int j = 0; j < 3; ++j) {
            const double u = p.rotation[3 * i + j] * lowest[j];
            const double v = p.rotation[3 * i + j] * highest[j];
            low += std::min(u, v);
            high += std::max(u, v);
            magnitude += std::max(std::abs(u), std::abs(v)) + std::abs(p.rotation[3 * i + j] * frame.origin[j]);
        }
        const double growth = magnitude * 0x1p-48 + 0x1p-1070;
        world.min[i] = static_cast<float>(low - growth);
        world.max[i] = static_cast<float>(high + growth);
    }
    return world;
}

}  // namespace aabb
