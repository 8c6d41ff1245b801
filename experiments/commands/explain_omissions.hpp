#pragma once

import aabb.pipeline;
import aabb.registry;
import aabb.std;
import aabblab.trials;
import aabblab.race;
import aabblab.results;

namespace aabblab {

/// What a contender does without, by its stages and by its strategies.
/// @param by_stages what its stages say of themselves
[[nodiscard]] std::vector<aabb::omission> omissions_of(const contender_name& who,
                                                       std::vector<aabb::omission> by_stages);

/// A way of playing the scene, played in the same rounds as the others.
struct other_way {
    std::string kind;  ///< in which it differs from what is selected; empty where it does not
    std::string name;  ///< of what stands in its place
    contender who;
    std::vector<observation> times;     ///< none where no play came to its end
    std::optional<attempt> broken_off;  ///< its first play, where that did not
    bool is_hopeless;                   ///< it takes far longer than what is selected
};

/// Compositions that have what the selected one leaves out for the sake of this kind's settings, not of its strategy.
[[nodiscard]] std::vector<other_way> ways_by_settings(const aabb::composition& selected, aabb::strategy_kind kind,
                                                      bool meshes);

/// What it is called where its kind does not stand beside it.
[[nodiscard]] std::string called(const other_way& one);

/// Prints a line for all that the first one, which is selected, leaves out: which of the others has it and takes the
/// least time, and what it takes more.
void print_omissions(std::span<const other_way> all);

}  // namespace aabblab
