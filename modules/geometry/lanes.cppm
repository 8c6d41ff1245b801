/// Three numbers at a time, in whatever vectors the processor has.
export module aabb.geometry:lanes;

import aabb.std;
import :triangle;
import :vec3;

export namespace aabb {

/// Three numbers, and a copy of the last one that does not count.
template <class Real>
using lanes = Real __attribute__((vector_size(4 * sizeof(Real))));

/// The coordinates of a point.
template <class Real>
[[nodiscard]] inline lanes<Real> coordinates(const vec3<Real>& p) noexcept {
    return lanes<Real>{p[0], p[1], p[2], p[2]};
}

/// One coordinate of all corners.
template <class Real>
[[nodiscard]] inline lanes<Real> corners_along(const triangle3<Real>& t, int axis) noexcept {
    return lanes<Real>{t[0][axis], t[1][axis], t[2][axis], t[2][axis]};
}

/// Of a comparison of lanes: bit i is set where it holds in lane i.
template <class Mask>
[[nodiscard]] inline unsigned bits(const Mask& mask) noexcept {
    using flags = bool __attribute__((ext_vector_type(4)));
    return __builtin_bit_cast(std::uint8_t, __builtin_convertvector(mask, flags)) & 7U;
}

}  // namespace aabb
