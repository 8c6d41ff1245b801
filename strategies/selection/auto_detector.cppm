/// A `detector` whose strategies are chosen at run time, by name or by `auto`.
export module aabb.auto_detector;

import aabb.collision_filter;
import aabb.pipeline;
import aabb.registry;
import aabb.selection;
import aabb.std;

export namespace aabb {

/// The default number of expected frames, large enough to choose strategies that are worth their cost in the long run.
inline constexpr std::size_t many_frames = 10'000;

/// Collision detection composed at run time: named strategies are kept, and the others are selected
/// (`select_strategies`). Only selected parts are constructed; a detector of boxes has no narrow phase.
///
/// Strategies are named as KIND=NAME or KIND=NAME:parameter=value,…: "sort=shell:gaps=ciura", "tree=compressed".
class auto_detector {
public:
    /// A detector of boxes.
    /// @param named at most one entry per kind
    /// @param frames expected number of frames
    /// @param filter leaves out pairs; may change between frames, must outlive the detector; null if all are wanted
    /// @throws input_error on an unknown kind, name or parameter, a kind that is named twice, a rejected combination,
    /// and a kind or strategy that needs meshes
    explicit auto_detector(const std::vector<std::string>& named = {}, std::size_t frames = many_frames,
                           const collision_filter* filter = nullptr);
    /// A detector of meshes: builds the trees; all objects are present.
    /// @param mesh_of index in `meshes` of each object's mesh
    /// @throws input_error as the other constructor, on an invalid mesh index, and as `require_valid`
    auto_detector(std::vector<mesh> meshes, std::vector<std::uint32_t> mesh_of,
                  const std::vector<std::string>& named = {}, std::size_t frames = many_frames,
                  const collision_filter* filter = nullptr);
    ~auto_detector();

    /// Inserts or removes an object; throws input_error as the `detector` of boxes or of meshes.
    void insert(std::uint32_t object);
    void remove(std::uint32_t object);

    /// As `global_stage::moved`: no other boxes have moved.
    /// @throws input_error if objects are meshes
    void moved(std::span<const std::uint32_t> objects);

    /// The overlapping pairs of a frame of boxes, as in `detector`.
    /// @throws input_error likewise, and if objects are meshes
    [[nodiscard]] std::span<const index_pair> pairs(std::span<const box> boxes);

    /// The contacts of a frame of meshes, as in `detector`.
    /// @throws input_error likewise, and if objects are boxes
    [[nodiscard]] std::span<const contact> contacts(std::span<const pose> poses);
    [[nodiscard]] std::optional<contact> first_contact(std::span<const pose> poses);
    [[nodiscard]] std::uint64_t count_contacts(std::span<const pose> poses);

    /// The strategy of each kind, and the rule by which it was selected.
    [[nodiscard]] std::span<const selected_strategy> selected() const noexcept { return selected_; }
    /// Heap bytes by part without the meshes, and the features that the stages lack.
    [[nodiscard]] std::vector<part_bytes> bytes() const;
    [[nodiscard]] std::vector<omission> left_out() const;

private:
    struct mesh_part;

    auto_detector(const named_strategies& named, const scene_traits& scene, const collision_filter* filter);
    [[nodiscard]] pipeline& find_candidates(std::span<const pose> poses);

    std::vector<selected_strategy> selected_;
    std::unique_ptr<global_stage> global_;
    std::vector<index_pair> pairs_;
    std::unique_ptr<mesh_part> meshes_;  // null if objects are boxes
};

}  // namespace aabb
