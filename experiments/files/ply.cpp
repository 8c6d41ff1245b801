module;
#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

module aabblab.files;

import aabb.base;
import aabb.geometry;
import :file_text;
import :mesh_builder;
import :ply_header;
import :readers;
import :text_scanner;

namespace aabblab {

using namespace ply;

namespace {

/// Values of a text file, an element a line.
class text_values {
public:
    explicit text_values(text_scanner& in) : in_(in) {}

    void begin(const element& e, std::uint64_t index) {
        if (!in_.next_line())
            in_.ends("after " + std::to_string(index) + " of " + std::to_string(e.count) + " elements " +
                     in_quotes(e.name));
    }
    [[nodiscard]] float coordinate(scalar) { return in_.coordinate(in_.word()); }
    [[nodiscard]] std::uint32_t whole(scalar) { return in_.whole<std::uint32_t>("a whole number"); }
    void skip(scalar) {
        if (in_.word().empty()) in_.expected("the value of a property", {});
    }
    [[nodiscard]] std::size_t place(std::uint64_t) const { return in_.line(); }
    void end() {
        if (in_.next_line())
            in_.fail("expected the end of the file after the last element, found " + in_quotes(in_.word()));
    }
    [[nodiscard]] std::size_t rounded() const { return in_.rounded(); }
    static constexpr std::string_view before_place = ":";

private:
    text_scanner& in_;
};

/// Values of a binary file.
class binary_values {
public:
    binary_values(std::string file, std::string_view bytes, bool big)
        : file_(std::move(file)), bytes_(bytes), big_(big) {}

    void begin(const element& e, std::uint64_t index) {
        element_ = &e;
        index_ = index;
    }
    [[nodiscard]] float coordinate(scalar type) {
        const double fine = number(type);
        if (!std::isfinite(fine)) fail("has a coordinate that is not finite");
        if (std::abs(fine) > std::numeric_limits<float>::max() && std::isinf(static_cast<float>(fine)))
            fail("has a coordinate that is too large for a float");
        const auto value = static_cast<float>(fine);
        rounded_ += value != fine;
        return value;
    }
    [[nodiscard]] std::uint32_t whole(scalar type) {
        const double value = number(type);
        if (value < 0) fail("has a negative length or corner");
        return static_cast<std::uint32_t>(value);
    }
    void skip(scalar type) { static_cast<void>(number(type)); }
    [[nodiscard]] static std::size_t place(std::uint64_t face) { return face; }
    void end() const {
        if (bytes_.find_first_not_of(" \t\r\n") != std::string_view::npos)
            throw aabb::input_error(file_ + ": goes on for " + std::to_string(bytes_.size()) +
                                    " bytes after the last element that its header announces");
    }
    [[nodiscard]] std::size_t rounded() const { return rounded_; }
    static constexpr std::string_view before_place = ": face ";

private:
    /// Every scalar of PLY is a double exactly.
    [[nodiscard]] double number(scalar type) {
        switch (type) {
            case scalar::i8: return take<std::int8_t>();
            case scalar::u8: return take<std::uint8_t>();
            case scalar::i16: return take<std::int16_t>();
            case scalar::u16: return take<std::uint16_t>();
            case scalar::i32: return take<std::int32_t>();
            case scalar::u32: return take<std::uint32_t>();
            case scalar::f32: return static_cast<double>(take<float>());
            case scalar::f64: return take<double>();
        }
        return 0;
    }
    template <class Value>
    [[nodiscard]] Value take() {
        std::array<char, sizeof(Value)> raw{};
        if (bytes_.size() < raw.size())
            throw aabb::input_error(file_ + ": ends in element " + std::to_string(index_) + " of " +
                                    std::to_string(element_->count) + " elements " + in_quotes(element_->name));
        bytes_.copy(raw.data(), raw.size());
        bytes_.remove_prefix(raw.size());
        if (big_) std::ranges::reverse(raw);
        return std::bit_cast<Value>(raw);
    }
    [[noreturn]] void fail(const std::string& what) const {
        throw aabb::input_error(file_ + ": " + element_->name + " " + std::to_string(index_) + " " + what);
    }

    std::string file_;
    std::string_view bytes_;
    bool big_;
    const element* element_ = nullptr;
    std::uint64_t index_ = 0;
    std::size_t rounded_ = 0;
};

template <class Values>
loaded_mesh read_elements(const file_text& file, const header& h, Values values) {
    mesh_builder mesh(file.name);
    std::vector<std::uint32_t> corners;
    for (const element& e : h.elements)
        for (std::uint64_t index = 0; index < e.count; ++index) {
            values.begin(e, index);
            aabb::vec3f point{};
            for (const property& p : e.properties) {
                if (p.meaning == role::corners) {
                    corners.clear();
                    for (std::uint32_t left = values.whole(*p.count); left > 0; --left)
                        corners.push_back(values.whole(p.type));
                    mesh.add_face(corners, values.place(index));
                } else if (p.meaning != role::none) {
                    point[static_cast<int>(p.meaning) - static_cast<int>(role::x)] = values.coordinate(p.type);
                } else {
                    for (std::uint32_t left = p.count ? values.whole(*p.count) : 1; left > 0; --left)
                        values.skip(p.type);
                }
            }
            if (e.name == "vertex") mesh.add_vertex(point);
        }
    values.end();
    return mesh.finish(values.rounded(), file.name + std::string(Values::before_place), 0);
}

}  // namespace

loaded_mesh read_ply(const file_text& file) {
    text_scanner in(file, '\0');
    const header h = read_header(in);
    if (h.values == encoding::text) return read_elements(file, h, text_values(in));
    return read_elements(file, h, binary_values(file.name, in.rest(), h.values == encoding::big));
}

}  // namespace aabblab
