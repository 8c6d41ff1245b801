module;
#include <unistd.h>

#include <cerrno>

module aabblab.files;

import aabblab.fmt;
import :file_text;

namespace aabblab {

namespace {

std::string size_text(double bytes) {
    if (bytes >= 0x1p30) return fmt::format("{:.1f} GiB", bytes * 0x1p-30);
    if (bytes >= 0x1p20) return fmt::format("{:.1f} MiB", bytes * 0x1p-20);
    if (bytes >= 0x1p10) return fmt::format("{:.1f} KiB", bytes * 0x1p-10);
    return fmt::format("{:.0f} bytes", bytes);
}

}  // namespace

std::array<std::string, 2> different_sizes(double a, double b) {
    if (size_text(a) != size_text(b)) return {size_text(a), size_text(b)};
    return {fmt::format("{:.0f} bytes", a), fmt::format("{:.0f} bytes", b)};
}

void require_memory(const std::string& work, double bytes) {
    const double memory = static_cast<double>(sysconf(_SC_PHYS_PAGES)) * static_cast<double>(sysconf(_SC_PAGE_SIZE));
    if (bytes <= memory) return;
    const auto [needed, available] = different_sizes(bytes, memory);
    throw aabb::input_error(work + " would take " + needed + " of memory, but this machine has " + available);
}

/// The size of a regular file in bytes; the message for anything else says what it is instead.
std::size_t size_of_file(const std::filesystem::path& file) {
    std::error_code error;
    const auto status = std::filesystem::status(file, error);
    if (status.type() == std::filesystem::file_type::not_found) reject(file, "no such file");
    if (status.type() == std::filesystem::file_type::none) reject(file, "cannot be read: " + error.message());
    if (is_directory(status)) reject(file, "is a folder, not a file");
    if (!is_regular_file(status)) reject(file, "is not a regular file");
    const auto size = std::filesystem::file_size(file, error);
    if (error) reject(file, "cannot be read: " + error.message());
    return size;
}

std::string system_error_text() {
    return std::error_code(errno, std::generic_category()).message();
}

input_file::input_file(const std::filesystem::path& file, std::size_t size)
    : name_(file), size_(size), file_(std::fopen(file.c_str(), "rb")) {
    if (!file_) reject(file, "cannot be read: " + system_error_text());
}

bool input_file::try_read(void* to, std::size_t bytes) {
    const std::size_t count = std::fread(to, 1, bytes, file_.get());
    done_ += count;
    return count == bytes;
}

void input_file::read(void* to, std::size_t bytes) {
    if (!try_read(to, bytes))
        reject(name_, "cannot be read beyond byte " + std::to_string(done_) + " of " + std::to_string(size_));
}

file_text read_file(const std::filesystem::path& file, std::size_t size, double memory_factor) {
    require_memory(file.string() + ": reading it", memory_factor * static_cast<double>(size));
    file_text content{file.string(), std::string(size, '\0')};
    input_file(file, size).read(content.text.data(), size);
    return content;
}

std::string bytes_of_file(const std::filesystem::path& file) {
    return read_file(file, size_of_file(file), /*memory_factor=*/1).text;
}

std::string text_of_file(const std::filesystem::path& file) {
    return as_text({file.string(), bytes_of_file(file)}).text;
}

}  // namespace aabblab
