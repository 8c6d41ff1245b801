export module aabb.policy:scene_outlook;

import aabb.base;
import aabb.costs;
import aabb.std;
import :strategy_choice;

export namespace aabb {

/// What is known of a scene before it is played. What boxes do from frame to frame is left to strategies that watch it:
/// `neighbour_list`, and the plans of `columns`.
struct scene_outlook {
    std::size_t frames = 1;
    std::size_t triangles = 0;    ///< of all meshes; 0 where there are boxes only
    std::size_t queries = 1;      ///< of two meshes, that trees are to serve
    std::size_t meshes = 2;       ///< that the triangles are of; at least 1
    bool exact_triangles = true;  ///< the strategies beside it are exact

    /// Of fewer, what is kept for later frames does not pay where it serves: the first list of neighbours or front,
    /// which takes about as long as two searches.
    static constexpr std::size_t fewest_frames_to_keep = 4;

    /// From so many queries on, what a build takes longer for each triangle comes back where each query takes less by
    /// that share. A query of two meshes visits about 21 pairs of nodes times the root of their triangles: counted with
    /// meshes of 5,000 to 200,000. Meshes are taken to be alike.
    /// @param longer in ns
    [[nodiscard]] std::size_t queries_that_repay(double longer, double share) const {
        constexpr double visits_a_root = 21;
        constexpr double many = 1e18;
        if (triangles == 0) return static_cast<std::size_t>(many);
        const double all = longer * static_cast<double>(triangles) /
                           (machine_costs().node_visit * visits_a_root * share * std::sqrt(triangles_of_two()));
        return static_cast<std::size_t>(std::clamp(std::ceil(all), 0.0, many));
    }
    [[nodiscard]] double triangles_of_two() const {
        return 2 * static_cast<double>(triangles) / static_cast<double>(meshes);
    }
};

/// Whether a strategy serves a scene better than the usual one of its kind, and the settings with which it does. A
/// strategy that `auto` may choose has a member `static scene_fit fit(const scene_outlook&)`.
struct scene_fit {
    bool serves = false;
    std::vector<setting> settings{};
    std::vector<statement> because{};  ///< why, or why not; empty where nothing is to be said
};

}  // namespace aabb
