/// One trial: who plays a scene, how it is asked, and what is seen of that.
export module aabblab.trials:observation;

import aabb.counters;
import aabb.pipeline;
import aabb.std;
import aabblab.configs;
import aabblab.scenes;
import aabblab.stopwatch;
import :player;

export namespace aabblab {

/// A scene played once from a fresh start, or its first frames.
struct observation {
    elapsed build;  ///< making the stages, taking the objects, building the trees
    phases first;   ///< frame 0
    phases rest;    ///< all frames after it
    std::size_t frames = 0;
    std::string digest;
    std::vector<std::string> digests;      ///< up to each frame, of who played in a copy of this process
    std::string wrong;                     ///< what is answered otherwise than by the digest; empty where all is right
    std::uint64_t bytes = 0;               ///< held after the last of these frames
    aabb::work_counters work;              ///< over all frames
    std::vector<aabb::omission> left_out;  ///< by the stages, after the last of these frames

    /// Wall time of all frames that were played.
    [[nodiscard]] double whole_ms() const { return build.wall_ms + first.wall_ms() + rest.wall_ms(); }
    /// Of a frame after frame 0.
    [[nodiscard]] double steady_ms() const { return frames > 1 ? rest.wall_ms() / static_cast<double>(frames - 1) : 0; }
    /// The same, or of frame 0 where it is alone.
    [[nodiscard]] double frame_ms() const { return frames > 1 ? steady_ms() : first.wall_ms(); }
    /// Of so many frames, the further ones as fast as those that were played.
    [[nodiscard]] double over(double all_frames) const {
        return build.wall_ms + first.wall_ms() + (all_frames > 1 ? (all_frames - 1) * steady_ms() : 0);
    }
};

/// How a scene is played.
struct protocol {
    asking asked = {};
    std::size_t frames = std::numeric_limits<std::size_t>::max();  ///< at most
    aabb::instrumentation counted = aabb::instrumentation::none;
    /// Takes what is seen so far, after each frame.
    std::function<void(const observation&)> each = nullptr;
};

/// Plays a scene from its first frame on; it is told what is found. Of an external engine times are what it says of
/// itself, of wall time alone.
[[nodiscard]] observation observe(scene_play& scene, const contender& who, const protocol& how = {});
[[nodiscard]] observation observe(const scene_choice& scene, const contender& who, const protocol& how = {});

}  // namespace aabblab
