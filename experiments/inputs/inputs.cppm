/// Parses the arguments of commands: numbers, poses, meshes and scenes. Invalid arguments throw aabb::input_error.
export module aabblab.inputs;

import aabb.geometry;
import aabb.std;
import aabblab.scenes;

export namespace aabblab {

/// Parses a decimal or C99 hexadecimal number, correctly rounded to Real, which is float or double.
/// @throws aabb::input_error on anything else, NaN, infinity or overflow: "number 3 of 18: 'x' is not a number".
template <class Real>
[[nodiscard]] Real parse_number_of(const std::vector<std::string>& words, std::size_t i);

/// Parses an integer in the range.
/// @param expected the message before ", not 'x'"
[[nodiscard]] std::uint64_t parse_whole(const std::string& text, std::uint64_t least, std::uint64_t most,
                                        std::string_view expected);

/// Parses the value of --seconds, which is above 0 and at most a million.
/// @param to_do the activity that the time limits, as in "race"
[[nodiscard]] double seconds_of(const std::string& text, std::string_view to_do);

/// Splits a line of numbers, which are separated by blanks or a single comma.
/// @throws aabb::input_error on a comma without a number on each side.
[[nodiscard]] std::vector<std::string> split_numbers(std::string_view line);

/// Parses the pose in an option: twelve comma-separated numbers, the rows of [R t]. Without the option, it is identity.
/// @throws aabb::input_error that names the option if the text is malformed or the pose is singular.
[[nodiscard]] aabb::pose pose_of(const std::optional<std::string>& text, const char* option);

struct given_poses {
    std::vector<aabb::pose> poses;
    std::string file;                ///< empty if the pose is from an option
    std::vector<std::size_t> lines;  ///< the line of each pose, from 1

    /// The place of a pose in messages, "FILE:LINE: ".
    [[nodiscard]] std::string place_of(std::size_t pose) const {
        return file.empty() ? "" : file + ":" + std::to_string(lines[pose]) + ": ";
    }
};
/// Reads one pose per line, with commas or blanks between numbers; `#` begins a comment.
/// @throws aabb::input_error with file and line like `pose_of`, and on a file without poses.
[[nodiscard]] given_poses read_poses(const std::string& file);

/// Loads meshes by name, and prints a note about how reading changed each.
[[nodiscard]] std::vector<aabb::mesh> read_meshes(const std::vector<std::string>& names);

/// Prints a note about what is left out of each mesh file. Names are resolved as for scenes.
void note_left_out(const std::vector<std::string>& names, const std::filesystem::path& folder = {});

/// Rejects an output that would overwrite an input of the same command.
/// @throws aabb::input_error if both paths refer to the same file.
void require_other_file(const std::string& out, const std::string& input);

/// Rejects an output that would overwrite a mesh of the same command, here or in the data folder.
/// @throws aabb::input_error if `out` refers to one of them by any path.
void require_no_mesh(const std::string& out, const std::vector<std::string>& meshes);

/// Rejects two outputs to the same file.
/// @param a, b the options that name them
void require_two_files(const std::string& a, const std::string& file, const std::string& b, const std::string& other);

/// The arguments that commands accept in place of a config, for help texts.
inline constexpr const char* scene_arguments_help =
    "A recording (.aabbs); one or two meshes (files in OFF, OBJ, PLY, STL or glTF, or shapes), of which the second, "
    "or a copy of the only one, moves through the first; or a motion file and its meshes";

[[nodiscard]] bool is_config_name(const std::string& argument);

/// Whether the name is a shape or a file with a mesh extension; other files are motions.
[[nodiscard]] bool is_mesh_name(const std::string& name);

/// The scene that the arguments describe.
/// @throws aabb::input_error if they do not describe a scene.
[[nodiscard]] scene_choice scene_of_arguments(const std::vector<std::string>& arguments);

}  // namespace aabblab
