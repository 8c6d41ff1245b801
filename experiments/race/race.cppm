module;
#include <cstddef>
#include <cstdint>
#include <optional>
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

    /// Of so many frames, the further ones as fast as those that were played.
    [[nodiscard]] double over(double all_frames) const {
        return build_ms + first_ms + (all_frames > 1 ? (all_frames - 1) * steady_ms() : 0);
    }
    /// A frame after frame 0.
    [[nodiscard]] double steady_ms() const { return frames > 1 ? rest_ms / static_cast<double>(frames - 1) : 0; }
};

/// Plays the first frames of the scene.
[[nodiscard]] race_time time_frames(const scene_choice& scene, const contender& who, std::size_t frames);

struct racer {
    contender who;
    std::string name;
    std::vector<race_time> times;       ///< of the whole scene; empty where it was dropped before
    std::optional<race_time> last;      ///< of the last round that it played to its end
    double behind = 0;                  ///< how many times as long as the fastest it took there
    std::optional<estimate> log_ratio;  ///< of the whole scene, to the winner
};

struct race_result {
    std::size_t objects = 0;
    std::size_t frames = 0;
    std::vector<racer> finalists;  ///< from the fastest
    std::vector<racer> dropped;    ///< from those who came farthest
    std::size_t played = 0;        ///< frames, by all
    std::size_t of = 0;            ///< that all would have played
};

/// All that can play the scene: `auto`, every composition of the stage that matters there, every engine.
[[nodiscard]] std::vector<racer> starters(const scene_choice& scene);

/// @param seconds about how long the race may take
/// @throws aabb::input_error where the scene cannot be played.
[[nodiscard]] race_result run_race(const scene_choice& scene, std::vector<racer> all, double seconds);

}  // namespace aabblab
