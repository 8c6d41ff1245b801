/// Finds the fastest candidate for a scene without running every candidate on all frames, as racing algorithms do
/// (Maron and Moore 1994): rounds get longer, and a candidate that is far behind after a round is dropped.
export module aabblab.race;

import aabb.std;
import aabblab.filters;
import aabblab.trials;
import aabblab.scenes;
import aabblab.statistics;

export namespace aabblab {

/// Fewer repeats give no confidence intervals of ratios.
inline constexpr std::size_t fewest_repeats = 5;

/// A candidate in the race, with its runs so far.
struct racer {
    candidate tested;
    std::string name = {};
    std::vector<observation> times = {};     ///< of a finalist: the final, by repeat
    std::optional<observation> last = {};    ///< the last round that it finished; of a finalist, the median
    std::optional<attempt> broken_off = {};  ///< the unfinished run for which it was dropped
    double seconds = 0;                      ///< total time of the last round that it finished
    std::size_t frames = 0;                  ///< the most frames of the scene that it ran in any round
    double slowdown = 0;                     ///< its time in the last round over that of the fastest
    std::optional<estimate> log_ratio = {};  ///< of a finalist: the median over repeats, relative to the winner

    [[nodiscard]] bool has_range() const { return times.size() >= fewest_repeats; }
    [[nodiscard]] double ratio() const { return std::exp(log_ratio->value); }
    /// The 95 % confidence interval.
    [[nodiscard]] interval ratio_range() const {
        const auto [low, high] = log_ratio->range();
        return {std::exp(low), std::exp(high)};
    }
};

struct race_result {
    std::size_t objects = 0, frames = 0;
    std::size_t final_frames = 0;   ///< of the final: fewer than `frames` if time was short
    std::vector<racer> finalists;   ///< from the fastest
    std::vector<racer> dropped;     ///< in reverse order of being dropped
    std::vector<racer> wrong;       ///< finalists in time, but with results that differ from those of CGAL
    std::size_t validated = 0;      ///< frames of the final that were compared with CGAL
    std::size_t frames_run = 0;     ///< by all candidates; repeated runs do not count
    std::size_t frames_of_all = 0;  ///< the same without early stopping

    [[nodiscard]] bool is_validated() const { return validated > 0 && validated == final_frames; }
};

/// The candidates for a scene: first `auto`, then the exact engines and every other exact composition of one stage, of
/// meshes the narrow phase, in a reproducible random order, since there may be no time for all.
[[nodiscard]] std::vector<racer> race_candidates(const scene_frames& scene);

/// @throws aabb::input_error if the scene cannot be run, or no candidate finishes its first frame in time.
[[nodiscard]] race_result run_race(staged_scene& scene, std::vector<racer> candidates, const time_limits& limits);

/// Sorts finalists, which have equally many repeats, from the fastest, and sets their ratios to the winner. No finalist
/// is faster than the winner in more than half of the repeats.
void rank(std::vector<racer>& finalists);

/// The recommendation, one sentence each: the winner, its lead and for which numbers of frames it would be another,
/// `auto`, options to use it, wrong results, caveats.
[[nodiscard]] std::vector<std::string> advice_of(const race_result& race);

struct recommend_request {
    std::vector<std::string> what;      ///< the arguments that name a scene
    filter_files filter;                ///< leaves out pairs
    std::optional<std::string> report;  ///< the HTML page to write
    double seconds = 60;
};
/// Runs a race, prints the ranking and recommends a configuration.
/// @returns the exit status: 1 if results differ
[[nodiscard]] int recommend(const recommend_request& request);

}  // namespace aabblab
