module aabblab.checking;

import :comparison;
import aabb.registry;
import aabb.truth;
import aabblab.fmt;
import aabblab.numbers;
import aabblab.stopwatch;

namespace aabblab {

namespace {

/// Wrong pairs beyond these are counted only: a class takes exact arithmetic, about a tenth of a millisecond.
constexpr std::size_t most_classified = 10'000;

std::string shape_of(std::string_view mesh, std::uint32_t id, const aabb::triangle3d& t) {
    std::string text = fmt::format("{} {}:", mesh, id);
    for (int i = 0; i < 3; ++i) text += fmt::format(" ({:a}, {:a}, {:a})", t[i][0], t[i][1], t[i][2]);
    return text;
}

/// The class of a wrong pair, an index into `difference_class_names`.
std::size_t class_of(const wrong_pair& wrong, const aabb::mesh& a, const aabb::pose& pose_a, const aabb::mesh& b,
                     const aabb::pose& pose_b) {
    const std::span<const aabb::index_pair> pair(&wrong.pair, 1), none;
    const aabb::differences counts = aabb::compare_triangle_pairs(wrong.is_listed ? none : pair,
                                                                  wrong.is_listed ? pair : none, a, pose_a, b, pose_b);
    const auto& of_kind = wrong.is_listed ? counts.false_positives : counts.false_negatives;
    return static_cast<std::size_t>(std::ranges::find(of_kind, std::size_t{1}) - of_kind.begin());
}

}  // namespace

check_result check_triangles(const mesh_check& meshes, pair_list list) {
    const std::size_t poses = meshes.poses_b.poses.size();
    if (!list.has_frames && poses > 1)
        throw aabb::input_error(
            fmt::format("the list has no poses, but there are {}: expected the columns pose,a,b", grouped(poses)));
    // The ground truth of all poses, since the query passes each of them only once.
    std::vector<std::vector<aabb::index_pair>> truth(poses);
    const mesh_query query{.self = meshes.self,
                           .by_pose = poses > 1,
                           .between = meshes.between,
                           .take = [&](std::uint32_t pose, std::span<const aabb::index_pair> pairs) {
                               truth[pose].insert(truth[pose].end(), pairs.begin(), pairs.end());
                           }};
    const mesh_result searched =
        search_meshes(query, {.stages = {aabb::stage::local_detection}, .named = {}, .engine = {}}, meshes.meshes,
                      meshes.pose_a, meshes.poses_b, nullptr);
    const wall_stopwatch checking;
    const aabb::mesh& a = meshes.meshes.front();
    const aabb::mesh& b = meshes.meshes.back();
    list_comparison comparison(std::move(list),
                               {poses, a.triangle_count(), b.triangle_count(), meshes.self.has_value()});
    std::vector<class_counts> classes;
    for (const std::string_view name : aabb::difference_class_names) classes.push_back({std::string(name)});
    std::vector<wrong_pair> first;
    std::uint64_t wrong_pairs = 0;
    double classifying_ms = 0;
    for (std::size_t pose = 0; pose < poses; ++pose) {
        const aabb::pose pose_b = meshes.self ? meshes.pose_a : meshes.poses_b.poses[pose];
        comparison.compare(truth[pose], [&](const wrong_pair& wrong) {
            if (++wrong_pairs > most_classified) return;
            const wall_stopwatch classifying;
            const std::size_t kind = class_of(wrong, a, meshes.pose_a, b, pose_b);
            ++(wrong.is_listed ? classes[kind].false_positives : classes[kind].false_negatives);
            if (first.size() < most_shown) {
                first.push_back(wrong);
                first.back().description = aabb::difference_class_names[kind];
                first.back().shapes = {
                    shape_of(meshes.self ? "triangle" : "A", wrong.pair.a, a.given_triangle(wrong.pair.a)),
                    shape_of(meshes.self ? "triangle" : "B", wrong.pair.b, b.given_triangle(wrong.pair.b))};
            }
            classifying_ms += classifying.ms();
        });
    }
    check_result result = comparison.result({});
    result.classes = std::move(classes);
    result.unclassified = wrong_pairs - std::min<std::uint64_t>(wrong_pairs, most_classified);
    result.first = std::move(first);
    result.search_ms = searched.build_ms + std::accumulate(searched.query_ms.begin(), searched.query_ms.end(), 0.0);
    result.check_ms = checking.ms() - classifying_ms;
    return result;
}

}  // namespace aabblab
