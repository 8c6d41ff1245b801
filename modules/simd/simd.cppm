/// Vectors of the width of this processor's registers, and vectors of eight.
export module aabb.simd;

export import :eights;
export import :lanes;
export import :width;
