/// Files of the user: meshes, recordings of boxes, pairs. Everything wrong with one is an input_error whose sentence
/// names the file, the line where there is one, and what was expected.
export module aabblab.files;

import aabb.pipeline;
import aabb.std;
export import :comment;
export import :loaded_mesh;

export namespace aabblab {

/// Reads OFF, OBJ, PLY, STL (text or binary) or glTF, by the file's ending.
/// @throws aabb::input_error on a file that is missing, empty, malformed, truncated or without triangles, with NaN or
/// infinity in a vertex that a face uses, or an index out of range.
[[nodiscard]] loaded_mesh read_mesh(const std::filesystem::path& file);

/// The bytes of a regular file, of which there may be none.
/// @throws aabb::input_error where it is something else or cannot be read.
[[nodiscard]] std::string bytes_of_file(const std::filesystem::path& file);

/// The text of a file as `bytes_of_file` reads it. Every reader of text reads what programs of many systems write: a
/// byte order mark is dropped, UTF-16 that begins with one is converted, carriage returns become line feeds where lines
/// end in them alone, and NULs and Ctrl-Z at the end of the file are dropped.
/// @throws aabb::input_error where it is no such text, too.
[[nodiscard]] std::string text_of_file(const std::filesystem::path& file);

/// The same of a file that may be a pipe or a device: at most one byte too many, which shows that it is too long.
/// @throws aabb::input_error where nobody writes into a named pipe, too.
[[nodiscard]] std::string text_of_file(const std::filesystem::path& file, std::size_t most);

/// Lines of a file, a pipe, a device or standard input as they come, of which only some are held at a time: text as
/// `text_of_file` reads it. All that reads throws aabb::input_error.
class line_stream {
public:
    /// @param name for messages, in place of the file's
    explicit line_stream(const std::filesystem::path& file, const std::string& name = {});
    /// Of standard input.
    line_stream();
    line_stream(line_stream&&) noexcept;
    ~line_stream();

    /// Goes to the next line; false after the last.
    bool next();
    /// Without its end; as long as no other is asked for.
    [[nodiscard]] std::string_view line() const noexcept;
    /// From 1.
    [[nodiscard]] std::size_t number() const noexcept;
    /// "FILE:LINE: SENTENCE"
    [[noreturn]] void fail(const std::string& sentence) const;

    /// Of its bytes; 0 where that is not known.
    [[nodiscard]] std::uintmax_t size() const noexcept;
    [[nodiscard]] std::uintmax_t bytes_read() const noexcept;

private:
    struct state;
    std::unique_ptr<state> state_;
};

/// Refuses work that does not fit into the machine's memory, before anything is allocated.
/// @throws aabb::input_error that says what takes how many bytes.
void require_memory(const std::string& what, double bytes);

/// By which a mesh file's format is chosen, in lower case.
[[nodiscard]] std::string mesh_ending_of(const std::filesystem::path& file);

/// The endings of mesh files, ".off" and so on.
[[nodiscard]] std::vector<std::string> mesh_endings();

/// Writes OFF with the shortest decimals that read back to the same floats.
void write_off(const aabb::mesh& mesh, const std::filesystem::path& file);

/// Opens a motion file for playing with these meshes: object i is mesh i modulo their number. A line is a frame, an
/// object and twelve numbers, the rows of its pose [R t]; `#` begins a comment. Frames are numbered from 0 and stand in
/// order; frame 0 has every object, later ones those that have moved, so that one in which none has may be left out.
/// @throws aabb::input_error, with file and line, on anything else, a pose that is not rigid, or more meshes than
/// objects.
[[nodiscard]] std::unique_ptr<aabb::mesh_scene> open_motion(const std::filesystem::path& file,
                                                            std::vector<aabb::mesh> meshes);

/// Opens a recording (.aabbs) for playing; frames are read one by one.
/// @throws aabb::input_error where the header is cut off, is not one, lies about the file's size, or announces a
/// million frames or more of nothing.
[[nodiscard]] std::unique_ptr<aabb::box_scene> open_recording(const std::filesystem::path& file);

/// Plays the scene to its end into a recording. `progress` hears frames done. Nothing half-written stays behind.
/// @throws aabb::input_error when the file cannot be written or would not fit on the disk.
void write_recording(aabb::box_scene& scene, const std::string& name, const std::string& type,
                     const std::filesystem::path& file, const std::function<void(std::size_t)>& progress);

/// A file that appears under its name only when it is complete; gone if not committed. Until then it has no name,
/// or one beside it where the file system needs one, so that an interrupted process leaves nothing behind. What is no
/// regular file, such as /dev/stdout, is written at once. Every member throws aabb::input_error when writing fails.
class output_file {
public:
    explicit output_file(const std::filesystem::path& file);
    output_file(const output_file&) = delete;
    output_file& operator=(const output_file&) = delete;
    ~output_file();
    /// Refuses, before anything is written, what the disk has no room for.
    void require_space(double bytes) const;
    void write(const void* data, std::size_t bytes);
    void write(const std::string& text);
    /// Replaces bytes already written; what is written next still goes to the end.
    void overwrite(std::uint64_t offset, const void* data, std::size_t bytes);
    void commit();

private:
    struct state;
    std::unique_ptr<state> state_;
};

/// Writes a text file, whole or not at all.
void write_file(const std::filesystem::path& file, const std::string& text);

/// A motion file in the making: every object in every frame, in the shortest decimals that read back to the doubles.
class motion_file {
public:
    explicit motion_file(const std::filesystem::path& file) : out_(file) {}
    void add(std::span<const aabb::pose> poses);
    void commit() { out_.commit(); }

private:
    output_file out_;
    std::size_t frames_ = 0;
};

}  // namespace aabblab
