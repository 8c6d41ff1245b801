export module aabb.geometry:vertex_frame;

import aabb.std;
import :points;

#pragma clang fp contract(off) reassociate(off) reciprocal(off)  // see aabb.base:floating_point

export namespace aabb {

/// How the vertices of a mesh are represented by floats f: each is origin + scale · f, up to `rounding`.
struct vertex_frame {
    vec3d origin{};
    double scale = 1;  ///< a power of two
    vec3f rounding{};  ///< a bound on the error on each axis, in units of `scale`; 0 if the floats are exact

    friend bool operator==(const vertex_frame&, const vertex_frame&) = default;

    [[nodiscard]] bool is_exact() const noexcept { return rounding == vec3f{}; }

    /// The float of a vertex. Monotone on each axis, so that boxes which overlap still do as floats.
    [[nodiscard]] vec3f operator()(const vec3d& vertex) const noexcept {
        const vec3d f = unrounded(vertex);
        return {static_cast<float>(f[0]), static_cast<float>(f[1]), static_cast<float>(f[2])};
    }
    /// The vertex at f in this frame, rounded to double.
    [[nodiscard]] vec3d vertex(const vec3d& f) const noexcept {
        return {origin[0] + scale * f[0], origin[1] + scale * f[1], origin[2] + scale * f[2]};
    }

    /// The frame in which numbers of this range become floats with small errors. The origin stays 0 on axes on which
    /// the range does not lie so far off that floats would lose more than four bits, and the scale 1 unless squares or
    /// cubes of floats could leave their range. `rounding` is not set.
    [[nodiscard]] static vertex_frame around(const vec3d& low, const vec3d& high) noexcept {
        vertex_frame frame;
        double greatest = 0, farthest = 0;  // of the floats, and of the numbers
        for (int k = 0; k < 3; ++k) {
            const double half_extent = high[k] / 2 - low[k] / 2;  // halves cannot overflow
            double magnitude = std::max(std::abs(low[k]), std::abs(high[k]));
            farthest = std::max(farthest, magnitude);
            if (magnitude > 32 * half_extent) {
                frame.origin[k] = low[k] == high[k] ? low[k] : low[k] / 2 + high[k] / 2;
                magnitude = half_extent;
            }
            greatest = std::max(greatest, magnitude);
        }
        // All in one place: what lies a unit in the last place away should not leave the range of float.
        if (greatest == 0) greatest = farthest * 0x1p-53;
        const int exponent = greatest == 0 ? 0 : std::ilogb(greatest);
        // Below 2^-960, products with the entries of a matrix would underflow.
        if (std::abs(exponent) > 30) frame.scale = std::ldexp(1, std::clamp(exponent, -960, 960));
        return frame;
    }

    /// The frame of these vertices, with a bound on their errors.
    [[nodiscard]] static vertex_frame around(std::span<const vec3d> vertices) noexcept {
        if (vertices.empty()) return {};
        vec3d low = vertices.front(), high = low;
        for (const vec3d& v : vertices)
            for (int k = 0; k < 3; ++k) {
                low[k] = std::min(low[k], v[k]);
                high[k] = std::max(high[k], v[k]);
            }
        vertex_frame frame = around(low, high);
        for (const vec3d& v : vertices) {
            const vec3d f = frame.unrounded(v);
            const vec3f rounded = frame(v);
            for (int k = 0; k < 3; ++k) {
                double error = std::abs(f[k] - rounded[k]);
                // The difference from the origin is rounded, too, and a quotient by a scale above 1 may underflow.
                error += rounding_of_difference(v[k], frame.origin[k]) / frame.scale;
                if (f[k] * frame.scale != v[k] - frame.origin[k]) error += std::numeric_limits<double>::denorm_min();
                if (error > 0)
                    frame.rounding[k] = std::max(frame.rounding[k], static_cast<float>(error * (1 + 0x1p-20)) +
                                                                        std::numeric_limits<float>::denorm_min());
            }
        }
        return frame;
    }

private:
    /// The exact error of a - b in magnitude, unless that overflows (Knuth, "The art of computer programming", 4.2.2).
    [[nodiscard]] static double rounding_of_difference(double a, double b) noexcept {
        const double difference = a - b;
        const double of_b = a - difference;
        return std::abs((a - (difference + of_b)) + (of_b - b));
    }

    [[nodiscard]] vec3d unrounded(const vec3d& vertex) const noexcept {
        return {(vertex[0] - origin[0]) / scale, (vertex[1] - origin[1]) / scale, (vertex[2] - origin[2]) / scale};
    }
};

}  // namespace aabb
