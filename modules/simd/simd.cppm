/// As many numbers at a time as a register of this processor takes.
export module aabb.simd;

export import :eights;
export import :lanes;
export import :width;
