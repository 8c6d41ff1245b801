/// What the kinds of scenes of meshes share.
module aabblab.scenes:posed_meshes;

import aabb.geometry;
import aabb.pipeline;
import aabb.std;
import :parameters;
import :rotation;

namespace aabblab {

/// A scene of meshes whose poses are made as it is played.
class generated_meshes : public aabb::mesh_scene {
public:
    [[nodiscard]] std::size_t frames() const final { return frames_; }

    bool next(std::vector<aabb::pose>& poses) final {
        if (played_ == frames_) return false;
        if (played_ > 0) advance();
        place(played_, poses);
        ++played_;
        return true;
    }

protected:
    /// @param frames after the first one
    generated_meshes(std::uint32_t frames, std::vector<aabb::mesh> given, scaling each)
        : frames_(std::size_t{frames} + 1) {
        meshes = std::move(given);
        if (each == scaling::yes)
            for (aabb::mesh& m : meshes) normalise(m);
    }

    /// From one frame to the next.
    virtual void advance() = 0;
    /// @param frame its number, from 0
    virtual void place(std::size_t frame, std::vector<aabb::pose>& poses) = 0;
    [[nodiscard]] std::size_t played() const { return played_; }

private:
    std::size_t frames_;
    std::size_t played_ = 0;
};

}  // namespace aabblab
