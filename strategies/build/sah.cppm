export module aabb.build.sah;

import aabb.costs;
import aabb.build.top_down;
import aabb.std;

export namespace aabb {

[[nodiscard]] split_choice sah_split(std::span<const build_element> range, const box& bounds);

/// The binned surface-area heuristic (Wald, "On fast construction of SAH-based bounding volume hierarchies", 2007): of
/// 15 planes on each axis, picks the one with the least sum of area times triangles over both sides; splits at the
/// median if all centroids are equal. When to use: for trees that are queried often.
struct sah_build : top_down_build<sah_split, axis_rule::least_area> {
    using top_down_build::top_down_build;

    static constexpr std::string_view name = "sah";
    static constexpr std::string_view summary = "splits by the surface-area heuristic, with 16 bins per axis";

    /// Whether `auto` chooses this build, and why. It takes longer than the default, `median`, but queries visit a
    /// twelfth fewer nodes: enough queries must be expected to repay the difference.
    [[nodiscard]] static scene_fit fit(const scene_traits& scene) {
        if (scene.triangles == 0) return {.because = {{"no meshes: nothing is built"}}};
        constexpr double saving_per_query = 1.0 / 12;
        const double longer = machine_costs().sah_triangle - machine_costs().median_triangle;  // ns per triangle
        const std::size_t repaid = scene.queries_that_repay(longer, saving_per_query);
        const bool serves = scene.queries >= repaid;
        return {.serves = serves,
                .because = {
                    {serves ? "{queries} queries are expected, and a better tree is worth its cost from {repaid} on"
                            : "built fastest: {queries} queries are expected, and a better tree is worth its cost "
                              "only from {repaid} on",
                     {{{"queries", static_cast<double>(scene.queries)}, {"repaid", static_cast<double>(repaid)}}}}}};
    }
};

static_assert(BuildPolicy<sah_build>);

}  // namespace aabb
