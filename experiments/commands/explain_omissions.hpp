#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <vector>

import aabb.registry;
import aabblab.play;
import aabblab.race;
import aabblab.results;
import aabblab.scenes;

namespace aabblab {

/// So that buffers have grown and what is kept between frames is there.
inline constexpr std::size_t explained_frames = 2;

/// What a contender does without in the scene it has begun to play, sentence by sentence; a reason follows a colon.
[[nodiscard]] std::vector<std::string> omissions_of(const contender_name& who, const player& playing);

/// A way of playing the scene, played in the same rounds as the others.
struct other_way {
    std::string name;
    contender who;
    std::vector<race_time> times;
};

/// Compositions that have what others leave out for their settings' sake, not for a strategy's.
[[nodiscard]] std::vector<other_way> ways_by_settings(const aabb::composition& selected, bool meshes);

/// Prints a line for all that the first one, which is selected, leaves out: which of the others has it and takes the
/// least time, and what it takes more.
void print_omissions(const scene_choice& scene, std::span<const other_way> all);

}  // namespace aabblab
