export module aabb.pipeline:detector;

import aabb.std;
import :basic_pipeline;
import :searched_by;

export namespace aabb {

/// In place of local detection, where objects are boxes.
struct boxes_only {};

/// Collision detection composed at compile time: what it is not made of has no code and no memory in it.
/// `detector<global_search<S, P, W>>` finds overlapping boxes; `detector<global_search<S, P, W>,
/// mesh_detection<B, T, R>>` finds intersecting triangles of moving meshes. A stage that counts its work is one with
/// `work_counters` as its last argument; one that prepares its boxes is a `prepared_search`.
template <class Search, class Detection = boxes_only>
class detector {
public:
    /// Builds the trees; every object is present.
    /// @param mesh_of the mesh of each object, by its place in `meshes`
    /// @throws input_error on an object of a mesh that is not there, and on a mesh that `require_valid` refuses.
    detector(std::vector<mesh> meshes, std::vector<std::uint32_t> mesh_of, Search search = Search(),
             Detection detection = Detection())
        : scene_(std::move(meshes), std::move(mesh_of)),
          search_(std::move(search)),
          detection_(std::move(detection)),
          pipeline_(scene_, search_, detection_) {}
    // Its parts refer to each other.
    detector(const detector&) = delete;
    detector& operator=(const detector&) = delete;

    /// An object that was removed comes back, or one goes; frames have a pose for it all the same.
    /// @throws input_error where there is no such object, where it is present already, or is not.
    void insert(std::uint32_t object) { pipeline_.insert(object); }
    void remove(std::uint32_t object) { pipeline_.remove(object); }

    /// A frame: every two triangles of two objects that intersect, each once, by objects a < b, in no particular order,
    /// until the next frame. Nothing is allocated once the buffers have grown to the scene.
    /// @param poses one an object, rigid (`require_rigid`), in the units of the meshes
    /// @throws input_error on a pose that is not rigid or takes an object beyond the range of float, by its number, and
    /// as `require_ieee_arithmetic`; the next frame may succeed.
    [[nodiscard]] std::span<const contact> contacts(std::span<const pose> poses) {
        find_candidates(poses);
        pipeline_.detect();
        return pipeline_.contacts();
    }
    /// The same frame for less: any one contact, or how many there are.
    /// @throws input_error as `contacts`.
    [[nodiscard]] std::optional<contact> first_contact(std::span<const pose> poses) {
        find_candidates(poses);
        return pipeline_.first_contact();
    }
    [[nodiscard]] std::uint64_t count_contacts(std::span<const pose> poses) {
        find_candidates(poses);
        return pipeline_.count_contacts();
    }
    /// Of the last frame: pairs of objects whose boxes overlap, a < b, in no particular order.
    [[nodiscard]] std::span<const index_pair> candidates() const noexcept { return pipeline_.candidates(); }

    [[nodiscard]] const Search& global() const noexcept { return search_; }
    [[nodiscard]] const Detection& local() const noexcept { return detection_; }
    /// Held on the heap beside the meshes, by part of both stages; "buffers" are between them and of what is found.
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

/// Of boxes.
template <class Search>
class detector<Search, boxes_only> {
public:
    detector() = default;
    explicit detector(Search search) : search_(std::move(search)) {}
    // As every detector: what strategies keep from frame to frame would be lost in the one that is moved from.
    detector(const detector&) = delete;
    detector& operator=(const detector&) = delete;

    /// An object comes (its id must not be present) or goes (its id must be); ids are places in the frames, and stay.
    /// @throws input_error where it is present already, or is not.
    void insert(std::uint32_t id) { search_.insert(id); }
    void remove(std::uint32_t id) { search_.remove(id); }

    /// A frame: every two present objects whose boxes overlap, each once, a < b, in no particular order, until the next
    /// frame. Nothing is allocated once the buffers have grown to the scene.
    /// @param boxes by id, also of who is not present; closed, so that touching is overlapping
    /// @throws input_error on a box that is not finite or inverted, where a present object has no box, where there are
    /// boxes but nothing was ever inserted, and as `require_ieee_arithmetic`; the next frame may succeed.
    [[nodiscard]] std::span<const index_pair> pairs(std::span<const box> boxes) {
        search_.update(boxes);
        pairs_.clear();
        search_.search(pairs_);
        return pairs_;
    }

    [[nodiscard]] const Search& global() const noexcept { return search_; }
    /// Held on the heap, by part of the search; "buffers" are of what is found.
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
