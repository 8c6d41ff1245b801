module;
#include <fcntl.h>
#include <linux/magic.h>
#include <sys/stat.h>
#include <sys/vfs.h>
#include <unistd.h>

#include <cerrno>

module aabblab.files;

import :byte_source;
import :file_text;

namespace aabblab {

byte_source::byte_source() : name_("standard input"), descriptor_(STDIN_FILENO) {}

byte_source::byte_source(const std::filesystem::path& file, const std::string& name)
    : name_(name.empty() ? file.string() : name),
      descriptor_(open(file.c_str(), O_RDONLY | O_CLOEXEC | O_NOCTTY | O_NONBLOCK)) {
    if (descriptor_ < 0) refuse(name_, errno == ENOENT ? "no such file" : "cannot be read: " + system_error_text());
    try {
        struct stat about{};
        if (fstat(descriptor_, &about) != 0) refuse(name_, "cannot be read: " + system_error_text());
        if (S_ISDIR(about.st_mode)) refuse(name_, "is a folder, not a file");
        if (S_ISREG(about.st_mode)) size_ = static_cast<std::uintmax_t>(about.st_size);
        if (S_ISFIFO(about.st_mode)) wait_for_writer();
        // Opened so as not to wait for a writer for ever; from here on it is waited for bytes.
        if (fcntl(descriptor_, F_SETFL, 0) != 0) refuse(name_, "cannot be read: " + system_error_text());
    } catch (...) {
        close(descriptor_);
        throw;
    }
}

byte_source::~byte_source() {
    if (descriptor_ != STDIN_FILENO) close(descriptor_);
}

/// A pipe without a name, as a shell makes for <(command), had a writer from the first; its end is its end.
void byte_source::wait_for_writer() {
    struct statfs system{};
    if (fstatfs(descriptor_, &system) == 0 && system.f_type == PIPEFS_MAGIC) return;
    constexpr std::chrono::seconds patience{3};
    const auto end = std::chrono::steady_clock::now() + patience;
    for (;;) {
        std::array<char, 1> first{};
        const ssize_t got = ::read(descriptor_, first.data(), first.size());
        if (got > 0) ahead_ = first[0];
        if (got != 0) return;  // something to read, or a writer that has not written yet
        if (std::chrono::steady_clock::now() > end) refuse(name_, "is a named pipe with no writer");
        std::this_thread::sleep_for(std::chrono::milliseconds(10));
    }
}

bool byte_source::read(std::size_t most, std::string& bytes) {
    if (!ahead_.empty()) {
        bytes += ahead_;
        ahead_.clear();
        return true;
    }
    const std::size_t before = bytes.size();
    bytes.resize(before + most);
    ssize_t got = 0;
    do got = ::read(descriptor_, bytes.data() + before, most);
    while (got < 0 && errno == EINTR);
    if (got < 0) refuse(name_, errno == EISDIR ? "is a folder, not a file" : "cannot be read: " + system_error_text());
    bytes.resize(before + static_cast<std::size_t>(got));
    return got > 0;
}

}  // namespace aabblab
