/// What serves a scene: `auto`, by rules that say why.
export module aabb.selection;

import aabb.geometry;
import aabb.policy;
import aabb.registry;
import aabb.std;

export namespace aabb {

/// Of moving meshes: each object is held against one other a frame, as a guess.
[[nodiscard]] scene_outlook outlook_of(std::span<const mesh> meshes, std::size_t objects, std::size_t frames);

/// What one kind of strategy gets, and the rule that says so, a sentence.
struct selected_strategy {
    strategy_kind kind;
    strategy_choice choice;
    std::string rule;
};

/// Whether what is selected for the kind depends on the scene.
[[nodiscard]] bool depends_on_scene(strategy_kind kind);

/// A strategy for each kind: what is named stays; where some strategy of the kind says which scenes it serves (`fit`),
/// the first one that serves this one, or the usual one; the others are what is fastest by itself, or where that cannot
/// be composed with it, what can.
/// @throws input_error on an unknown name or parameter.
[[nodiscard]] composition select_composition(const named_strategies& named, const scene_outlook& scene);

/// The same in two steps. The first does not depend on the scene, and may take ten microseconds; the second changes a
/// composition in place, and takes less than one. It may have been selected for another scene before.
[[nodiscard]] composition complete_composition(const named_strategies& named);
void select_for_scene(composition& completed, const named_strategies& named, const scene_outlook& scene);

/// The same with the rules that it follows from, in the order of the kinds.
[[nodiscard]] std::vector<selected_strategy> select_strategies(const named_strategies& named,
                                                               const scene_outlook& scene);
[[nodiscard]] composition composed_of(const std::vector<selected_strategy>& selected);

}  // namespace aabb
