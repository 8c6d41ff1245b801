module;
#include <cstddef>
#include <cstdio>
#include <filesystem>
#include <string>

module aabblab.files;

import aabb.base;
import :file_text;

namespace aabblab {

file_text read_whole(const std::filesystem::path& file, std::size_t size, double times) {
    require_memory(file.string() + ": reading it", times * static_cast<double>(size));
    const file_handle opened = open_to_read(file);
    file_text whole{file.string(), std::string(size, '\0')};
    const std::size_t read = std::fread(whole.text.data(), 1, size, opened.get());
    if (read != size)
        throw aabb::input_error(whole.name + ": cannot be read beyond byte " + std::to_string(read) + " of " +
                                std::to_string(size));
    return whole;
}

}  // namespace aabblab
