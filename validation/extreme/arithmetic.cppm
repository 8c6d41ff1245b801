export module aabb.extreme:arithmetic;

import aabb.std;

export namespace aabb {

/// What a thread computes in.
enum class arithmetic : std::uint8_t {
    ieee,               ///< that of IEEE 754, rounding to nearest
    denormals_flushed,  ///< denormal numbers count as zero, as a library linked with -ffast-math leaves a thread
    rounded_upward,
};

/// Whether this processor can flush denormals in a way that is known here.
[[nodiscard]] bool can_flush_denormals() noexcept;

/// Does the work in a thread of its own that computes so; what it throws is thrown here.
void in_arithmetic(arithmetic kind, const std::function<void()>& work);

}  // namespace aabb
