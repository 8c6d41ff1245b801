module;
#include <algorithm>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <limits>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

module aabblab.files;

import aabb.base;
import :file_text;
import :gltf_asset;

namespace aabblab {

namespace {

/// Elements that are known to lie in a buffer.
struct elements {
    const char* first = nullptr;
    std::size_t stride = 0;
    std::size_t count = 0;
};

class number_reader {
public:
    number_reader(const gltf_asset& asset, const file_text& file, std::size_t accessor)
        : asset_(asset), file_(file), name_(gltf_place("accessors", accessor)) {
        if (accessor >= asset.accessors.size()) fail(name_ + " is used, but is not there");
        accessor_ = &asset.accessors[accessor];
    }

    [[nodiscard]] std::vector<double> read(bool no_view_means_zeros) const {
        const gltf_accessor& a = *accessor_;
        if (!a.view && !a.sparse && !no_view_means_zeros)
            fail(name_ + " has no bufferView, so its numbers are not in the file");
        const std::size_t width = width_of(a.type);
        const std::size_t bytes = width * bytes_of(a.component);
        const elements dense = a.view ? elements_of(*a.view, a.offset, a.count, bytes) : elements{};
        // Without a view, nothing but this number says how many there are.
        require_memory(file_.name + ": " + name_, static_cast<double>(a.count) * static_cast<double>(width) * 8);
        std::vector<double> numbers(a.count * width);
        if (a.view)
            for (std::size_t i = 0; i < a.count; ++i) read_element(dense, i, width, &numbers[i * width]);
        if (a.sparse) replace(*a.sparse, width, bytes, numbers);
        return numbers;
    }

private:
    [[noreturn]] void fail(const std::string& sentence) const { throw aabb::input_error(file_.name + ": " + sentence); }

    [[nodiscard]] std::size_t width_of(std::string_view type) const {
        for (const auto& [known, width] : {std::pair("SCALAR", 1), {"VEC3", 3}, {"VEC4", 4}, {"MAT4", 16}})
            if (type == known) return static_cast<std::size_t>(width);
        fail(name_ + " has the type " + in_quotes(type) + ", which is not read");
    }
    [[nodiscard]] std::size_t bytes_of(gltf_component component) const {
        switch (component) {
            case gltf_component::i8:
            case gltf_component::u8: return 1;
            case gltf_component::i16:
            case gltf_component::u16: return 2;
            case gltf_component::u32:
            case gltf_component::f32: return 4;
        }
        fail(name_ + " has the componentType " + std::to_string(static_cast<std::size_t>(component)) +
             ", which is none");
    }

    [[nodiscard]] elements elements_of(std::size_t index, std::size_t offset, std::size_t count,
                                       std::size_t bytes) const {
        const std::string view_name = gltf_place("bufferViews", index);
        if (index >= asset_.views.size()) fail(view_name + " is used, but is not there");
        const gltf_view& view = asset_.views[index];
        const std::string buffer_name = gltf_place("buffers", view.buffer);
        if (view.buffer >= asset_.buffers.size()) fail(buffer_name + " is used, but is not there");
        const std::string& held = asset_.buffers[view.buffer].bytes;
        if (view.offset > held.size() || view.length > held.size() - view.offset)
            fail(view_name + " reaches beyond the end of " + buffer_name);
        const std::size_t stride = view.stride.value_or(bytes);
        if (stride < bytes) fail(view_name + " has a byteStride below the " + std::to_string(bytes) + " bytes of one");
        if (count > 0 && (offset > view.length || view.length - offset < bytes ||
                          (view.length - offset - bytes) / stride < count - 1))
            fail(name_ + " reaches beyond the end of " + view_name);
        return {count > 0 ? held.data() + view.offset + offset : nullptr, stride, count};
    }

    /// @param where numbers of one element go, `width` of them
    void read_element(const elements& from, std::size_t index, std::size_t width, double* where) const {
        const char* const bytes = from.first + index * from.stride;
        switch (accessor_->component) {
            case gltf_component::i8: return read_components<std::int8_t>(bytes, width, where);
            case gltf_component::u8: return read_components<std::uint8_t>(bytes, width, where);
            case gltf_component::i16: return read_components<std::int16_t>(bytes, width, where);
            case gltf_component::u16: return read_components<std::uint16_t>(bytes, width, where);
            case gltf_component::u32: return read_components<std::uint32_t>(bytes, width, where);
            case gltf_component::f32: return read_components<float>(bytes, width, where);
        }
    }
    template <class Component>
    void read_components(const char* bytes, std::size_t width, double* where) const {
        for (std::size_t k = 0; k < width; ++k) {
            Component read{};
            std::memcpy(&read, bytes + k * sizeof read, sizeof read);
            where[k] = static_cast<double>(read);
            if constexpr (std::integral<Component>)
                if (accessor_->normalized)
                    where[k] = std::max(where[k] / static_cast<double>(std::numeric_limits<Component>::max()), -1.0);
        }
    }

    void replace(const gltf_sparse& sparse, std::size_t width, std::size_t bytes, std::vector<double>& numbers) const {
        if (sparse.index_component == gltf_component::f32)
            fail(name_ + ".sparse.indices must be of whole numbers, as it has indices");
        const std::size_t index_bytes = bytes_of(sparse.index_component);
        const elements indices = elements_of(sparse.indices.view, sparse.indices.offset, sparse.count, index_bytes);
        const elements values = elements_of(sparse.values.view, sparse.values.offset, sparse.count, bytes);
        for (std::size_t i = 0; i < sparse.count; ++i) {
            std::uint32_t index = 0;  // the format is little-endian, as the machine is
            std::memcpy(&index, indices.first + i * indices.stride, index_bytes);
            if (index >= accessor_->count)
                fail(name_ + " replaces element " + std::to_string(index) + ", but has " +
                     std::to_string(accessor_->count) + ", counted from 0");
            read_element(values, i, width, &numbers[index * width]);
        }
    }

    const gltf_asset& asset_;
    const file_text& file_;
    std::string name_;
    const gltf_accessor* accessor_ = nullptr;
};

}  // namespace

std::vector<double> gltf_numbers(const gltf_asset& asset, const file_text& file, std::size_t accessor,
                                 bool no_view_means_zeros) {
    return number_reader(asset, file, accessor).read(no_view_means_zeros);
}

}  // namespace aabblab
