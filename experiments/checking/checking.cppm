/// Compares a list of pairs, such as an engine's, with the ground truth: which pairs are wrong, of which class, and
/// what they have in common; and reduces the scene to the smallest one in which a program is wrong.
export module aabblab.checking;

import aabb.geometry;
import aabb.pipeline;
import aabb.std;
import aabblab.inputs;
import aabblab.queries;
import aabblab.trials;

export namespace aabblab {

/// A row of a list: a frame and the ids of two objects, or a pose and two triangles.
struct listed_pair {
    std::uint32_t frame = 0;
    aabb::index_pair pair{};

    friend auto operator<=>(const listed_pair&, const listed_pair&) = default;
};

/// The value of -1 in a list, so that 1 more is 0. Other ids and frames that fit no scene, negative ones and those from
/// 2^32 - 2, have the value before it.
inline constexpr std::uint32_t beyond_all = std::numeric_limits<std::uint32_t>::max();

struct pair_list {
    std::vector<listed_pair> rows;
    bool has_frames = false;   ///< otherwise all rows are of frame 0
    bool is_by_frame = false;  ///< whether rows are known to be in the order of their frames
};

/// Reads a list of pairs: text with commas, semicolons or blanks between integers, with or without a header; the array
/// of an .npy file; or an object with columns and rows in a .json file. Columns are frame, a and b, or only a and b; a
/// header names them in any order, among others.
/// @param may_have_frames if not, of three columns without a header the last is ignored
/// @throws aabb::input_error with file and line if a row has other columns or anything but integers.
[[nodiscard]] pair_list read_pair_list(const std::filesystem::path& file, bool may_have_frames = true);

/// A row of a list of contacts of moving meshes.
struct listed_contact {
    std::uint32_t frame = 0;
    aabb::contact contact{};
};

struct contact_list {
    std::vector<listed_contact> rows;
    bool has_frames = false;
};

/// The same for columns object_a, object_b, triangle_a and triangle_b, perhaps with a frame.
[[nodiscard]] contact_list read_contact_list(const std::filesystem::path& file);

/// The wrong pairs of a class.
struct class_counts {
    std::string name;
    std::uint64_t false_negatives = 0, false_positives = 0;
};

struct wrong_pair {
    std::uint32_t frame = 0;
    aabb::index_pair pair{};
    bool is_listed = false;                     ///< a false positive; otherwise a false negative
    std::optional<aabb::index_pair> objects{};  ///< of a contact, whose triangles are the pair
    std::string description{};                  ///< its class, and its gap
    std::vector<std::string> shapes{};          ///< both boxes or triangles in decimal and hexadecimal, a line each
};

struct wrong_frame {
    std::uint32_t frame = 0;
    std::uint64_t false_negatives = 0, false_positives = 0;
};

struct check_result {
    std::uint64_t listed = 0;            ///< rows
    std::uint64_t expected = 0;          ///< pairs of the ground truth
    std::uint64_t correct = 0;           ///< pairs of both
    std::uint64_t duplicates = 0;        ///< rows that repeat a pair, in either order of its ids where it has none
    std::uint64_t self_pairs = 0;        ///< rows with the same object or triangle twice
    std::uint64_t unknown_ids = 0;       ///< rows with an id that the scene does not have
    std::uint64_t unknown_frames = 0;    ///< rows with a frame that the scene does not have
    std::vector<class_counts> classes;   ///< all classes; together the false negatives and false positives
    std::uint64_t unclassified = 0;      ///< wrong pairs beyond the first `most_classified`
    std::vector<wrong_frame> frames;     ///< those with wrong pairs
    std::vector<wrong_pair> first;       ///< at most `most_shown`
    std::vector<std::string> patterns;   ///< what the wrong pairs have in common, in sentences
    double search_ms = 0, check_ms = 0;  ///< for the ground truth; for the comparison

    [[nodiscard]] std::uint64_t false_negatives() const { return expected - correct; }
    [[nodiscard]] std::uint64_t false_positives() const;
    [[nodiscard]] bool is_right() const {
        return correct == expected && false_positives() + duplicates + self_pairs + unknown_ids + unknown_frames == 0;
    }
};
inline constexpr std::size_t most_shown = 10;

/// Checks a list of overlapping boxes in every frame of a scene, of the pairs that its filter keeps.
/// @param within if the list is of the boxes that are so near each other
/// @throws aabb::input_error if the list has no frames although the scene has several.
[[nodiscard]] check_result check_boxes(scene_frames& scene, const pair_list& list,
                                       const std::optional<nearness>& within = {});

/// Checks a list of contacts, or of triangles that are near each other, in every frame of a scene of meshes.
/// @param touching whether those count that only touch, in a point or along a segment
/// @throws aabb::input_error likewise, and if the objects have 2^32 - 1 triangles or more in all.
[[nodiscard]] check_result check_contacts(scene_frames& scene, const contact_list& list,
                                          const std::optional<nearness>& within = {}, bool touching = true);

/// The meshes and poses of `check_triangles`, as for `search_meshes`.
struct mesh_check {
    std::vector<aabb::mesh> meshes;  ///< one with `self`, else two
    aabb::pose pose_a = {};
    given_poses poses_b = {{aabb::pose{}}, {}, {}};
    std::optional<self_pairs> self = {};
    std::optional<nearness> within = {};
    bool touching = true;      ///< whether pairs count that only touch
    std::string between = {};  ///< for messages
};
/// Checks a list of intersecting triangles of two meshes, in every pose, or of one mesh with itself.
[[nodiscard]] check_result check_triangles(const mesh_check& meshes, const pair_list& list);

/// What a list is of, for reports.
struct checked_list {
    std::string scene, list;         ///< names
    std::string objects = "object";  ///< or "triangle"
    std::string frames = "frame";    ///< or "pose"
};
[[nodiscard]] std::string text_of(const check_result& result, const checked_list& of);
/// The same in one paragraph, with fewer pairs and without their shapes.
[[nodiscard]] std::string brief_text_of(const check_result& result, const checked_list& of);
[[nodiscard]] std::string json_of(const check_result& result, const checked_list& of);

/// A program that writes a list of pairs: a command line for the shell, to which the names of its input and output
/// files are appended.
struct checked_program {
    std::string command;
    std::chrono::seconds timeout{600};
};

/// Runs the program on a scene of boxes, and returns its list.
/// @throws aabb::input_error if it fails or writes no list.
[[nodiscard]] pair_list list_of(const checked_program& program, const std::filesystem::path& recording);
[[nodiscard]] pair_list list_of(const checked_program& program, const std::vector<aabb::mesh>& meshes);

/// The number of rows that only one of two lists has; in any order.
[[nodiscard]] std::size_t count_different_rows(pair_list first, pair_list second);

/// The smallest scene that was found in which the program's list is wrong.
struct smallest_scene {
    std::size_t objects = 0, frames = 0;
    std::size_t runs = 0;  ///< of the program
};
/// Reduces a scene of boxes in which the program is wrong: first the frames, then the objects. Writes it to the file,
/// in the format of its ending, which the program reads.
/// @param first a wrong pair of the whole scene
[[nodiscard]] smallest_scene reduce_boxes(const checked_program& program, std::unique_ptr<aabb::box_scene> scene,
                                          const wrong_pair& first, const std::filesystem::path& file);
/// Reduces meshes to fewer triangles, and writes them as OFF files.
[[nodiscard]] smallest_scene reduce_meshes(const checked_program& program, const mesh_check& meshes,
                                           const wrong_pair& first, const std::vector<std::filesystem::path>& files);

}  // namespace aabblab
