export module aabb.pipeline:scene;

import aabb.geometry;
import aabb.std;

// What happens in a scene, frame by frame; a scene is played once, from frame 0 to the last, so only one frame is held.
// Whoever searches its frames tells it what was found, so that what happens next may depend on it.

export namespace aabb {

/// Boxes that move. Object i of a frame is its box i.
class box_scene : public kept_in_place {
public:
    [[nodiscard]] virtual std::size_t objects() const = 0;
    /// Frames played in all, the first one included.
    [[nodiscard]] virtual std::size_t frames() const = 0;
    /// The boxes of the next frame; false after the last.
    /// @throws input_error on a recording that is cut off or holds a box that is not valid.
    virtual bool next(std::vector<box>& boxes) = 0;
    /// Which objects take part in the frame last played, by id, 0 or 1; empty where all do. The box of an absent object
    /// is valid and overlaps no other, so that whoever ignores this finds the same pairs.
    [[nodiscard]] virtual std::span<const std::uint8_t> present() const { return {}; }
    /// Takes the overlapping pairs of the frame last played, sorted, before it is asked for the next. A scene that is
    /// played without a search hears of none.
    virtual void take_pairs(std::span<const index_pair> /*pairs*/) {}
};

/// Meshes, which mesh each object is, and the objects' poses frame by frame.
class mesh_scene : public kept_in_place {
public:
    std::vector<mesh> meshes;
    std::vector<std::uint32_t> mesh_of;  ///< by object

    [[nodiscard]] virtual std::size_t frames() const = 0;
    /// The poses of the next frame, one an object; false after the last. Vertices of meshes that deform move too.
    virtual bool next(std::vector<pose>& poses) = 0;
    /// Whether vertices of this mesh move from frame to frame, so that trees and boxes of it must be fitted anew.
    [[nodiscard]] virtual bool deforms(std::uint32_t /*mesh*/) const { return false; }
    /// Whether what comes next hangs on contacts, so that a scene that hears of none is another.
    [[nodiscard]] virtual bool reacts() const { return false; }
    /// Takes the contacts of the frame last played, sorted, before it is asked for the next: stepping in time begins
    /// here. A scene that is played without a search hears of none.
    virtual void take_contacts(std::span<const contact> /*contacts*/) {}
};

/// Meshes and which one each object is, whose poses come from whoever has them: it plays no frames itself.
class given_scene final : public mesh_scene {
public:
    /// @param objects the mesh of each object, by its place in `all`
    /// @throws input_error on an object of a mesh that is not there.
    given_scene(std::vector<mesh> all, std::vector<std::uint32_t> objects) {
        for (std::size_t object = 0; object < objects.size(); ++object)
            if (objects[object] >= all.size())
                throw input_error("object " + std::to_string(object) + " is mesh " + std::to_string(objects[object]) +
                                  ", but there are " + std::to_string(all.size()) + " meshes");
        meshes = std::move(all);
        mesh_of = std::move(objects);
    }

    [[nodiscard]] std::size_t frames() const override { return 0; }
    bool next(std::vector<pose>& /*poses*/) override { return false; }
};

}  // namespace aabb
