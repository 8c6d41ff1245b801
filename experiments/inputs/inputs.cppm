/// What the user gives a command: numbers, poses, meshes and scenes. Everything wrong with it is an aabb::input_error.
export module aabblab.inputs;

import aabb.geometry;
import aabb.std;
import aabblab.scenes;

export namespace aabblab {

/// One of a series of numbers in decimal or C99 hexadecimal, correctly rounded to Real, which is float or double.
/// @throws aabb::input_error on anything else, NaN, infinity, or a number too large for Real: "number 3 of 18: 'x' is
/// not a number".
template <class Real>
[[nodiscard]] Real parse_number_of(const std::vector<std::string>& words, std::size_t i);

/// A whole number in this range.
/// @param expected the sentence before ", not 'x'"
[[nodiscard]] std::uint64_t parse_whole(const std::string& text, std::uint64_t least, std::uint64_t most,
                                        std::string_view expected);

/// Of --seconds, a number above 0, at most a million.
/// @param to_do what it is the time for, as in "race"
[[nodiscard]] double seconds_of(const std::string& text, std::string_view to_do);

/// The words of a line of numbers, with blanks or one comma between two of them.
/// @throws aabb::input_error on a comma that has no word on either side.
[[nodiscard]] std::vector<std::string> split_numbers(std::string_view line);

/// The pose that an option gives: twelve numbers with commas between, the rows of [R t]; without it, the mesh as it is.
/// @throws aabb::input_error that names the option, on anything else or a pose that is not rigid.
[[nodiscard]] aabb::pose pose_of(const std::optional<std::string>& text, const char* option);

struct given_poses {
    std::vector<aabb::pose> poses;
    std::string file;                ///< empty where there is none
    std::vector<std::size_t> lines;  ///< on which each stands, from 1

    /// "FILE:LINE: ", for messages.
    [[nodiscard]] std::string place_of(std::size_t pose) const {
        return file.empty() ? "" : file + ":" + std::to_string(lines[pose]) + ": ";
    }
};
/// One a line, with commas or blanks between numbers; `#` begins a comment.
/// @throws aabb::input_error with file and line, as `pose_of`, and on a file without poses.
[[nodiscard]] given_poses read_poses(const std::string& file);

/// Meshes by the names that the user gave them; what was done to them is said.
[[nodiscard]] std::vector<aabb::mesh> read_meshes(const std::vector<std::string>& names);

/// Reads those meshes that are files, and says what of each is left out. Names are looked for as scenes do.
void note_left_out(const std::vector<std::string>& names, const std::filesystem::path& folder = {});

/// Refuses to write over a file that the same command reads.
/// @throws aabb::input_error where `out` is `input`, by whatever path.
void require_other_file(const std::string& out, const std::string& input);

/// Refuses to write over a mesh that the same command reads, here or in the data folder.
/// @throws aabb::input_error where `out` is one of them, by whatever path.
void require_no_mesh(const std::string& out, const std::vector<std::string>& meshes);

/// Refuses two outputs in one file.
/// @param a, b the options that name them
void require_two_files(const std::string& a, const std::string& file, const std::string& b, const std::string& other);

/// What a command takes in place of a config, for help texts.
inline constexpr const char* scene_arguments_help =
    "A recording (.aabbs); one or two meshes (files in OFF, OBJ, PLY, STL or glTF, or shapes), which pass through each "
    "other; or a motion file and its meshes";

[[nodiscard]] bool names_config(const std::string& argument);

/// The scene that these arguments name.
/// @throws aabb::input_error where they name none.
[[nodiscard]] scene_choice scene_of_arguments(const std::vector<std::string>& arguments);

}  // namespace aabblab
