/// Compositions and engines whose effect on a trajectory is measured.
module aabblab.stiff:method;

import aabb.policy;
import aabb.registry;
import aabb.std;
import aabb.validation;
import aabblab.trials;

namespace aabblab {

struct method {
    std::string label;
    candidate tested;
};

/// The default composition with one strategy replaced.
/// @param replacement kind, blank and strategy: "triangle moller:epsilon=none"
[[nodiscard]] method composed_with(std::string_view replacement) {
    aabb::composition c;
    const std::size_t space = replacement.find(' ');
    const auto kind = std::ranges::find(aabb::strategy_kinds, replacement.substr(0, space), &aabb::name_of);
    const std::string_view strategy = replacement.substr(space + 1);
    c[*kind] = aabb::parse_strategy(strategy);
    return {std::string(strategy), candidate_of(c, /*meshes=*/true)};
}

/// Every triangle test of the registry with each of its settings, and each engine that collides meshes.
/// @param quick without the exact engines, which decide as the exact test and take up to forty times as long
[[nodiscard]] std::vector<method> triangle_methods(bool quick) {
    std::vector<method> methods;
    for (const char* const test :
         {"triangle exact", "triangle interval_arithmetic", "triangle interval_arithmetic:fallback=intersects",
          "triangle devillers_guigue", "triangle devillers_guigue:precision=float", "triangle separating_axes",
          "triangle separating_axes:precision=double", "triangle moller", "triangle moller:epsilon=none",
          "triangle moller:epsilon=scaled", "triangle moller_double"})
        methods.push_back(composed_with(test));
    for (const aabb::engine_info& engine : aabb::engines())
        // These are slower, and decide as cgal does.
        if (engine.collides_meshes && engine.name != "brute_force" && engine.name != "boost_integers")
            if (std::optional<candidate> tested = candidate_of(engine, /*meshes=*/true);
                tested && !(quick && tested->exact))
                methods.push_back({engine.name, *std::move(tested)});
    return methods;
}

/// Every compressed tree layout, and Verlet lists: some that are rebuilt before they can miss a contact, and some,
/// with margin=0, that are rebuilt so rarely that they miss contacts.
[[nodiscard]] std::vector<method> tree_and_list_methods() {
    std::vector<method> methods;
    for (const char* const replacement :
         {"tree compressed", "tree quantized:bits=16", "tree quantized:bits=8", "tree quantized:bits=4",
          "prepare neighbour_list:margin=0.1", "prepare neighbour_list:margin=0.05,every=4",
          "prepare neighbour_list:margin=0,every=4", "prepare neighbour_list:margin=0,every=16",
          "prepare neighbour_list:margin=0,every=32", "prepare neighbour_list:margin=0,every=64"})
        methods.push_back(composed_with(replacement));
    return methods;
}

}  // namespace aabblab
