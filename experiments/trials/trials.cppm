/// Everything that is tried: who plays which scene, what is asked and what is seen of that; exact or not, in turn, in a
/// copy of this process where it may take too long, and into a folder that can be resumed.
export module aabblab.trials;

import aabb.counters;
import aabb.policy;
import aabb.registry;
import aabb.selection;
import aabb.std;
import aabb.validation;
import aabblab.configs;
import aabblab.results;
import aabblab.scenes;
export import :isolation;
export import :observation;
export import :player;
export import :staged_scene;
export import :turns;

export namespace aabblab {

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

/// A contender that played a scene beside the exact answer, untimed: its row with all that a run may record of that.
struct validated_row : row {
    std::string failure;  ///< the first difference where the contender must be exact, or that it took too long
    std::vector<difference> differences;  ///< by class
};

struct scene_validation {
    std::uint64_t objects = 0;
    std::uint64_t frames = 0;
    std::string exact_by;  ///< what gave the exact answer
    std::string digest;    ///< of the exact answer
    std::vector<validated_row> contenders;
};

/// Plays all contenders in step with the exact answer and compares whole sets, frame by frame. Work is counted on the
/// way. The scene is told the exact answer.
[[nodiscard]] scene_validation validate_scene(const scene_choice& scene, std::span<const contender> contenders);
/// The same of a scene that is made already, from its first frame on.
/// @param choice what it is, for messages
[[nodiscard]] scene_validation validate_scene(const scene_choice& choice, scene_play& scene,
                                              std::span<const contender> contenders);

/// Validates a scene, then times the repeats of one of the experiment's processes, interleaved over the contenders, and
/// adds a row for each. What the folder has already is not played again; later processes take what the first one
/// validated as known, and compare the digest of every repeat with it.
/// @param process from 0; each takes an equal share of the repeats, in order
/// @returns a sentence for each contender that is wrong; it gets no row.
[[nodiscard]] std::vector<std::string> run_scene(const experiment& e, const scene_choice& scene,
                                                 std::span<const contender> contenders, results_folder& results,
                                                 std::size_t process = 0);

}  // namespace aabblab
