module aabblab.files;

import :file_text;
import :gltf_asset;
import :scalar;

namespace aabblab {

namespace {

/// Elements that are known to lie in a buffer.
struct elements {
    const char* first = nullptr;
    std::size_t stride = 0;
    std::size_t count = 0;

    [[nodiscard]] const char* operator[](std::size_t i) const { return first + i * stride; }
};

class number_reader {
public:
    number_reader(const gltf_asset& asset, const file_text& file, std::size_t accessor)
        : asset_(asset),
          file_(file),
          name_(gltf_place("accessors", accessor)),
          accessor_(gltf_element(file, asset.accessors, "accessors", accessor)) {}

    [[nodiscard]] std::vector<double> read(bool no_view_means_zeros) const {
        const gltf_accessor& a = accessor_;
        if (!a.view && !a.sparse && !no_view_means_zeros)
            file_.fail(name_ + " has no bufferView, so its numbers are not in the file");
        const std::size_t width = width_of(a.type);
        const scalar type = scalar_of(a.component);
        const std::size_t bytes = width * bytes_of(type);
        const elements dense = a.view ? elements_of(*a.view, a.offset, a.count, bytes) : elements{};
        // Without a view, nothing but this number says how many there are.
        require_memory(file_.name + ": " + name_, static_cast<double>(a.count) * static_cast<double>(width) * 8);
        std::vector<double> numbers(a.count * width);
        if (a.view)
            for (std::size_t i = 0; i < a.count; ++i) read_element(dense[i], type, width, &numbers[i * width]);
        if (a.sparse) replace(*a.sparse, type, width, numbers);
        return numbers;
    }

private:
    [[nodiscard]] std::size_t width_of(std::string_view type) const {
        for (const auto& [known, width] : {std::pair("SCALAR", 1), {"VEC3", 3}, {"VEC4", 4}, {"MAT4", 16}})
            if (type == known) return static_cast<std::size_t>(width);
        file_.fail(name_ + " has the type " + in_quotes(type) + ", which is not read");
    }
    [[nodiscard]] scalar scalar_of(gltf_component component) const {
        switch (component) {
            case gltf_component::i8: return scalar::i8;
            case gltf_component::u8: return scalar::u8;
            case gltf_component::i16: return scalar::i16;
            case gltf_component::u16: return scalar::u16;
            case gltf_component::u32: return scalar::u32;
            case gltf_component::f32: return scalar::f32;
        }
        file_.fail(name_ + " has the componentType " + std::to_string(static_cast<std::size_t>(component)) +
                   ", which is none");
    }

    [[nodiscard]] elements elements_of(std::size_t index, std::size_t offset, std::size_t count,
                                       std::size_t bytes) const {
        const std::string view_name = gltf_place("bufferViews", index);
        const gltf_view& view = gltf_element(file_, asset_.views, "bufferViews", index);
        const std::string& held = gltf_element(file_, asset_.buffers, "buffers", view.buffer).bytes;
        if (view.offset > held.size() || view.length > held.size() - view.offset)
            file_.fail(view_name + " reaches beyond the end of " + gltf_place("buffers", view.buffer));
        const std::size_t stride = view.stride.value_or(bytes);
        if (stride < bytes)
            file_.fail(view_name + " has a byteStride below the " + std::to_string(bytes) + " bytes of one");
        if (count > 0 && (offset > view.length || view.length - offset < bytes ||
                          (view.length - offset - bytes) / stride < count - 1))
            file_.fail(name_ + " reaches beyond the end of " + view_name);
        return {count > 0 ? held.data() + view.offset + offset : nullptr, stride, count};
    }

    /// @param where its numbers go, `width` of them
    void read_element(const char* bytes, scalar type, std::size_t width, double* where) const {
        for (std::size_t k = 0; k < width; ++k) {
            where[k] = number_at(bytes + k * bytes_of(type), type);
            if (accessor_.normalized && is_whole(type)) where[k] = std::max(where[k] / greatest(type), -1.0);
        }
    }

    void replace(const gltf_sparse& sparse, scalar type, std::size_t width, std::vector<double>& numbers) const {
        if (sparse.index_component == gltf_component::f32)
            file_.fail(name_ + ".sparse.indices must be of whole numbers, as it has indices");
        const scalar index_type = scalar_of(sparse.index_component);
        const elements indices =
            elements_of(sparse.indices.view, sparse.indices.offset, sparse.count, bytes_of(index_type));
        const elements values =
            elements_of(sparse.values.view, sparse.values.offset, sparse.count, width * bytes_of(type));
        for (std::size_t i = 0; i < sparse.count; ++i) {
            std::uint32_t index = 0;  // the format is little-endian, as the machine is
            std::memcpy(&index, indices[i], bytes_of(index_type));
            if (index >= accessor_.count)
                file_.fail(name_ + " replaces element " + std::to_string(index) + ", but has " +
                           std::to_string(accessor_.count) + ", counted from 0");
            read_element(values[i], type, width, &numbers[index * width]);
        }
    }

    const gltf_asset& asset_;
    const file_text& file_;
    std::string name_;
    const gltf_accessor& accessor_;
};

}  // namespace

std::vector<double> gltf_numbers(const gltf_asset& asset, const file_text& file, std::size_t accessor,
                                 bool no_view_means_zeros) {
    return number_reader(asset, file, accessor).read(no_view_means_zeros);
}

}  // namespace aabblab
