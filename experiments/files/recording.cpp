module aabblab.files;

import aabblab.fmt;
import :file_text;

// The format is Broadmark's (Serpa and Rodrigues, "Broadmark: a testing framework for broad-phase collision detection
// algorithms", Computer Graphics Forum 2020): a header, then F + 1 frames of N boxes.
namespace aabblab {

namespace {

static_assert(std::endian::native == std::endian::little, "recordings are little-endian");

/// The layout of a box: min x, y, z, 0, max x, y, z, 0.
template <class Real>
using box_record = std::array<Real, 8>;

struct header {
    std::array<char, 128> name;
    std::array<char, 128> type;
    std::int32_t objects;
    std::int32_t last_frame;
    std::int32_t is_double;  ///< 1 if boxes are doubles, our addition to Broadmark's format; else 0
    std::int32_t zero;
    box_record<float> world;
};
static_assert(sizeof(header) == 304 && std::is_trivially_copyable_v<header>);

template <class Box, class Real>
Box unpacked(const box_record<Real>& r) {
    return {{r[0], r[1], r[2]}, {r[4], r[5], r[6]}};
}
template <class Real>
box_record<Real> packed(const auto& b) {
    return {b.min[0], b.min[1], b.min[2], 0, b.max[0], b.max[1], b.max[2], 0};
}

/// @tparam Box `aabb::box` or `aabb::boxd`
template <class Box, class Real>
class recording final : public aabb::box_scene {
public:
    recording(std::string name, input_file file, const header& h)
        : name_(std::move(name)),
          file_(std::move(file)),
          records_(static_cast<std::size_t>(h.objects)),
          floats_(world_of(h)),
          frames_(static_cast<std::size_t>(h.last_frame) + 1) {}

    [[nodiscard]] std::size_t objects() const override { return records_.size(); }
    [[nodiscard]] std::size_t frames() const override { return frames_; }

    /// Reads and validates the boxes of the next frame; false after the last. Boxes in double are kept in `in_double_`,
    /// and `boxes` receives them rounded to floats for the search (`float_boxes`).
    bool next(std::vector<aabb::box>& boxes) override {
        if (frame_ == frames_) return false;
        const std::string place = "frame " + std::to_string(frame_);
        if (!file_.try_read(records_.data(), records_.size() * sizeof records_[0])) reject(name_, "ends in " + place);
        try {
            if constexpr (std::same_as<Real, float>) {
                boxes.resize(records_.size());
                std::ranges::transform(records_, boxes.begin(), unpacked<Box, Real>);
                aabb::require_valid(boxes);
            } else {
                in_double_.resize(records_.size());
                std::ranges::transform(records_, in_double_.begin(), unpacked<Box, Real>);
                const std::span<const aabb::box> rounded = floats_.round(in_double_);
                boxes.assign(rounded.begin(), rounded.end());
            }
        } catch (const aabb::input_error& error) {
            reject(name_, place + ": " + error.what());
        }
        ++frame_;
        return true;
    }
    [[nodiscard]] std::span<const aabb::boxd> in_double() const override { return in_double_; }

private:
    /// The range of all boxes of the recording, from its header. It is widened by more than the rounding of its floats.
    [[nodiscard]] static aabb::boxd world_of(const header& h) {
        const auto world = unpacked<aabb::box>(h.world);
        aabb::boxd range{aabb::in_double(world.min), aabb::in_double(world.max)};
        for (int k = 0; k < 3; ++k) {  // the floats may be rounded inward
            range.min[k] -= 0x1p-22 * std::abs(range.min[k]);
            range.max[k] += 0x1p-22 * std::abs(range.max[k]);
        }
        return range;
    }

    std::string name_;
    input_file file_;
    std::vector<box_record<Real>> records_;
    std::vector<aabb::boxd> in_double_;  // of the current frame, if they are doubles
    aabb::float_boxes floats_;
    std::size_t frames_;
    std::size_t frame_ = 0;
};

/// Writes the boxes of a frame, in float or double.
/// @param world grown to contain them; its bounds are floats, and clamped to their range
template <class Real, class Box>
void write_boxes(output_file& out, std::span<const Box> boxes, aabb::box& world) {
    constexpr double most = std::numeric_limits<float>::max();
    const auto in_float = [most](double x) { return static_cast<float>(std::clamp(x, -most, most)); };
    std::vector<box_record<Real>> records;
    records.reserve(boxes.size());
    for (const Box& b : boxes) {
        for (int k = 0; k < 3; ++k) {
            world.min[k] = std::min(world.min[k], in_float(b.min[k]));
            world.max[k] = std::max(world.max[k], in_float(b.max[k]));
        }
        records.push_back(packed<Real>(b));
    }
    out.write(records.data(), records.size() * sizeof records[0]);
}

/// Rejects many frames without objects: the file size does not bound their number, and running them would take hours.
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
    if (h.name.back() != 0 || h.type.back() != 0 || h.zero != 0 || (h.is_double != 0 && h.is_double != 1))
        reject(file, "is not a recording: its header does not hold two names, 0 (floats) or 1 (doubles), and 0");
    if (h.objects < 0 || h.last_frame < 0)
        reject(file, fmt::format("its header announces {} objects and {} frames; neither can be negative", h.objects,
                                 h.last_frame));
    if (!aabb::is_valid(unpacked<aabb::box>(h.world)))
        reject(file, "the world box in its header is inverted or not finite");
    // Compares numbers of boxes, as the announced size in bytes may overflow.
    const std::uint64_t boxes = static_cast<std::uint64_t>(h.objects) * (static_cast<std::uint64_t>(h.last_frame) + 1);
    const std::size_t bytes_of_box = h.is_double != 0 ? sizeof(box_record<double>) : sizeof(box_record<float>);
    const std::uint64_t stored = (size - sizeof(header)) / bytes_of_box;
    if (boxes != stored || (size - sizeof(header)) % bytes_of_box != 0)
        reject(file,
               fmt::format("its header announces {} boxes ({} objects, {} + 1 frames), but the file has {} bytes of "
                           "them, {} each",
                           boxes, h.objects, h.last_frame, size - sizeof(header), bytes_of_box));
    require_few_empty_frames(file, static_cast<std::size_t>(h.objects), static_cast<std::size_t>(h.last_frame) + 1);
    require_memory(file.string() + ": a frame of " + std::to_string(h.objects) + " boxes",
                   static_cast<double>(h.objects) * static_cast<double>(2 * bytes_of_box + sizeof(aabb::box)));
    if (h.is_double != 0) return std::make_unique<recording<aabb::boxd, double>>(file.string(), std::move(opened), h);
    return std::make_unique<recording<aabb::box, float>>(file.string(), std::move(opened), h);
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
    header h{field(name, "scene"), field(type, "boxes"), objects,     last_frame,
             /*is_double=*/0,      /*zero=*/0,           /*world=*/{}};
    output_file out(file);
    out.require_space(sizeof h + sizeof(box_record<float>) * static_cast<double>(scene.objects()) *
                                     static_cast<double>(scene.frames()));
    out.write(&h, sizeof h);
    aabb::box world = aabb::empty_box();
    std::vector<aabb::box> boxes;
    for (std::size_t done = 1; scene.next(boxes); ++done) {
        const std::span<const aabb::boxd> in_double = scene.in_double();
        h.is_double = in_double.empty() ? 0 : 1;
        if (in_double.empty())
            write_boxes<float>(out, std::span<const aabb::box>(boxes), world);
        else
            write_boxes<double>(out, in_double, world);
        if (progress) progress(done);
    }
    if (scene.objects() > 0) {
        h.world = packed<float>(world);
        out.overwrite(0, &h, sizeof h);
    }
    out.commit();
}

}  // namespace aabblab
