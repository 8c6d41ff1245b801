module;
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

/// Who is the fastest in a scene, without playing it through with everybody: those who are far behind after some frames
/// play no more.
export module aabblab.race;

import aabblab.play;
import aabblab.scenes;
import aabblab.statistics;

export namespace aabblab {

/// A scene played once, or its first frames.
struct race_time {
    double build_ms = 0;
    double first_ms = 0;  ///< of frame 0
    double rest_ms = 0;   ///< of all further ones
    std::size_t frames = 0;
    std::uint64_t bytes = 0;
    std::string digest;
    std::vector<std::string> left_out;  ///< by the stages, after the last of these frames; not told of whom plays apart

    /// Of so many frames, the further ones as fast as those that were played.
    [[nodiscard]] double over(double all_frames) const {
        return build_ms + first_ms + (all_frames > 1 ? (all_frames - 1) * steady_ms() : 0);
    }
    /// Of all frames that were played.
    [[nodiscard]] double whole_ms() const { return build_ms + first_ms + rest_ms; }
    /// A frame after frame 0.
    [[nodiscard]] double steady_ms() const { return frames > 1 ? rest_ms / static_cast<double>(frames - 1) : 0; }
    /// The same, or frame 0 where it is alone.
    [[nodiscard]] double frame_ms() const { return frames > 1 ? steady_ms() : first_ms; }
};

/// Plays the first frames of the scene.
[[nodiscard]] race_time time_frames(const scene_choice& scene, const contender& who, std::size_t frames);

/// Of those who play in turn, who takes more than so many times as long a frame as the first, and so long in all that
/// it matters, plays in one round only.
inline constexpr double hopeless_ratio = 20;
inline constexpr double hopeless_ms = 100;

/// Plays the first frames of the scene with all in turn (`in_turn`), round after round.
/// @returns by contender the times, by round
[[nodiscard]] std::vector<std::vector<race_time>> play_in_turn(const scene_choice& scene,
                                                               std::span<const contender> all, std::size_t frames,
                                                               std::size_t rounds);

/// Those of them, by place, who find other pairs than the first.
[[nodiscard]] std::vector<std::size_t> who_disagrees(std::span<const std::vector<race_time>> times);

/// By round.
[[nodiscard]] std::vector<double> frame_ms_of(std::span<const race_time> times);

/// Of the times of two in the same rounds, one's over the other's.
struct paired_ratio {
    double median = 1;
    double least = 1;
    double greatest = 1;

    /// Whether the rounds leave it open which of the two is faster by more than 3 %.
    [[nodiscard]] bool may_be_same() const { return least < 1.03 && greatest > 1 / 1.03; }
};
/// @param ms one or more, by round, as are those of the other
[[nodiscard]] paired_ratio paired_ratio_of(std::span<const double> ms, std::span<const double> of_other);

struct racer {
    contender who;
    std::string name;
    std::vector<race_time> times;       ///< of the whole scene, by repeat; of a finalist
    std::optional<race_time> last;      ///< of the last round that it played to its end; of a finalist, the median
    std::size_t frames = 0;             ///< of the scene, that it has played in any round
    double behind = 0;                  ///< how many times as long as the fastest it took in the last round
    std::optional<estimate> log_ratio;  ///< of the whole scene, to the winner in the same repeat: the median

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
    std::vector<racer> finalists;   ///< from the fastest
    std::vector<racer> dropped;     ///< from those who came farthest
    std::vector<racer> wrong;       ///< who would be finalists, but do not find what CGAL finds
    bool held_against_cgal = true;  ///< false where CGAL fails, or takes longer than the race may
    std::size_t played = 0;         ///< frames of the scene, summed over all; those played again do not count
    std::size_t of = 0;             ///< that all would have played
};

/// All that can play the scene: `auto`, every composition of the stage that matters there but the one that `auto` is,
/// every engine.
[[nodiscard]] std::vector<racer> starters(const scene_choice& scene);

/// @param seconds about how long the race may take, at most 1,000,000
/// @throws aabb::input_error where the scene cannot be played.
[[nodiscard]] race_result run_race(const scene_choice& scene, std::vector<racer> all, double seconds);

/// Puts finalists, who have played equally often, in order from the fastest, and says how far each is behind. Nobody is
/// ahead of the first in more than half of the repeats.
void rank(std::vector<racer>& finalists);

/// What follows from a race, sentence by sentence: what to use, how far the next is behind, and `auto`, with how many
/// frames it would be another, and whose answer is wrong.
[[nodiscard]] std::vector<std::string> advice_of(const race_result& race);

}  // namespace aabblab
