module;
#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

/// Plays the scenes of an experiment through every composition and engine: validates, then times.
export module aabblab.play;

import aabb.counters;
import aabb.policy;
import aabb.registry;
import aabb.selection;
import aabb.validation;
import aabblab.configs;
import aabblab.results;
import aabblab.scenes;
import aabblab.stopwatch;
export import :player;

export namespace aabblab {

/// Who plays at a place of a round, so that it matters to nobody alone after whom one plays: each begins a round, and
/// in as many rounds as there are players, if these are even, follows each other one once; else about so (Williams,
/// "Experimental designs balanced for the estimation of residual effects of treatments", 1949).
[[nodiscard]] constexpr std::size_t in_turn(std::size_t place, std::size_t round, std::size_t players) noexcept {
    // 0, 1, -1, 2, -2 and so on.
    const std::size_t apart = place % 2 == 1 ? (place + 1) / 2 : players - place / 2;
    return (round + apart) % players;
}

/// "insertion + none + one_axis + canonical + exact", "cgal".
[[nodiscard]] std::string text_of(const contender_name& name);

[[nodiscard]] contender contender_of(const aabb::composition& c, bool meshes);
/// What is selected for the scene beside what is named.
[[nodiscard]] contender contender_of(const aabb::named_strategies& named, const scene_play& scene);
/// What `auto` may know of a scene that has not begun.
[[nodiscard]] aabb::scene_outlook outlook_of(const scene_play& scene);
/// An engine that does one stage only gets the default composition for the other; empty for one that has no part in the
/// scene.
[[nodiscard]] std::optional<contender> contender_of(const aabb::engine_info& engine, bool meshes);

/// Who plays a scene of the experiment: its compositions, then its engines, then, where it is of boxes, its external
/// engines.
[[nodiscard]] std::vector<contender> contenders_for(const experiment& e, const scene_choice& scene);

/// What came out of playing a scene beside the exact answer, untimed.
struct contender_validation {
    contender_name name;
    std::string failure;  ///< the first difference where the contender must be exact, or that it took too long
    std::uint64_t candidates = 0;
    std::optional<std::uint64_t> contacts;
    std::string digest;
    std::uint64_t missing = 0;
    std::uint64_t invented = 0;
    std::optional<std::uint64_t> triangles;  ///< of the scene's meshes; empty in scenes of boxes
    std::optional<double> box_inflation;     ///< empty where no tree is to be seen
    std::vector<difference> differences;     ///< the same by class
    /// Over the frames after frame 0, as times are; of frame 0 where there is no other.
    std::array<std::uint64_t, aabb::work_names.size()> counts{};
    std::array<std::uint64_t, byte_columns.size()> bytes{};
};

struct scene_validation {
    std::uint64_t objects = 0;
    std::uint64_t frames = 0;
    std::string exact_by;  ///< what gave the exact answer
    std::string digest;    ///< of the exact answer
    std::vector<contender_validation> contenders;
};

/// Plays all contenders in step with the exact answer and compares whole sets, frame by frame. Work is counted on the
/// way. The scene is told the exact answer.
[[nodiscard]] scene_validation validate_scene(const scene_choice& scene, std::span<const contender> contenders);
/// The same of a scene that is made already, from its first frame on.
/// @param choice what it is, for messages
[[nodiscard]] scene_validation validate_scene(const scene_choice& choice, scene_play& scene,
                                              std::span<const contender> contenders);

/// One repeat.
struct timing {
    elapsed build;
    elapsed first;
    elapsed update;
    elapsed search;
    elapsed detect;  ///< of the query that is asked
    std::string digest;
    std::string wrong;  ///< what was asked for and answered otherwise than by `digest`; empty where all was right
};
/// Of an external engine, what it says of itself, of wall time alone. The scene is told what the contender itself
/// finds.
[[nodiscard]] timing time_scene(const scene_choice& scene, const contender& who, const asking& how = {});
[[nodiscard]] timing time_scene(scene_play& scene, const contender& who, const asking& how = {});

/// Validates a scene, then times the repeats of one of the experiment's processes, interleaved over the contenders, and
/// adds a row for each. What the folder has already is not played again; later processes take what the first one
/// validated as known, and compare the digest of every repeat with it.
/// @param process from 0; each takes an equal share of the repeats, in order
/// @returns a sentence for each contender that is wrong; it gets no row.
[[nodiscard]] std::vector<std::string> run_scene(const experiment& e, const scene_choice& scene,
                                                 std::span<const contender> contenders, results_folder& results,
                                                 std::size_t process = 0);

}  // namespace aabblab
