module;
#include <cerrno>
#include <cstddef>
#include <cstdio>
#include <filesystem>
#include <string>
#include <system_error>

module aabblab.files;

import aabb.base;
import :file_text;

namespace aabblab {

std::size_t size_of_file(const std::filesystem::path& file) {
    std::error_code error;
    const auto status = std::filesystem::status(file, error);
    if (status.type() == std::filesystem::file_type::not_found)
        throw aabb::input_error(file.string() + ": no such file");
    if (!status_known(status)) throw aabb::input_error(file.string() + ": cannot be read: " + error.message());
    if (is_directory(status)) throw aabb::input_error(file.string() + ": is a folder, not a file");
    if (!is_regular_file(status)) throw aabb::input_error(file.string() + ": is not a regular file");
    const auto size = std::filesystem::file_size(file, error);
    if (error) throw aabb::input_error(file.string() + ": cannot be read: " + error.message());
    return size;
}

file_handle open_to_read(const std::filesystem::path& file) {
    file_handle opened{std::fopen(file.c_str(), "rb")};
    if (!opened)
        throw aabb::input_error(file.string() +
                                ": cannot be read: " + std::error_code(errno, std::generic_category()).message());
    return opened;
}

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

std::string bytes_of_file(const std::filesystem::path& file) {
    return read_whole(file, size_of_file(file), 1).text;
}

std::string text_of_file(const std::filesystem::path& file) {
    return as_text({file.string(), bytes_of_file(file)}).text;
}

}  // namespace aabblab
