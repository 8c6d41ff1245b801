module;
#include <cstdint>
#include <random>

/// Random numbers that are the same in every standard library, which fixes the engine but not its distributions.
module aabb.extreme:draws;

import aabb.geometry;

namespace aabb {

class draws {
public:
    explicit draws(std::uint32_t seed) : engine_(seed) {}

    /// In [low, high).
    [[nodiscard]] float between(float low, float high) {
        return low + (high - low) * (static_cast<float>(engine_() >> 8U) * 0x1p-24F);
    }
    /// In [0, count).
    [[nodiscard]] std::uint32_t below(std::uint32_t count) { return static_cast<std::uint32_t>(engine_() % count); }
    /// Each coordinate in [low, high).
    [[nodiscard]] vec3f point(float low, float high) {
        // Braces are evaluated from left to right.
        return vec3f{between(low, high), between(low, high), between(low, high)};
    }

private:
    std::mt19937 engine_;
};

}  // namespace aabb
