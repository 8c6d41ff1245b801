/// The motion from one mesh's frame to another's, where lengths in both frames are those in the world.
export module aabb.distance.rigid_motion;

export import aabb.local_detection;
import aabb.std;

export namespace aabb {

/// Two points at a distance of d have at most the distance `most_stretch` d / scale in A's frame, whose floats have
/// that scale: a rigid motion keeps lengths within 2^-18.
inline constexpr double most_stretch = 1 + 0x1p-17;

/// The motion from B's frame to A's, if there is one that keeps lengths.
template <TreePolicy Tree>
[[nodiscard]] std::optional<relative_pose> rigid_motion(const model<Tree>& a, const pose& pose_a, const model<Tree>& b,
                                                        const pose& pose_b) {
    try {
        const relative_pose to_a = pose_relative_to(a, pose_a, b, pose_b);
        return to_a.is_rigid() ? std::optional(to_a) : std::nullopt;
    } catch (const input_error&) {
        return std::nullopt;
    }
}

}  // namespace aabb
