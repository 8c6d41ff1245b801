/// Trials in copies of this process, which may take too long or too much memory.
export module aabblab.trials:staged_scene;

import aabb.std;
import aabblab.scenes;
import :isolation;
import :observation;
import :player;

export namespace aabblab {

/// A play in a copy of this process.
struct attempt {
    ending end = ending::stopped;
    observation seen;              ///< of the frames that it came to the end of
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

}  // namespace aabblab
