export module aabb.pipeline:scene;

import aabb.geometry;
import aabb.std;

// Scenes generate their frames one by one, from the first to the last, so only one frame is in memory. The run reports
// the pairs or contacts of each frame back to the scene, so that the next frame may depend on them.

export namespace aabb {

/// A scene of moving boxes; the index of a box is the id of its object.
class box_scene : public kept_in_place {
public:
    [[nodiscard]] virtual std::size_t objects() const = 0;
    /// Total number of frames, including the first one.
    [[nodiscard]] virtual std::size_t frames() const = 0;
    /// Generates the boxes of the next frame; returns false after the last.
    /// @throws input_error on a recording that is truncated or contains an invalid box
    virtual bool next(std::vector<box>& boxes) = 0;
    /// The boxes of the current frame in double, which decide what overlaps; those of `next` are then the same rounded
    /// to floats (`float_boxes`). Empty if the scene has floats.
    [[nodiscard]] virtual std::span<const boxd> in_double() const { return {}; }
    /// Whether each object is present in the current frame, by id, 0 or 1; empty if all are. The box of an absent
    /// object is valid and overlaps no other, so that a search which ignores this finds the same pairs.
    [[nodiscard]] virtual std::span<const std::uint8_t> present() const { return {}; }
    /// Takes the sorted overlapping pairs of the current frame, before the next one. Not called without a search.
    virtual void take_pairs(std::span<const index_pair> /*pairs*/) {}
};

/// A scene of meshes, whose objects are instances of them with a pose per frame.
class mesh_scene : public kept_in_place {
public:
    std::vector<mesh> meshes;
    std::vector<std::uint32_t> mesh_of;  ///< index of each object's mesh

    [[nodiscard]] virtual std::size_t frames() const = 0;
    /// Generates the next frame's poses, one per object, and deforms meshes; returns false after the last frame.
    virtual bool next(std::vector<pose>& poses) = 0;
    /// Whether vertices of this mesh move between frames, so that its trees and boxes must be refitted.
    [[nodiscard]] virtual bool deforms(std::uint32_t /*mesh*/) const { return false; }
    /// Whether later frames depend on the contacts, so that a run without them has different frames.
    [[nodiscard]] virtual bool reacts() const { return false; }
    /// Takes the frame's sorted contacts before the next one; a simulation steps here. Not called without a search.
    virtual void take_contacts(std::span<const contact> /*contacts*/) {}
};

/// Meshes and their objects without frames: the poses come from the user.
class given_scene final : public mesh_scene {
public:
    /// A scene of these meshes and of objects that are instances of them.
    /// @param objects index of each object's mesh
    /// @throws input_error on an invalid mesh index
    given_scene(std::vector<mesh> models, std::vector<std::uint32_t> objects) {
        for (std::size_t object = 0; object < objects.size(); ++object)
            if (objects[object] >= models.size())
                throw input_error("object " + std::to_string(object) + " is mesh " + std::to_string(objects[object]) +
                                  ", but there are " + std::to_string(models.size()) + " meshes");
        meshes = std::move(models);
        mesh_of = std::move(objects);
    }

    [[nodiscard]] std::size_t frames() const override { return 0; }
    bool next(std::vector<pose>& /*poses*/) override { return false; }
};

}  // namespace aabb
