/// Who is the fastest in a scene, without playing it through with everybody: those who are far behind after some frames
/// play no more.
export module aabblab.race;

import aabb.std;
import aabblab.trials;
import aabblab.scenes;
import aabblab.statistics;

export namespace aabblab {

/// Of fewer repeats it is not said how far ratios may be off.
inline constexpr std::size_t fewest_repeats = 5;

struct racer {
    contender who;
    std::string name;
    std::vector<observation> times;     ///< of the frames of the final, by repeat; of a finalist
    std::optional<observation> last;    ///< of the last round that it played to its end; of a finalist, the median
    std::optional<attempt> broken_off;  ///< the play that did not end, and dropped it
    double seconds = 0;                 ///< of the last round that it played to its end, in all
    std::size_t frames = 0;             ///< of the scene, that it has played in any round
    double behind = 0;                  ///< how many times as long as the fastest it took in the last round
    std::optional<estimate> log_ratio;  ///< of those frames, to the winner in the same repeat: the median

    [[nodiscard]] bool has_range() const { return times.size() >= fewest_repeats; }
    [[nodiscard]] double ratio() const { return std::exp(log_ratio->value); }
    /// Of 95 %.
    [[nodiscard]] interval ratio_range() const {
        const auto [low, high] = log_ratio->range();
        return {std::exp(low), std::exp(high)};
    }
};

struct race_result {
    std::size_t objects = 0;
    std::size_t frames = 0;
    std::size_t final_frames = 0;  ///< that finalists played: fewer where there was no time for all
    std::vector<racer> finalists;  ///< from the fastest
    std::vector<racer> dropped;    ///< from those who came farthest
    std::vector<racer> wrong;      ///< who would be finalists, but do not find what CGAL finds
    std::size_t validated = 0;     ///< of those frames, in which finalists find what CGAL finds
    std::size_t played = 0;        ///< frames of the scene, summed over all; those played again do not count
    std::size_t of = 0;            ///< that all would have played

    [[nodiscard]] bool is_validated() const { return validated > 0 && validated == final_frames; }
};

/// All that can play the scene: `auto`, then every engine, and every composition of the stage that matters there but
/// the one that `auto` is, in an order by chance, the same each time, since there may be no time for all.
[[nodiscard]] std::vector<racer> starters(const scene_play& scene);

/// @throws aabb::input_error where the scene cannot be played, or nobody plays its first frame in time.
[[nodiscard]] race_result run_race(staged_scene& scene, std::vector<racer> all, const time_limits& limits);

/// Puts finalists, who have played equally often, in order from the fastest, and says how far each is behind. Nobody is
/// ahead of the first in more than half of the repeats.
void rank(std::vector<racer>& finalists);

/// What follows from a race, sentence by sentence: what to use, how far the next is behind, and `auto`, with how many
/// frames it would be another, and whose answer is wrong.
[[nodiscard]] std::vector<std::string> advice_of(const race_result& race);

struct recommend_request {
    std::vector<std::string> what;      ///< names a scene
    std::optional<std::string> report;  ///< the HTML page to write
    double seconds = 60;
};

/// Runs a race, prints the ranking and recommends a configuration.
/// @returns the exit status: 1 where somebody does not find what others find
[[nodiscard]] int recommend(const recommend_request& request);

}  // namespace aabblab
