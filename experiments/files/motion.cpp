module aabblab.files;

import aabblab.fmt;
import :text_scanner;

namespace aabblab {

namespace {

/// A line of the file: the pose of an object from a frame on.
struct step {
    std::uint32_t frame;
    std::uint32_t object;
    aabb::pose pose;
};

/// The numbers of a line in the order of the format, whatever their order in the file: frame and object, then the rows
/// of [R t], or the translation and a quaternion x, y, z, w.
class motion_columns {
public:
    static constexpr std::size_t ids = 2, of_matrix = 12, of_quaternion = 7;

    /// The columns of lines without a header; empty if they are neither 14 nor 9.
    static std::optional<motion_columns> by_place(std::size_t count) {
        if (count != ids + of_matrix && count != ids + of_quaternion) return std::nullopt;
        motion_columns columns;
        columns.places_.resize(count);
        std::iota(columns.places_.begin(), columns.places_.end(), std::size_t{0});
        columns.count_ = count;
        return columns;
    }

    /// The columns that a header names; empty if one is missing.
    static std::optional<motion_columns> by_name(std::span<const std::string> header) {
        constexpr std::array<std::string_view, ids + of_matrix> matrix{
            "frame", "object", "r00", "r01", "r02", "tx", "r10", "r11", "r12", "ty", "r20", "r21", "r22", "tz"};
        constexpr std::array<std::string_view, ids + of_quaternion> quaternion{"frame", "object", "tx", "ty", "tz",
                                                                               "qx",    "qy",     "qz", "qw"};
        for (const std::span<const std::string_view> names :
             {std::span<const std::string_view>(matrix), std::span<const std::string_view>(quaternion)}) {
            motion_columns columns;
            columns.count_ = header.size();
            for (const std::string_view name : names)
                if (const auto place = std::ranges::find(header, name); place != header.end())
                    columns.places_.push_back(static_cast<std::size_t>(place - header.begin()));
            if (columns.places_.size() == names.size()) return columns;
        }
        return std::nullopt;
    }

    [[nodiscard]] std::size_t count() const { return count_; }  ///< in the file
    [[nodiscard]] bool has_quaternion() const { return places_.size() == ids + of_quaternion; }
    /// The place in the file of a number of the format.
    [[nodiscard]] std::size_t place(std::size_t number) const { return places_[number]; }

private:
    std::vector<std::size_t> places_;
    std::size_t count_ = 0;
};

/// The rotation of a quaternion of any length but 0, whose rounding makes it a rotation up to a few units in the last
/// place.
std::array<double, 9> rotation_of(double x, double y, double z, double w) {
    const double s = 2 / (x * x + y * y + z * z + w * w);
    return {1 - s * (y * y + z * z), s * (x * y - z * w),     s * (x * z + y * w),
            s * (x * y + z * w),     1 - s * (x * x + z * z), s * (y * z - x * w),
            s * (x * z - y * w),     s * (y * z + x * w),     1 - s * (x * x + y * y)};
}

class motion_reader {
public:
    explicit motion_reader(const file_text& file) : in_(file, /*comment=*/'#') {}

    /// Reads lines of frame, object and pose, by frame. Frame 0 must have all objects, later ones those that move.
    [[nodiscard]] std::vector<step> read() {
        while (in_.next_line()) {
            words_.clear();
            while (in_.has_word()) words_.emplace_back(in_.word());
            if (!columns_ && find_columns()) continue;
            if (words_.size() != columns_->count())
                in_.fail(fmt::format("expected {} columns, found {}", columns_->count(), words_.size()));
            const auto frame = id_of(0, "the number of a frame");
            const auto object = id_of(1, "the number of an object");
            advance_to_frame(frame);
            note_pose_in_frame(object);
            steps_.push_back({frame, object, pose_of_line()});
        }
        if (steps_.empty()) in_.fail_at_end("before the first pose");
        if (frame_ == 0) require_all_objects();  // otherwise this was checked at the end of frame 0
        return std::move(steps_);
    }

    /// The number of objects in frame 0.
    [[nodiscard]] std::size_t objects() const { return objects_; }

private:
    /// Decides by the first line what the columns are.
    /// @returns whether it is a header
    bool find_columns() {
        const bool is_header = !read_number<double>(words_.front()).is_number;
        columns_ = is_header ? motion_columns::by_name(words_) : motion_columns::by_place(words_.size());
        if (!columns_ && is_header)
            in_.fail(
                "the header lacks a column of frame, object, and r00 to r22, tx, ty, tz or tx, ty, tz, qx, qy, qz, qw");
        if (!columns_)
            in_.fail(
                fmt::format("expected frame and object, then twelve numbers, the rows of [R t], or seven, tx, ty, tz "
                            "and the quaternion x, y, z, w; found {} columns",
                            words_.size()));
        return is_header;
    }

    [[nodiscard]] std::uint32_t id_of(std::size_t number, const std::string& noun) const {
        const std::string& word = words_[columns_->place(number)];
        const read_number<std::uint32_t> id(word);
        if (!id.is_number || id.out_of_range) in_.fail_expected(noun, word);
        return id.value;
    }
    [[nodiscard]] double number_of(std::size_t number) const {
        const std::string& word = words_[columns_->place(motion_columns::ids + number)];
        const read_number<double> value(word);
        if (!value.is_number) in_.fail_expected("a number of a pose", word);
        if (!std::isfinite(value.value)) in_.fail(in_quotes(word) + " is not a finite number");
        return value.value;
    }

    /// Rejects a singular matrix R and the quaternion 0.
    [[nodiscard]] aabb::pose pose_of_line() const {
        aabb::pose p;
        if (columns_->has_quaternion()) {
            p.translation = {number_of(0), number_of(1), number_of(2)};
            p.rotation = rotation_of(number_of(3), number_of(4), number_of(5), number_of(6));
            if (!std::isfinite(p.rotation[0])) in_.fail("the quaternion is 0, or its square exceeds a double");
        } else {
            for (std::size_t row = 0; row < 3; ++row) {
                for (std::size_t column = 0; column < 3; ++column)
                    p.rotation[3 * row + column] = number_of(4 * row + column);
                p.translation[static_cast<int>(row)] = number_of(4 * row + 3);
            }
        }
        try {
            aabb::require_full_rank(p);
        } catch (const aabb::input_error& error) {
            in_.fail(error.what());
        }
        return p;
    }

    /// Advances to the frame of a line; frames must be in order.
    void advance_to_frame(std::uint32_t frame) {
        if (frame == frame_) return;
        if (frame < frame_) in_.fail(fmt::format("frame {} follows frame {}; frames must be in order", frame, frame_));
        if (frame >= most) in_.fail(fmt::format("a frame is a number below {}, not {}", most, frame));
        if (frame_ == 0) require_all_objects();
        frame_ = frame;
    }

    /// Frame 0 defines the set of objects, which must have no gaps.
    void require_all_objects() {
        for (std::size_t object = 0; object < placed_.size(); ++object)
            if (placed_[object] == 0) in_.fail("frame 0 has no pose of object " + std::to_string(object));
        objects_ = placed_.size();
    }

    /// Notes that an object has a pose in the current frame, which must not have another, and must be in frame 0.
    void note_pose_in_frame(std::uint32_t object) {
        if (object >= most) in_.fail(fmt::format("an object is a number below {}, not {}", most, object));
        if (frame_ == 0 && object >= placed_.size()) placed_.resize(object + 1, 0);
        if (object >= placed_.size()) in_.fail("frame 0 has no pose of object " + std::to_string(object));
        if (placed_[object] == frame_ + 1) in_.fail(fmt::format("object {} has two poses in frame {}", object, frame_));
        placed_[object] = frame_ + 1;
    }

    static constexpr std::uint32_t most = 10'000'000;  // limits objects and frames, which catches typing errors

    text_scanner in_;
    std::vector<std::string> words_;  // of the line
    std::optional<motion_columns> columns_;
    std::vector<step> steps_;
    std::uint32_t frame_ = 0;
    std::vector<std::uint32_t> placed_;  // by object: 1 + the last frame with a pose of it
    std::size_t objects_ = 0;
};

class motion_scene final : public aabb::mesh_scene {
public:
    /// Reads the whole file of poses. Object i has the mesh of index i modulo the number of meshes.
    motion_scene(const std::filesystem::path& file, std::vector<aabb::mesh> scene_meshes) {
        // The text and the poses together take at most eight times the file's size.
        file_text text = as_text(read_file(file, require_file(file), /*memory_factor=*/8));
        for (char& c : text.text)
            if (c == ',' || c == ';') c = ' ';
        motion_reader reader(text);
        steps_ = reader.read();
        meshes = std::move(scene_meshes);
        if (meshes.size() > reader.objects())
            reject(file, fmt::format("moves {} objects, but there are {} meshes", reader.objects(), meshes.size()));
        poses_.resize(reader.objects());
        for (std::size_t object = 0; object < poses_.size(); ++object)
            mesh_of.push_back(static_cast<std::uint32_t>(object % meshes.size()));
    }

    [[nodiscard]] std::size_t frames() const override { return std::size_t{steps_.back().frame} + 1; }

    /// Gives the poses of the next frame; false after the last. Objects without a line in it stay where they are.
    bool next(std::vector<aabb::pose>& poses) override {
        if (frame_ == frames()) return false;
        for (; next_step_ < steps_.size() && steps_[next_step_].frame == frame_; ++next_step_)
            poses_[steps_[next_step_].object] = steps_[next_step_].pose;
        ++frame_;
        poses = poses_;
        return true;
    }

private:
    std::vector<step> steps_;
    std::size_t next_step_ = 0;
    std::size_t frame_ = 0;
    std::vector<aabb::pose> poses_;  // current, by object
};

}  // namespace

std::unique_ptr<aabb::mesh_scene> open_motion(const std::filesystem::path& file, std::vector<aabb::mesh> meshes) {
    return std::make_unique<motion_scene>(file, std::move(meshes));
}

/// Appends a frame: a line "frame object", then the rows of [R t], for each object.
void motion_file::add(std::span<const aabb::pose> poses) {
    std::string text;
    const auto append = [&](double number) { text += ' ' + aabb::shortest(number); };
    if (frames_ == 0) text = "# frame object r00 r01 r02 tx r10 r11 r12 ty r20 r21 r22 tz\n";
    for (std::size_t object = 0; object < poses.size(); ++object) {
        text += std::to_string(frames_) + ' ' + std::to_string(object);
        for (std::size_t row = 0; row < 3; ++row) {
            for (std::size_t column = 0; column < 3; ++column) append(poses[object].rotation[3 * row + column]);
            append(poses[object].translation[static_cast<int>(row)]);
        }
        text += '\n';
    }
    out_.write(text);
    ++frames_;
}

}  // namespace aabblab
