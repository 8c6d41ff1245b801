/// What a reported set of pairs and the exact one do not have in common.
module aabb.extreme:comparison;

import aabb.geometry;
import aabb.std;
import :judge;
import :scene;

namespace aabb {

struct pair_comparison {
    /// @param exact sorted, each once
    pair_comparison(const std::vector<index_pair>& exact, std::vector<index_pair> found) {
        std::ranges::sort(found);
        std::ranges::set_difference(exact, found, std::back_inserter(missing));
        std::ranges::set_difference(found, exact, std::back_inserter(invented));
        repeated = !invented.empty() && std::ranges::binary_search(exact, invented[0]);
    }

    std::vector<index_pair> missing;
    std::vector<index_pair> invented;  ///< a pair that is reported again, too
    bool repeated = false;             ///< the first of these is such a pair
};

/// Keeps the first thing that is wrong.
inline void make_wrong(judgement& made, const std::string& reason) {
    if (made.said == verdict::wrong) return;
    made.said = verdict::wrong;
    made.reason = reason;
}

/// @param where "frame 2"
inline void add(judgement& made, const pair_comparison& found, const std::string& where) {
    const auto text_of = [](const index_pair& pair) { return std::to_string(pair.a) + " " + std::to_string(pair.b); };
    made.missing += found.missing.size();
    made.invented += found.invented.size();
    if (!found.missing.empty()) make_wrong(made, where + ": the pair " + text_of(found.missing[0]) + " is missing");
    if (!found.invented.empty())
        make_wrong(made, where + ": the pair " + text_of(found.invented[0]) +
                             (found.repeated ? " is reported more than once"
                                             : " is reported, but is not in the exact answer"));
}

/// Does the work of a query in the scene's arithmetic, and holds its sentence against what it must be refused with.
void require_refusal(const extreme_scene& scene, const std::string& query, const std::function<void()>& work,
                     judgement& made);

}  // namespace aabb
