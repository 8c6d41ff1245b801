/// `detector` for those who choose when the program runs, or let `auto` choose.
export module aabb.auto_detector;

import aabb.pipeline;
import aabb.registry;
import aabb.selection;
import aabb.std;

export namespace aabb {

/// How long a detector is to serve where nobody knows: for so many frames that whatever pays in the long run is chosen.
inline constexpr std::size_t many_frames = 10'000;

/// Collision detection composed at run time: what is named stays, the rest is selected (`select_strategies`). Only
/// what is selected is made; one of boxes has no part for meshes.
///
/// Strategies are named as KIND=NAME or KIND=NAME:parameter=value,…: "sort=shell:gaps=ciura", "tree=compressed".
class auto_detector {
public:
    /// Of boxes; the other functions say what it is to be asked then.
    /// @param named one line a kind, or none
    /// @param frames how many there will be, about
    /// @throws input_error on an unknown kind, name or parameter, a kind that is named twice, a combination that makes
    /// no sense, and a kind or a strategy that has no use for boxes alone.
    explicit auto_detector(const std::vector<std::string>& named = {}, std::size_t frames = many_frames);
    /// Of meshes: builds the trees; every object is present.
    /// @param mesh_of the mesh of each object, by its place in `meshes`
    /// @throws input_error as the other, on an object of a mesh that is not there, and as `require_valid`.
    auto_detector(std::vector<mesh> meshes, std::vector<std::uint32_t> mesh_of,
                  const std::vector<std::string>& named = {}, std::size_t frames = many_frames);
    // Its parts refer to each other.
    auto_detector(const auto_detector&) = delete;
    auto_detector& operator=(const auto_detector&) = delete;
    ~auto_detector();

    /// An object comes or goes, as in `detector` of boxes, or of meshes.
    /// @throws input_error as they do.
    void insert(std::uint32_t object);
    void remove(std::uint32_t object);

    /// Of boxes: a frame, as in `detector`.
    /// @throws input_error as there, and where objects are meshes.
    [[nodiscard]] std::span<const index_pair> pairs(std::span<const box> boxes);

    /// Of meshes: a frame, as in `detector`.
    /// @throws input_error as there, and where objects are boxes.
    [[nodiscard]] std::span<const contact> contacts(std::span<const pose> poses);
    [[nodiscard]] std::optional<contact> first_contact(std::span<const pose> poses);
    [[nodiscard]] std::uint64_t count_contacts(std::span<const pose> poses);

    /// What each kind of the stages that are there got, and by which rule.
    [[nodiscard]] std::span<const selected_strategy> selected() const noexcept { return selected_; }
    /// What is held on the heap beside the meshes, by part, and what is done without.
    [[nodiscard]] std::vector<part_bytes> bytes() const;
    [[nodiscard]] std::vector<omission> left_out() const;

private:
    struct mesh_part;

    auto_detector(const named_strategies& named, const scene_outlook& scene);
    [[nodiscard]] pipeline& searched(std::span<const pose> poses);

    std::vector<selected_strategy> selected_;
    std::unique_ptr<global_stage> global_;
    std::vector<index_pair> pairs_;
    std::unique_ptr<mesh_part> meshes_;  // where objects are meshes
};

}  // namespace aabb
