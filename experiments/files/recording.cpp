module aabblab.files;

import aabblab.fmt;
import :file_text;

// The format is Broadmark's (Serpa and Rodrigues, "Broadmark: a testing framework for broad-phase collision detection
// algorithms", Computer Graphics Forum 2020): a header, then F + 1 frames of N boxes.
namespace aabblab {

namespace {

static_assert(std::endian::native == std::endian::little, "recordings are little-endian");

/// The layout of a box: min x, y, z, 0, max x, y, z, 0.
using box_record = std::array<float, 8>;

struct header {
    std::array<char, 128> name;
    std::array<char, 128> type;
    std::int32_t objects;
    std::int32_t last_frame;
    std::array<std::int32_t, 2> zero;
    box_record world;
};
static_assert(sizeof(header) == 304 && std::is_trivially_copyable_v<header>);

aabb::box unpacked(const box_record& r) {
    return {{r[0], r[1], r[2]}, {r[4], r[5], r[6]}};
}
box_record packed(const aabb::box& b) {
    return {b.min[0], b.min[1], b.min[2], 0, b.max[0], b.max[1], b.max[2], 0};
}

class recording final : public aabb::box_scene {
public:
    recording(std::string name, input_file file, const header& h)
        : name_(std::move(name)),
          file_(std::move(file)),
          records_(static_cast<std::size_t>(h.objects)),
          frames_(static_cast<std::size_t>(h.last_frame) + 1) {}

    [[nodiscard]] std::size_t objects() const override { return records_.size(); }
    [[nodiscard]] std::size_t frames() const override { return frames_; }

    /// Reads and validates the boxes of the next frame; false after the last.
    bool next(std::vector<aabb::box>& boxes) override {
        if (frame_ == frames_) return false;
        const std::string place = "frame " + std::to_string(frame_);
        if (!file_.try_read(records_.data(), records_.size() * sizeof(box_record))) reject(name_, "ends in " + place);
        boxes.resize(records_.size());
        std::ranges::transform(records_, boxes.begin(), unpacked);
        try {
            aabb::require_valid(boxes);
        } catch (const aabb::input_error& error) {
            reject(name_, place + ": " + error.what());
        }
        ++frame_;
        return true;
    }

private:
    std::string name_;
    input_file file_;
    std::vector<box_record> records_;
    std::size_t frames_;
    std::size_t frame_ = 0;
};

/// Without objects the file size does not bound the number of frames, and running them would take hours.
void require_few_empty_frames(const std::filesystem::path& file, std::size_t objects, std::size_t frames) {
    if (objects == 0 && frames > 1'000'000)
        reject(file, "a recording of 0 objects holds at most 1000000 frames, not " + std::to_string(frames));
}

/// A header field with the text, truncated to fit; never empty, as Broadmark rejects empty fields.
std::array<char, 128> field(const std::string& text, const std::string& otherwise) {
    const std::string& used = text.empty() ? otherwise : text;
    std::array<char, 128> padded{};
    std::copy_n(used.begin(), std::min(used.size(), padded.size() - 1), padded.begin());
    return padded;
}

}  // namespace

/// Opens a recording, whose frames are read one at a time, and checks its header against the size of the file.
std::unique_ptr<aabb::box_scene> open_recording(const std::filesystem::path& file) {
    const std::size_t size = require_file(file);
    if (size < sizeof(header))
        reject(file,
               fmt::format("is not a recording: its header takes {} bytes, but the file has {}", sizeof(header), size));
    input_file opened(file, size);
    header h{};
    if (!opened.try_read(&h, sizeof h)) reject(file, "cannot be read");
    if (h.name.back() != 0 || h.type.back() != 0 || h.zero != std::array<std::int32_t, 2>{})
        reject(file, "is not a recording: its header does not hold two names and two zeros");
    if (h.objects < 0 || h.last_frame < 0)
        reject(file, fmt::format("its header announces {} objects and {} frames; neither can be negative", h.objects,
                                 h.last_frame));
    if (!aabb::is_valid(unpacked(h.world))) reject(file, "the world box in its header is inverted or not finite");
    // Counts boxes, as the announced size in bytes may overflow.
    const std::uint64_t boxes = static_cast<std::uint64_t>(h.objects) * (static_cast<std::uint64_t>(h.last_frame) + 1);
    const std::uint64_t stored = (size - sizeof(header)) / sizeof(box_record);
    if (boxes != stored || (size - sizeof(header)) % sizeof(box_record) != 0)
        reject(file,
               fmt::format("its header announces {} boxes ({} objects, {} + 1 frames), but the file has {} bytes of "
                           "them, {} each",
                           boxes, h.objects, h.last_frame, size - sizeof(header), sizeof(box_record)));
    require_few_empty_frames(file, static_cast<std::size_t>(h.objects), static_cast<std::size_t>(h.last_frame) + 1);
    require_memory(file.string() + ": a frame of " + std::to_string(h.objects) + " boxes",
                   static_cast<double>(h.objects) * (sizeof(box_record) + sizeof(aabb::box)));
    return std::make_unique<recording>(file.string(), std::move(opened), h);
}

/// Writes all frames of a scene, then the header again, as the box that holds all boxes is known only at the end.
void write_recording(aabb::box_scene& scene, const std::string& name, const std::string& type,
                     const std::filesystem::path& file, const std::function<void(std::size_t)>& progress) {
    constexpr std::size_t most = std::numeric_limits<std::int32_t>::max();
    if (scene.objects() > most || scene.frames() > most || scene.frames() == 0)
        reject(file,
               fmt::format("a recording holds at most 2^31 - 1 objects and from 1 to 2^31 - 1 frames, not {} and {}",
                           scene.objects(), scene.frames()));
    require_few_empty_frames(file, scene.objects(), scene.frames());
    const auto objects = static_cast<std::int32_t>(scene.objects());
    const auto last_frame = static_cast<std::int32_t>(scene.frames() - 1);
    header h{field(name, "scene"), field(type, "boxes"), objects, last_frame, /*zero=*/{}, /*world=*/{}};
    output_file out(file);
    out.require_space(sizeof h +
                      sizeof(box_record) * static_cast<double>(scene.objects()) * static_cast<double>(scene.frames()));
    out.write(&h, sizeof h);
    aabb::box world = aabb::empty_box();
    std::vector<aabb::box> boxes;
    std::vector<box_record> records;
    for (std::size_t done = 1; scene.next(boxes); ++done) {
        records.clear();
        for (const aabb::box& b : boxes) {
            world = aabb::merged(world, b);
            records.push_back(packed(b));
        }
        out.write(records.data(), records.size() * sizeof(box_record));
        if (progress) progress(done);
    }
    if (scene.objects() > 0) {
        h.world = packed(world);
        out.overwrite(0, &h, sizeof h);
    }
    out.commit();
}

}  // namespace aabblab
