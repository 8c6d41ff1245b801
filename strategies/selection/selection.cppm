/// The selection of strategies for a scene (`auto`), by rules that explain themselves.
export module aabb.selection;

import aabb.geometry;
import aabb.policy;
import aabb.registry;
import aabb.std;

export namespace aabb {

/// The outlook of a scene of moving meshes, assuming one narrow-phase query per two objects and frame.
[[nodiscard]] scene_traits traits_of(std::span<const mesh> meshes, std::size_t objects, std::size_t frames);

/// The strategy selected for a kind, and the rule that selected it, as a sentence.
struct selected_strategy {
    strategy_kind kind;
    strategy_choice choice;
    std::string rule;
};

[[nodiscard]] bool depends_on_scene(strategy_kind kind);

/// Selects a strategy for each kind. Named strategies are kept. In kinds whose strategies state which scenes they serve
/// (`fit`), the first one that serves this scene is selected, or the default. Other kinds use the fastest strategy, or
/// if it is rejected in this combination, one that is accepted.
/// @throws input_error on an unknown name or parameter
[[nodiscard]] composition select_composition(const named_strategies& named, const scene_traits& scene);

/// The same in two steps. The first does not depend on the scene and takes up to ten microseconds; the second changes a
/// composition in place, which may have been selected for another scene before, in less than one microsecond.
[[nodiscard]] composition complete_composition(const named_strategies& named);
void select_for_scene(composition& completed, const named_strategies& named, const scene_traits& scene);

/// The same with the rules, in the order of the kinds.
[[nodiscard]] std::vector<selected_strategy> select_strategies(const named_strategies& named,
                                                               const scene_traits& scene);
[[nodiscard]] composition composed_of(const std::vector<selected_strategy>& selected);

}  // namespace aabb
