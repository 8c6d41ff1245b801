module;
#include <cstdint>

export module aabb.local_detection:walk_goal;

export namespace aabb {

/// What a walk is for: with `first_pair` it is stopped at the first.
enum class walk_goal : std::uint8_t { every_pair, first_pair };

}  // namespace aabb
