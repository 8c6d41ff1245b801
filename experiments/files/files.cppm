/// Reads and writes the user's files: meshes, recordings of boxes, motions, pairs. Each error in a file is an
/// input_error whose message names the file, the line if there is one, and what was expected.
export module aabblab.files;

import aabb.pipeline;
import aabb.std;
export import :comment;
export import :loaded_mesh;

export namespace aabblab {

/// Reads OFF, OBJ, PLY, STL (text or binary) or glTF; the file's extension selects the format.
/// @throws aabb::input_error if the file is missing, malformed or without triangles, or a face has an invalid vertex.
[[nodiscard]] loaded_mesh read_mesh(const std::filesystem::path& file);

/// The contents of a regular file, which may be empty.
/// @throws aabb::input_error if it is not a regular file or cannot be read.
[[nodiscard]] std::string bytes_of_file(const std::filesystem::path& file);

/// The text of a file. Every text reader accepts what programs on many systems write: byte order marks and trailing
/// NULs and Ctrl-Z are dropped, UTF-16 with a mark is converted, and carriage returns alone become line feeds.
/// @throws aabb::input_error like `bytes_of_file`, and if the file is not such text.
[[nodiscard]] std::string text_of_file(const std::filesystem::path& file);

/// Reads files, pipes and devices, up to one byte beyond `most`, so that the caller can detect too long a text.
/// @throws aabb::input_error also if a named pipe has no writer.
[[nodiscard]] std::string text_of_file(const std::filesystem::path& file, std::size_t most);

/// Streams the lines of a file, a pipe, a device or standard input, decoded as by `text_of_file`, with bounded memory.
class line_stream {
public:
    /// @param name replaces the file's name in messages
    explicit line_stream(const std::filesystem::path& file, const std::string& name = {});
    /// Reads standard input.
    line_stream();
    line_stream(line_stream&&) noexcept;
    ~line_stream();

    /// Advances to the next line; false after the last one.
    bool next();
    /// The line without its terminator; valid until the next call of `next`.
    [[nodiscard]] std::string_view line() const noexcept;
    /// The line number, from 1.
    [[nodiscard]] std::size_t number() const noexcept;
    /// Throws an input_error: "FILE:LINE: SENTENCE".
    [[noreturn]] void fail(const std::string& sentence) const;

    /// The file size in bytes; 0 if it is unknown.
    [[nodiscard]] std::uintmax_t size() const noexcept;
    [[nodiscard]] std::uintmax_t bytes_read() const noexcept;

private:
    struct state;
    std::unique_ptr<state> state_;
};

/// Rejects work that does not fit into the machine's memory before anything is allocated.
/// @throws aabb::input_error that names the work and its size.
void require_memory(const std::string& work, double bytes);

/// The file's extension in lower case, which selects the mesh format.
[[nodiscard]] std::string mesh_ending_of(const std::filesystem::path& file);

/// The extensions of the supported mesh formats, such as ".off".
[[nodiscard]] std::vector<std::string> mesh_endings();

/// Writes OFF with the shortest decimals that read back as the same doubles.
void write_off(const aabb::mesh& mesh, const std::filesystem::path& file);

/// Opens a motion file that moves these meshes: object i has mesh i modulo their number. Each line holds a frame, an
/// object and twelve numbers, the rows of its pose [R t]; `#` begins a comment. Frames count from 0 in ascending order;
/// frame 0 places every object, later frames list only objects that moved, and frames without motion may be omitted.
/// @throws aabb::input_error with file and line on malformed lines, singular poses, or more meshes than objects.
[[nodiscard]] std::unique_ptr<aabb::mesh_scene> open_motion(const std::filesystem::path& file,
                                                            std::vector<aabb::mesh> meshes);

/// Opens a recording (.aabbs) as a scene that reads one frame at a time.
/// @throws aabb::input_error if the header is truncated, malformed or inconsistent with the file size, or announces
/// more than a million frames without objects.
[[nodiscard]] std::unique_ptr<aabb::box_scene> open_recording(const std::filesystem::path& file);

/// An array of an .npy file, in row-major order.
template <class Number>
struct number_array {
    std::vector<std::size_t> shape;
    std::vector<Number> values;
};
/// Reads an array of integers, of 16 to 64 bits.
/// @throws aabb::input_error if the file is no array, ends early, or has other values.
[[nodiscard]] number_array<std::int64_t> read_npy_integers(const std::filesystem::path& file);
/// Reads an array of floats or doubles.
[[nodiscard]] number_array<double> read_npy_reals(const std::filesystem::path& file);
/// The header of an .npy file, of the same length for every shape.
/// @param type of the values, as NumPy writes it: "<u4"
[[nodiscard]] std::string npy_header(std::string_view type, std::span<const std::size_t> shape);

/// The endings of files of boxes: .aabbs, a recording; .csv; .npy.
[[nodiscard]] bool is_file_of_boxes(const std::filesystem::path& file);
/// Opens a file of boxes in the format of its ending. A table has rows of six coordinates, the least and the greatest
/// x, y and z, perhaps preceded by the object, or by frame and object; an array has the shape (frames, objects, 6) or
/// (frames, objects, 2, 3), or for one frame the same without frames. Boxes are floats if all coordinates are.
/// @throws aabb::input_error with the file, and in text the line, if a frame lacks an object or a box is invalid
[[nodiscard]] std::unique_ptr<aabb::box_scene> open_boxes(const std::filesystem::path& file);
/// Writes the scene to its end in the format of the file's ending. `progress` receives the number of frames done.
void write_boxes(aabb::box_scene& scene, const std::filesystem::path& file,
                 const std::function<void(std::size_t)>& progress);

/// Records the scene to its end. `progress` receives the number of frames done. A failure leaves no partial file.
/// @throws aabb::input_error if the file cannot be written or would not fit on the disk.
void write_recording(aabb::box_scene& scene, const std::string& name, const std::string& type,
                     const std::filesystem::path& file, const std::function<void(std::size_t)>& progress);

/// An atomically written file: it appears under its name only on `commit`, so an interrupted process leaves nothing
/// behind. Pipes and devices, such as /dev/stdout, are written directly. Every member throws aabb::input_error.
class output_file {
public:
    explicit output_file(const std::filesystem::path& file);
    ~output_file();
    /// Rejects output for which the disk has no space before anything is written.
    void require_space(double bytes) const;
    void write(const void* data, std::size_t bytes);
    void write(const std::string& text) { write(text.data(), text.size()); }
    /// Replaces bytes that are already written; later writes still append.
    void overwrite(std::uint64_t offset, const void* data, std::size_t bytes);
    void commit();

private:
    struct state;
    std::unique_ptr<state> state_;
};

/// Writes a text file atomically.
void write_file(const std::filesystem::path& file, const std::string& text);

/// Writes a motion file: every object in every frame, in the shortest decimals that round-trip to the doubles.
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
