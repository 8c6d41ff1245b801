module;
#include <algorithm>
#include <cerrno>
#include <cstddef>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <string>
#include <string_view>
#include <system_error>

/// A whole file in memory, and how its words are quoted to the user.
module aabblab.files:file_text;

import aabb.base;

namespace aabblab {

struct file_text {
    std::string name;  ///< as the user gave it
    std::string text;
};

/// The word in quotes, for a sentence: at most 40 bytes of it, and no part of a character.
[[nodiscard]] inline std::string in_quotes(std::string_view word) {
    std::size_t end = std::min<std::size_t>(word.size(), 40);
    while (end > 0 && end < word.size() && (static_cast<unsigned char>(word[end]) & 0xc0U) == 0x80) --end;
    return "'" + std::string(word.substr(0, end)) + (end < word.size() ? "…'" : "'");
}

/// Refuses what is not a file with something in it.
/// @return its size in bytes.
/// @throws aabb::input_error that says what it is instead.
[[nodiscard]] inline std::size_t require_file(const std::filesystem::path& file) {
    std::error_code error;
    const auto status = std::filesystem::status(file, error);
    if (status.type() == std::filesystem::file_type::not_found)
        throw aabb::input_error(file.string() + ": no such file");
    if (!status_known(status)) throw aabb::input_error(file.string() + ": cannot be read: " + error.message());
    if (is_directory(status)) throw aabb::input_error(file.string() + ": is a folder, not a file");
    if (!is_regular_file(status)) throw aabb::input_error(file.string() + ": is not a regular file");
    const auto size = std::filesystem::file_size(file, error);
    if (error) throw aabb::input_error(file.string() + ": cannot be read: " + error.message());
    if (size == 0) throw aabb::input_error(file.string() + ": is empty");
    return size;
}

struct close_file {
    void operator()(std::FILE* file) const noexcept { std::fclose(file); }
};
using file_handle = std::unique_ptr<std::FILE, close_file>;

/// @throws aabb::input_error when the file cannot be opened.
[[nodiscard]] inline file_handle open_to_read(const std::filesystem::path& file) {
    file_handle opened{std::fopen(file.c_str(), "rb")};
    if (!opened)
        throw aabb::input_error(file.string() +
                                ": cannot be read: " + std::error_code(errno, std::generic_category()).message());
    return opened;
}

/// All of a file.
/// @param size what `require_file` says
/// @param times how many times as much memory as the text what is read from it takes at most, the text included
/// @throws aabb::input_error when it cannot be read or does not fit into memory.
[[nodiscard]] file_text read_whole(const std::filesystem::path& file, std::size_t size, double times);

}  // namespace aabblab
