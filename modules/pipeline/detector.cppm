export module aabb.pipeline:detector;

import aabb.std;
import :basic_pipeline;
import :searched_by;

export namespace aabb {

/// Replaces the narrow phase if objects are boxes.
struct boxes_only {};

/// Collision detection composed at compile time: unused strategies take no code and no memory.
/// `detector<global_search<S, P, W>>` finds overlapping boxes; `detector<global_search<S, P, W>,
/// mesh_detection<B, T, R>>` finds intersecting triangles of moving meshes. With `work_counters` as the last argument a
/// stage counts its work; a `prepared_search` prepares its boxes.
template <class Search, class Detection = boxes_only>
class detector {
public:
    /// Builds the trees; all objects are present.
    /// @param mesh_of index in `meshes` of each object's mesh
    /// @throws input_error on an invalid mesh index, and on a mesh that `require_valid` rejects
    detector(std::vector<mesh> meshes, std::vector<std::uint32_t> mesh_of, Search search = Search(),
             Detection detection = Detection())
        : scene_(std::move(meshes), std::move(mesh_of)),
          search_(std::move(search)),
          detection_(std::move(detection)),
          pipeline_(scene_, search_, detection_) {}
    // Not copyable, since its members refer to each other.
    detector(const detector&) = delete;
    detector& operator=(const detector&) = delete;

    /// Inserts a removed object again, or removes one; frames contain poses of removed objects, too.
    /// @throws input_error if the object does not exist, is already present, or is not present
    void insert(std::uint32_t object) { pipeline_.insert(object); }
    void remove(std::uint32_t object) { pipeline_.remove(object); }

    /// Processes a frame: returns every pair of intersecting triangles of two objects once, by objects a < b, in
    /// unspecified order, valid until the next frame. Nothing is allocated once the buffers have grown to the scene.
    /// @param poses one pose of full rank (`require_full_rank`) per object, in the units of the meshes
    /// @throws input_error on a pose that is singular or moves an object beyond the range of float, with its number,
    /// and as `require_ieee_arithmetic`; the next frame may succeed
    [[nodiscard]] std::span<const contact> contacts(std::span<const pose> poses) {
        find_candidates(poses);
        pipeline_.detect();
        return pipeline_.contacts();
    }
    /// Cheaper queries of a frame: some contact, or the number of contacts.
    /// @throws input_error as `contacts`
    [[nodiscard]] std::optional<contact> first_contact(std::span<const pose> poses) {
        find_candidates(poses);
        return pipeline_.first_contact();
    }
    [[nodiscard]] std::uint64_t count_contacts(std::span<const pose> poses) {
        find_candidates(poses);
        return pipeline_.count_contacts();
    }
    /// The pairs of objects a < b whose boxes overlap in the last frame, in unspecified order.
    [[nodiscard]] std::span<const index_pair> candidates() const noexcept { return pipeline_.candidates(); }
    [[nodiscard]] const Search& global() const noexcept { return search_; }
    [[nodiscard]] const Detection& local() const noexcept { return detection_; }
    /// Heap bytes without the meshes, by part of both stages; "buffers" hold candidates and contacts.
    [[nodiscard]] std::vector<part_bytes> bytes() const {
        std::vector<part_bytes> parts = bytes_by_part(search_);
        for (part_bytes& part : detection_.bytes()) parts.push_back(std::move(part));
        parts.push_back({"buffers", pipeline_.bytes() + pipeline_.division_bytes()});
        return parts;
    }

private:
    void find_candidates(std::span<const pose> poses) {
        pipeline_.update(poses);
        pipeline_.search();
    }

    given_scene scene_;
    Search search_;
    Detection detection_;
    basic_pipeline<Search, Detection> pipeline_;
};

/// The specialization for boxes.
template <class Search>
class detector<Search, boxes_only> {
public:
    detector() = default;
    explicit detector(Search search) : search_(std::move(search)) {}
    // Not movable, as any detector: a move would leave strategies without the state that they keep between frames.
    detector(const detector&) = delete;
    detector& operator=(const detector&) = delete;

    /// Inserts or removes an object; its id is its stable index in the boxes of all frames.
    /// @throws input_error if the object to insert is already present, or the object to remove is not
    void insert(std::uint32_t id) { search_.insert(id); }
    void remove(std::uint32_t id) { search_.remove(id); }

    /// As `global_stage::moved`: no other objects have moved.
    void moved(std::span<const std::uint32_t> ids) {
        if constexpr (requires { search_.moved(ids); }) search_.moved(ids);
    }

    /// Processes a frame: returns every pair of present objects whose boxes overlap once, a < b, in unspecified order,
    /// valid until the next frame. Nothing is allocated once the buffers have grown to the scene.
    /// @param boxes by id, including absent objects; closed, so that touching counts as overlapping
    /// @throws input_error on a box that is not finite or inverted, if a present object has no box, if there are boxes
    /// but no object was ever inserted, and as `require_ieee_arithmetic`; the next frame may succeed
    [[nodiscard]] std::span<const index_pair> pairs(std::span<const box> boxes) {
        search_.update(boxes);
        pairs_.clear();
        search_.search(pairs_);
        return pairs_;
    }

    [[nodiscard]] const Search& global() const noexcept { return search_; }
    /// Heap bytes by part of the search; "buffers" hold the pairs.
    [[nodiscard]] std::vector<part_bytes> bytes() const {
        std::vector<part_bytes> parts = bytes_by_part(search_);
        parts.push_back({"buffers", bytes_of(pairs_)});
        return parts;
    }

private:
    Search search_;
    std::vector<index_pair> pairs_;
};

}  // namespace aabb
