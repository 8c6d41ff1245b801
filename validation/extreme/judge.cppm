export module aabb.extreme:judge;

import aabb.pipeline;
import aabb.std;
import aabb.truth;
import :exact_frames;
import :scene;

export namespace aabb {

enum class verdict : std::uint8_t {
    exact,    ///< every answer to every query is the exact one
    refused,  ///< an input_error came in place of an answer
    wrong,
};
inline constexpr std::array<std::string_view, 3> verdict_names = {"exact", "refused", "wrong"};

/// How one stage did in one scene, over all frames.
struct judgement {
    verdict said = verdict::exact;
    std::string reason;          ///< the sentence of the refusal, or the first thing that is wrong
    std::uint64_t missing = 0;   ///< pairs of the exact answer that were not reported
    std::uint64_t invented = 0;  ///< reported, but not so often in the exact answer
    differences classes;         ///< the same of triangles, by class; a pair that is reported too often counts once
    std::size_t bytes = 0;       ///< that the stage holds in the end
};

/// Holds stages against the exact answer on a scene, which it works out by the definition: boxes in a double loop,
/// triangles by CGAL's exact kernel on every two of them, whether or not their boxes overlap.
class extreme_judge {
public:
    explicit extreme_judge(extreme_scene scene);

    [[nodiscard]] const extreme_scene& scene() const { return scene_; }

    /// Plays the scene of boxes, or of meshes, from its first frame to its last; every two meshes are candidates. In
    /// other arithmetic than that of IEEE 754 the stage is made and filled in that one, then asked each query in the
    /// other.
    [[nodiscard]] judgement judge(const std::function<std::unique_ptr<global_stage>()>& make) const;
    [[nodiscard]] judgement judge(const std::function<std::unique_ptr<local_stage>()>& make) const;

private:
    extreme_scene scene_;
    exact_boxes boxes_;    // empty in a scene of meshes, and where all must refuse
    exact_meshes meshes_;  // the same the other way round
};

/// Whether the stage did what the scene expects: the exact answer, or the refusal with this sentence. One that need not
/// be exact must refuse all the same.
[[nodiscard]] bool is_as_expected(const extreme_scene& scene, const judgement& made, bool must_be_exact = true);

/// Makes an exact answer wrong that took more memory than the scene states.
void require_stated_memory(const extreme_scene& scene, judgement& made);

}  // namespace aabb
