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

/// Reads the rest of a line: twelve numbers, the rows of [R t]. Rejects a singular matrix R.
aabb::pose read_pose(text_scanner& in) {
    aabb::pose p;
    for (std::size_t row = 0; row < 3; ++row) {
        for (std::size_t column = 0; column < 3; ++column)
            p.rotation[3 * row + column] = in.number("twelve numbers, the rows of [R t]");
        p.translation[static_cast<int>(row)] = in.number("twelve numbers, the rows of [R t]");
    }
    if (in.has_word()) in.fail_expected("the end of the line after frame, object and twelve numbers", in.word());
    try {
        aabb::require_full_rank(p);
    } catch (const aabb::input_error& error) {
        in.fail(error.what());
    }
    return p;
}

class motion_reader {
public:
    explicit motion_reader(const file_text& file) : in_(file, /*comment=*/'#') {}

    /// Reads lines "frame object" and a pose, by frame. Frame 0 must have all objects, later ones those that move.
    [[nodiscard]] std::vector<step> read() {
        while (in_.next_line()) {
            const auto frame = in_.integer<std::uint32_t>("the number of a frame");
            const auto object = in_.integer<std::uint32_t>("the number of an object");
            advance_to_frame(frame);
            note_pose_in_frame(object);
            steps_.push_back({frame, object, read_pose(in_)});
        }
        if (steps_.empty()) in_.fail_at_end("before the first pose");
        if (frame_ == 0) require_all_objects();  // otherwise this was checked at the end of frame 0
        return std::move(steps_);
    }

    /// The number of objects in frame 0.
    [[nodiscard]] std::size_t objects() const { return objects_; }

private:
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
        const file_text text = as_text(read_file(file, require_file(file), /*memory_factor=*/8));
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
