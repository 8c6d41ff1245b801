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

/// The default composition with one strategy replaced, as on the command line: "triangle moller:epsilon=none".
[[nodiscard]] method composed(std::string_view changes) {
    aabb::composition c;
    const std::size_t space = changes.find(' ');
    const std::string_view name = changes.substr(0, space);
    const auto kind = std::ranges::find(aabb::strategy_kinds, name, &aabb::name_of);
    c[*kind] = aabb::parse_strategy(changes.substr(space + 1));
    return {std::string(changes.substr(space + 1)), candidate_of(c, true)};
}

/// Every triangle test of the registry with each of its settings, and each engine that collides meshes.
[[nodiscard]] std::vector<method> triangle_methods() {
    std::vector<method> methods;
    for (const char* const test :
         {"triangle exact", "triangle interval_arithmetic", "triangle interval_arithmetic:fallback=intersects",
          "triangle devillers_guigue", "triangle devillers_guigue:precision=float", "triangle separating_axes",
          "triangle separating_axes:precision=double", "triangle moller", "triangle moller:epsilon=none",
          "triangle moller:epsilon=scaled", "triangle moller_double"})
        methods.push_back(composed(test));
    for (const aabb::engine_info& engine : aabb::engines())
        // brute_force uses the same triangle predicate as cgal, but is slower.
        if (engine.collides_meshes && engine.name != "brute_force")
            if (std::optional<candidate> tested = candidate_of(engine, true))
                methods.push_back({engine.name, *std::move(tested)});
    return methods;
}

/// Every compressed tree layout, Verlet lists that are rebuilt in time, and others that are rebuilt too rarely.
[[nodiscard]] std::vector<method> tree_and_list_methods() {
    std::vector<method> methods;
    for (const char* const changes :
         {"tree compressed", "tree quantized:bits=16", "tree quantized:bits=8", "tree quantized:bits=4",
          "prepare neighbour_list:margin=0.1", "prepare neighbour_list:margin=0.05,every=4",
          "prepare neighbour_list:margin=0,every=4", "prepare neighbour_list:margin=0,every=16",
          "prepare neighbour_list:margin=0,every=32", "prepare neighbour_list:margin=0,every=64"})
        methods.push_back(composed(changes));
    return methods;
}

}  // namespace aabblab
