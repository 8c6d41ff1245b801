module aabblab.files;

import aabblab.fmt;
import :file_text;
import :text_scanner;

namespace aabblab {

namespace {

constexpr std::size_t coordinates = 6;  // of a box: the least and the greatest x, y, z

/// Boxes of several frames in memory, by frame and object.
class boxes_in_memory final : public aabb::box_scene {
public:
    /// @param values six coordinates per box
    boxes_in_memory(std::string name, std::size_t frames, std::size_t objects, std::vector<double> values)
        : name_(std::move(name)), frames_(frames), objects_(objects), values_(std::move(values)) {
        are_floats_ = std::ranges::all_of(values_, [](double x) { return x == double{static_cast<float>(x)}; });
        if (are_floats_ || values_.empty()) return;
        aabb::boxd range = box_at(0);
        for (std::size_t b = 1; b < frames_ * objects_; ++b)
            for (int k = 0; k < 3; ++k) {
                range.min[k] = std::min(range.min[k], box_at(b).min[k]);
                range.max[k] = std::max(range.max[k], box_at(b).max[k]);
            }
        floats_ = aabb::float_boxes(range);
    }

    [[nodiscard]] std::size_t objects() const override { return objects_; }
    [[nodiscard]] std::size_t frames() const override { return frames_; }
    bool next(std::vector<aabb::box>& boxes) override {
        if (frame_ == frames_) return false;
        in_double_.clear();
        boxes.clear();
        for (std::size_t object = 0; object < objects_; ++object)
            in_double_.push_back(box_at(frame_ * objects_ + object));
        try {
            aabb::require_valid(in_double_);
            if (are_floats_) {
                const auto rounded = [](const aabb::vec3d& p) {
                    return aabb::vec3f{static_cast<float>(p[0]), static_cast<float>(p[1]), static_cast<float>(p[2])};
                };
                for (const aabb::boxd& b : in_double_) boxes.push_back({rounded(b.min), rounded(b.max)});
                in_double_.clear();
            } else {
                const std::span<const aabb::box> rounded = floats_.round(in_double_);
                boxes.assign(rounded.begin(), rounded.end());
            }
        } catch (const aabb::input_error& error) {
            reject(name_, fmt::format("frame {}: {}", frame_, error.what()));
        }
        ++frame_;
        return true;
    }
    [[nodiscard]] std::span<const aabb::boxd> in_double() const override { return in_double_; }

private:
    [[nodiscard]] aabb::boxd box_at(std::size_t i) const {
        const double* const c = values_.data() + coordinates * i;
        return {{c[0], c[1], c[2]}, {c[3], c[4], c[5]}};
    }

    std::string name_;
    std::size_t frames_, objects_;
    std::vector<double> values_;
    bool are_floats_ = true;
    aabb::float_boxes floats_;
    std::vector<aabb::boxd> in_double_;  // of the current frame, if they are doubles
    std::size_t frame_ = 0;
};

std::unique_ptr<aabb::box_scene> open_array(const std::filesystem::path& file) {
    number_array<double> array = read_npy_reals(file);
    std::vector<std::size_t>& shape = array.shape;
    const bool has_corners = shape.size() >= 2 && shape.back() == 3 && shape[shape.size() - 2] == 2;
    const std::size_t outer = shape.size() - (has_corners ? 2 : 1);
    if (shape.empty() || (!has_corners && shape.back() != coordinates) || outer < 1 || outer > 2)
        reject(file,
               "expected an array of the shape (frames, objects, 6) or (frames, objects, 2, 3), or for one frame "
               "without frames");
    const std::size_t frames = outer == 2 ? shape[0] : 1;
    return std::make_unique<boxes_in_memory>(file.string(), frames, shape[outer - 1], std::move(array.values));
}

/// A row of a table: a box with its frame and its object.
struct box_row {
    std::uint32_t frame, object;
    std::array<double, coordinates> box;
    std::size_t line;
};

/// The places of frame, object and coordinates among the columns of a table; frame and object may be missing.
struct box_columns {
    std::optional<std::size_t> frame, object;
    std::array<std::size_t, coordinates> box{};
    std::size_t count = 0;
};

/// The columns of a table without a header; empty unless there are six to eight.
std::optional<box_columns> columns_by_place(std::size_t count) {
    if (count < coordinates || count > coordinates + 2) return std::nullopt;
    box_columns columns{.count = count};
    const std::size_t before = count - coordinates;
    if (before == 2) columns.frame = 0;
    if (before > 0) columns.object = before - 1;
    for (std::size_t i = 0; i < coordinates; ++i) columns.box[i] = before + i;
    return columns;
}

/// The columns that a header names, in any order; empty unless it names all coordinates in one of the usual ways.
std::optional<box_columns> columns_by_name(std::span<const std::string> names) {
    constexpr std::array<std::array<std::string_view, coordinates>, 3> ways{
        {{"min_x", "min_y", "min_z", "max_x", "max_y", "max_z"},
         {"xmin", "ymin", "zmin", "xmax", "ymax", "zmax"},
         {"x0", "y0", "z0", "x1", "y1", "z1"}}};
    const auto place_of = [&](std::initializer_list<std::string_view> wanted) -> std::optional<std::size_t> {
        for (const std::string_view name : wanted)
            if (const auto column = std::ranges::find(names, name); column != names.end())
                return static_cast<std::size_t>(column - names.begin());
        return std::nullopt;
    };
    for (const auto& way : ways) {
        box_columns columns{
            .frame = place_of({"frame", "step"}), .object = place_of({"object", "id"}), .count = names.size()};
        bool is_complete = true;
        for (std::size_t i = 0; i < coordinates; ++i) {
            const auto place = place_of({way[i]});
            is_complete &= place.has_value();
            columns.box[i] = place.value_or(0);
        }
        if (is_complete && (columns.object || !columns.frame)) return columns;
    }
    return std::nullopt;
}

/// Reads a table, separated by commas, semicolons or blanks, perhaps with a header.
std::vector<box_row> read_rows(const std::filesystem::path& file) {
    std::vector<box_row> rows;
    std::optional<box_columns> columns;
    for (line_stream lines(file); lines.next();) {
        std::vector<std::string> words(1);
        for (const char c : without_comment(lines.line()))
            if (c != ',' && c != ';' && c != ' ' && c != '\t' && c != '\r')
                words.back() += c;
            else if (!words.back().empty())
                words.emplace_back();
        if (words.back().empty()) words.pop_back();
        if (words.empty()) continue;
        if (!columns) {
            const bool has_names = std::ranges::none_of(
                words, [](const std::string& word) { return read_number<double>(word).is_number; });
            columns = has_names ? columns_by_name(words) : columns_by_place(words.size());
            if (!columns && has_names)
                lines.fail(
                    "expected a header with min_x, min_y, min_z, max_x, max_y, max_z, and perhaps object, or frame and "
                    "object");
            if (!columns)
                lines.fail(
                    fmt::format("expected six coordinates, perhaps preceded by the object, or by frame and "
                                "object, found {} columns",
                                words.size()));
            if (has_names) continue;
        }
        if (words.size() != columns->count)
            lines.fail(fmt::format("expected {} columns, found {}", columns->count, words.size()));
        box_row row{.frame = 0, .object = static_cast<std::uint32_t>(rows.size()), .box = {}, .line = lines.number()};
        const auto id = [&](std::size_t place, std::string_view noun) {
            const read_number<std::uint32_t> number(words[place]);
            if (!number.is_number || number.out_of_range)
                lines.fail(fmt::format("expected {}, found {}", noun, in_quotes(words[place])));
            return number.value;
        };
        if (columns->object) row.object = id(*columns->object, "an object");
        if (columns->frame) row.frame = id(*columns->frame, "a frame");
        for (std::size_t i = 0; i < coordinates; ++i) {
            const std::string& word = words[columns->box[i]];
            const read_number<double> number(word);
            if (!number.is_number || !std::isfinite(number.value))
                lines.fail(fmt::format("expected a finite coordinate, found {}", in_quotes(word)));
            row.box[i] = number.value;
        }
        for (std::size_t k = 0; k < 3; ++k)
            if (row.box[k] > row.box[3 + k])
                lines.fail("the box is inverted: expected the least x, y and z before the greatest ones");
        rows.push_back(row);
    }
    return rows;
}

std::unique_ptr<aabb::box_scene> open_table(const std::filesystem::path& file) {
    std::vector<box_row> rows = read_rows(file);
    if (rows.empty()) reject(file, "has no boxes");
    std::ranges::stable_sort(rows, {}, [](const box_row& row) { return std::pair(row.frame, row.object); });
    const std::size_t frames = std::size_t{rows.back().frame} + 1;
    const std::size_t objects = rows.size() / frames;
    std::vector<double> values;
    for (std::size_t i = 0; i < rows.size(); ++i) {
        const box_row& row = rows[i];
        if (row.frame != i / std::max<std::size_t>(objects, 1) || row.object != i % std::max<std::size_t>(objects, 1))
            reject(
                fmt::format("{}:{}", file.string(), row.line),
                fmt::format("expected each object once in each of {} frames, from frame 0 and object 0; object {} of "
                            "frame {} is missing, repeated, or beyond the others",
                            frames, row.object, row.frame));
        values.insert(values.end(), row.box.begin(), row.box.end());
    }
    return std::make_unique<boxes_in_memory>(file.string(), frames, objects, std::move(values));
}

/// Calls `write` with each frame's boxes, in float or double.
void for_each_frame(aabb::box_scene& scene, const std::function<void(std::size_t)>& progress, const auto& write) {
    std::vector<aabb::box> boxes;
    for (std::size_t frame = 0; scene.next(boxes); ++frame) {
        if (const std::span<const aabb::boxd> in_double = scene.in_double(); !in_double.empty())
            write(frame, in_double);
        else
            write(frame, std::span<const aabb::box>(boxes));
        if (progress) progress(frame + 1);
    }
}

void write_table(aabb::box_scene& scene, const std::filesystem::path& file,
                 const std::function<void(std::size_t)>& progress) {
    output_file out(file);
    out.write("frame,object,min_x,min_y,min_z,max_x,max_y,max_z\n");
    for_each_frame(scene, progress, [&](std::size_t frame, const auto& boxes) {
        std::string text;
        for (std::size_t object = 0; object < boxes.size(); ++object) {
            text += fmt::format("{},{}", frame, object);
            for (const auto& corner : {boxes[object].min, boxes[object].max})
                // The decimals of a double: those of a float would be read as another double.
                for (int k = 0; k < 3; ++k) text += "," + aabb::shortest(double{corner[k]});
            text += "\n";
        }
        out.write(text);
    });
    out.commit();
}

void write_array(aabb::box_scene& scene, const std::filesystem::path& file,
                 const std::function<void(std::size_t)>& progress) {
    output_file out(file);
    const std::array shape{scene.frames(), scene.objects(), coordinates};
    out.write(npy_header("<f4", shape));
    for_each_frame(scene, progress, [&](std::size_t /*frame*/, const auto& boxes) {
        if constexpr (std::same_as<std::remove_cvref_t<decltype(boxes[0])>, aabb::boxd>)
            if (const std::string header = npy_header("<f8", shape); !header.empty())
                out.overwrite(0, header.data(), header.size());
        static_assert(sizeof(aabb::box) == coordinates * sizeof(float) &&
                      sizeof(aabb::boxd) == coordinates * sizeof(double));
        out.write(boxes.data(), boxes.size_bytes());
    });
    out.commit();
}

}  // namespace

bool is_file_of_boxes(const std::filesystem::path& file) {
    const std::string ending = file.extension().string();
    return ending == ".aabbs" || ending == ".csv" || ending == ".npy";
}

std::unique_ptr<aabb::box_scene> open_boxes(const std::filesystem::path& file) {
    if (file.extension() == ".csv") return open_table(file);
    if (file.extension() == ".npy") return open_array(file);
    return open_recording(file);
}

void write_boxes(aabb::box_scene& scene, const std::filesystem::path& file,
                 const std::function<void(std::size_t)>& progress) {
    if (file.extension() == ".csv") return write_table(scene, file, progress);
    if (file.extension() == ".npy") return write_array(scene, file, progress);
    write_recording(scene, "converted", "boxes", file, progress);
}

}  // namespace aabblab
