/// Pictures of scenes, for people to see at a glance what a scene is.
export module aabblab.picture;

import aabb.std;

export import :survey;

export namespace aabblab {

/// What stands above the drawing.
struct picture_caption {
    std::string name;
    std::string summary;
    std::string parameters;
};

/// The first and the last frame as SVG, projected along the axis on which the scene is narrowest; those that overlap
/// another are told apart. Of many boxes the largest and a sample of the others are drawn.
/// @param seen at least one frame
[[nodiscard]] std::string picture_of(const survey& seen, const picture_caption& caption);

}  // namespace aabblab
