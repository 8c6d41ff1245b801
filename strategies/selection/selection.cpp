module;
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

module aabb.selection;

import aabb.costs;
import aabb.geometry;
import aabb.local_detection;
import aabb.policy;
import aabb.registry;
import aabb.wide_tree;

namespace aabb {

namespace {

/// Of fewer, what is kept for later frames does not pay where it serves: the first list of neighbours or front, which
/// takes about as long as two searches.
constexpr std::size_t fewest_frames_to_keep = 4;

/// From so many queries on, what a build takes longer for each triangle comes back where each query takes less by that
/// share. A query of two meshes visits about 21 pairs of nodes times the root of their triangles: counted with meshes
/// of 5,000 to 200,000. Meshes are taken to be alike.
/// @param longer in ns
std::size_t queries_that_repay(double longer, double share, const scene_outlook& scene) {
    constexpr double visits_a_root = 21;
    constexpr double many = 1e18;
    const auto triangles = static_cast<double>(scene.triangles);
    if (triangles == 0) return static_cast<std::size_t>(many);
    const double of_two = 2 * triangles / static_cast<double>(scene.meshes);
    const double queries =
        longer * triangles / (machine_costs().node_visit * visits_a_root * share * std::sqrt(of_two));
    return static_cast<std::size_t>(std::clamp(std::ceil(queries), 0.0, many));
}

double sah_takes_longer() {
    return machine_costs().sah_triangle - machine_costs().median_triangle;
}

/// Trees by `sah` are visited a twelfth less.
std::size_t least_queries_of_sah(const scene_outlook& scene) {
    return queries_that_repay(sah_takes_longer(), 1.0 / 12, scene);
}

/// Lists of the vertices of each leaf take about half as long to write as `sah` takes longer than `median`. A query is
/// faster with them by a tenth where the two meshes have 150,000 triangles, whose vertices outgrow the second cache, by
/// less where they have fewer, and hardly at all where these fit into it.
std::size_t least_queries_of_vertex_lists(const scene_outlook& scene) {
    const double of_two = 2 * static_cast<double>(scene.triangles) / static_cast<double>(scene.meshes);
    return queries_that_repay(sah_takes_longer() / 2, std::clamp(of_two / 1'500'000, 1.0 / 200, 1.0 / 10), scene);
}

bool fetches_vertices(const scene_outlook& scene) {
    constexpr std::size_t most_triangles_of_two = 200'000;
    return scene.triangles > 0 && 2 * scene.triangles <= most_triangles_of_two * scene.meshes &&
           scene.queries < least_queries_of_vertex_lists(scene);
}

/// More pairs of objects a frame than fronts are kept of would find none again.
bool keeps_front(const scene_outlook& scene) {
    constexpr std::size_t least_triangles = least_leaves_of_front * balanced_order::leaf_triangles;
    return 2 * scene.triangles >= least_triangles * scene.meshes && scene.frames >= fewest_frames_to_keep &&
           scene.queries <= scene.frames * most_fronts;
}

const char* prepare_for(const scene_outlook& scene) {
    return scene.frames < fewest_frames_to_keep ? "none" : "neighbour_list";
}
const char* build_for(const scene_outlook& scene) {
    return scene.triangles == 0 || scene.queries < least_queries_of_sah(scene) ? "median" : "sah";
}

std::string rule_of_prepare(const scene_outlook& scene) {
    return scene.frames < fewest_frames_to_keep
               ? "fewer than " + std::to_string(fewest_frames_to_keep) +
                     " frames: a list of neighbours would not repay its making"
               : "frames follow each other: a list of neighbours is kept while boxes move little, and only then";
}
std::string rule_of_build(const scene_outlook& scene) {
    if (scene.triangles == 0) return "no meshes: nothing is built";
    const std::string queries = std::to_string(scene.queries);
    const std::string repaid = std::to_string(least_queries_of_sah(scene));
    return scene.queries < least_queries_of_sah(scene)
               ? "built fastest: queries are to be " + queries + ", and only from " + repaid +
                     " on they repay a better tree"
               : "queries are to be " + queries + ", and from " + repaid + " on they repay a better tree";
}

/// Of one that fetches vertices or keeps fronts.
std::string rule_of_tree(const scene_outlook& scene) {
    std::string rule;
    if (fetches_vertices(scene))
        rule = "queries are to be " + std::to_string(scene.queries) + ", and only from " +
               std::to_string(least_queries_of_vertex_lists(scene)) + " on they repay lists of vertices";
    if (fetches_vertices(scene) && keeps_front(scene)) rule += "; ";
    if (keeps_front(scene)) rule += "frames follow each other: pairs of leaves are kept while meshes move little";
    return rule;
}

/// What is named among what is fastest by itself, or where that is a sort, without a partition: what lies in columns is
/// sorted anew in each frame, which gains by `bucket` only. Where that is refused, among what usually goes with what is
/// named, and then among the first that is not.
composition completed(const named_strategies& named) {
    const composition usual(named);
    composition whole;
    composition fastest;
    if (const std::optional<strategy_choice>& sort = named[strategy_kind::sort];
        sort && sort->name != fastest[strategy_kind::sort].name)
        fastest[strategy_kind::partition] = {"none", {}};
    for (const stage of : {stage::global_search, stage::local_detection}) {
        const auto take = [&](const composition& others) {
            for (const strategy_kind kind : strategy_kinds)
                if (info_of(kind).stage == of && (named[kind] || !info_of(kind).apart))
                    whole[kind] = named[kind].value_or(others[kind]);
            return refusal_of(whole, of).empty();
        };
        if (take(fastest) || take(usual) || std::ranges::any_of(every_composition(of), take)) continue;
        // What is named is refused whatever else there is.
        take(usual);
    }
    return whole;
}

/// @param why it is taken; what it says of itself follows
std::string rule_of(const std::string& why, strategy_kind kind, const std::string& name) {
    return why + ": " + std::ranges::find(strategies(kind), name, &strategy_info::name)->summary;
}

}  // namespace

scene_outlook outlook_of(std::span<const mesh> meshes, std::size_t objects, std::size_t frames) {
    scene_outlook scene{.frames = frames,
                        .queries = frames * std::max<std::size_t>(objects / 2, 1),
                        .meshes = std::max<std::size_t>(meshes.size(), 1)};
    for (const mesh& m : meshes) scene.triangles += m.triangle_count();
    return scene;
}

bool depends_on_scene(strategy_kind kind) {
    return kind == strategy_kind::prepare || kind == strategy_kind::build || kind == strategy_kind::tree;
}

composition complete_composition(const named_strategies& named) {
    const bool any = std::ranges::any_of(strategy_kinds, [&](strategy_kind kind) { return named[kind].has_value(); });
    return any ? completed(named) : composition();
}

void select_for_scene(composition& completed, const named_strategies& named, const scene_outlook& scene) {
    if (!named[strategy_kind::prepare]) completed[strategy_kind::prepare].name = prepare_for(scene);
    if (!named[strategy_kind::build]) completed[strategy_kind::build].name = build_for(scene);
    if (strategy_choice& tree = completed[strategy_kind::tree];
        !named[strategy_kind::tree] && tree.name == "implicit") {
        tree.settings.clear();
        if (fetches_vertices(scene)) tree.settings.push_back({"vertices", "fetched"});
        if (keeps_front(scene) && is_exact(completed, stage::local_detection))
            tree.settings.push_back({"front", "kept"});
    }
}

composition select_composition(const named_strategies& named, const scene_outlook& scene) {
    composition whole = complete_composition(named);
    select_for_scene(whole, named, scene);
    return whole;
}

std::vector<selected_strategy> select_strategies(const named_strategies& named, const scene_outlook& scene) {
    const composition usual;
    const composition whole = select_composition(named, scene);
    std::vector<selected_strategy> all;
    for (const strategy_kind kind : strategy_kinds) {
        std::string rule =
            named[kind]                      ? "as it is named"
            : kind == strategy_kind::prepare ? rule_of_prepare(scene)
            : kind == strategy_kind::build   ? rule_of_build(scene)
            : kind == strategy_kind::tree && whole[kind] != usual[kind] && whole[kind].name == usual[kind].name
                ? rule_of_tree(scene)
                : rule_of(whole[kind] == usual[kind] ? "the usual one" : "what goes with what is named", kind,
                          whole[kind].name);
        all.push_back({kind, whole[kind], std::move(rule)});
    }
    return all;
}

composition composed_of(const std::vector<selected_strategy>& selected) {
    composition c;
    for (const selected_strategy& one : selected) c[one.kind] = one.choice;
    return c;
}

}  // namespace aabb
