module;
#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

/// Who is the fastest in a scene, without playing it through with everybody: those who are far behind after some frames
/// play no more.
export module aabblab.race;

export import :apart;

import aabb.pipeline;
import aabblab.play;
import aabblab.scenes;
import aabblab.statistics;

export namespace aabblab {

/// When to end. What is to take S seconds ends within 2 S, or 2 seconds after the scene is read where that is later:
/// half of it is for playing, the rest for comparing with the exact pairs. A twentieth is kept for ending and telling.
class time_limits {
public:
    /// @param seconds at most 1,000,000
    /// @param elapsed in seconds
    explicit time_limits(double seconds, std::function<double()> elapsed = since_now())
        : seconds_(seconds), elapsed_(std::move(elapsed)) {}

    void scene_is_read() { reading_ = elapsed_(); }
    /// Seconds that are left, none where it is not above 0.
    [[nodiscard]] double to_play() const { return std::max(usable * seconds_, reading_ + usable) - elapsed_(); }
    [[nodiscard]] double to_end() const { return std::max(2 * usable * seconds_, reading_ + 2 * usable) - elapsed_(); }

private:
    static constexpr double usable = 0.95;

    [[nodiscard]] static std::function<double()> since_now() {
        return [begin = std::chrono::steady_clock::now()] {
            return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
        };
    }

    double seconds_;
    std::function<double()> elapsed_;
    double reading_ = 0;
};

/// A scene played once, or its first frames.
struct race_time {
    double build_ms = 0;
    double first_ms = 0;  ///< of frame 0
    double rest_ms = 0;   ///< of all further ones
    std::size_t frames = 0;
    std::uint64_t bytes = 0;
    std::string digest;
    std::vector<aabb::omission> left_out;  ///< by the stages, after the last of these frames
    std::vector<std::string> digests{};    ///< of the pairs up to each frame

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

/// A play in a copy of this process.
struct attempt {
    ending end = ending::stopped;
    race_time time;                ///< of the frames that it came to the end of
    std::string reason;            ///< the sentence of a refusal
    double seconds = 0;            ///< in all, with reading, and sorting what was found
    double seconds_of_frames = 0;  ///< up to the end of the last of those frames
    bool is_hopeless = false;      ///< it was stopped as far slower than another, not since time was over
};

/// "stopped after 2.1 s, in frame 3", "not played: no time was left"
[[nodiscard]] std::string text_of(const attempt& one);

/// A scene that is read once and played by many, each in a copy of this process, which is not played itself.
class staged_scene {
public:
    /// @throws aabb::input_error where the scene cannot be made.
    explicit staged_scene(const scene_choice& choice) : choice_(choice), scene_(choice) {}

    [[nodiscard]] const scene_choice& choice() const { return choice_; }
    [[nodiscard]] const scene_play& scene() const { return scene_; }
    /// Plays the first frames, for so many seconds at most.
    [[nodiscard]] attempt play(const contender& who, std::size_t frames, double seconds);
    /// Does something else with the scene from its first frame on.
    [[nodiscard]] work_apart apart(const std::function<void(scene_play&, const telling&)>& work, double seconds);

private:
    scene_choice choice_;
    scene_play scene_;
};

/// Of those who play in turn, who takes more than so many times as long a frame as the first, and so long in all that
/// it matters, is stopped, or plays in one round only.
inline constexpr double hopeless_ratio = 20;
inline constexpr double hopeless_ms = 100;

/// What came of playing in turn, by contender.
struct turns {
    std::size_t frames = 0;  ///< in each play: as many as there was time for
    std::size_t rounds = 0;
    std::vector<std::vector<race_time>> times;       ///< of whole plays, by round
    std::vector<std::optional<attempt>> broken_off;  ///< whose first play did not end
    std::vector<bool> hopeless;                      ///< who took, or would have taken, so many times as long
};

/// Plays the first frames of the scene with all in turn (`in_turn`), round after round, until time is over. Without the
/// first, whose first frame may take too long, nobody else plays.
[[nodiscard]] turns play_in_turn(staged_scene& scene, std::span<const contender> all, std::size_t frames,
                                 std::size_t rounds, const time_limits& limits);

/// Those of them, by place, who find other pairs than the first in as many frames.
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

/// Of fewer repeats it is not said how far ratios may be off.
inline constexpr std::size_t fewest_repeats = 5;

struct racer {
    contender who;
    std::string name;
    std::vector<race_time> times;       ///< of the frames of the final, by repeat; of a finalist
    std::optional<race_time> last;      ///< of the last round that it played to its end; of a finalist, the median
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

}  // namespace aabblab
