module;
#include <fcntl.h>
#include <linux/magic.h>
#include <sys/stat.h>
#include <sys/vfs.h>
#include <unistd.h>

#include <cerrno>

module aabblab.files;

import :file_text;

namespace aabblab {

namespace {

constexpr std::size_t most_at_once = 65'536;
/// Lines of every format are far shorter; the limit is for endless input without line ends.
constexpr std::size_t longest_line = std::size_t{1} << 24U;

/// Streams the bytes of a file, a pipe or a device.
class byte_source {
public:
    /// Opens the file for reading.
    /// @param name replaces the file's name in messages
    /// @throws aabb::input_error if the file cannot be opened, is a folder, or is a named pipe that has no writer
    /// within a few seconds.
    explicit byte_source(const std::filesystem::path& file, const std::string& name = {})
        : name_(name.empty() ? file.string() : name),
          descriptor_(open(file.c_str(), O_RDONLY | O_CLOEXEC | O_NOCTTY | O_NONBLOCK)) {
        if (descriptor_ < 0) reject(name_, errno == ENOENT ? "no such file" : "cannot be read: " + system_error_text());
        try {
            struct stat status{};
            if (fstat(descriptor_, &status) != 0) reject(name_, "cannot be read: " + system_error_text());
            if (S_ISDIR(status.st_mode)) reject(name_, "is a folder, not a file");
            if (S_ISREG(status.st_mode)) size_ = static_cast<std::uintmax_t>(status.st_size);
            if (S_ISFIFO(status.st_mode)) wait_for_writer();
            // O_NONBLOCK keeps open() from waiting for a writer forever; reads block from here on.
            if (fcntl(descriptor_, F_SETFL, 0) != 0) reject(name_, "cannot be read: " + system_error_text());
        } catch (...) {
            close(descriptor_);
            throw;
        }
    }
    /// Reads standard input.
    byte_source() : name_("standard input"), descriptor_(STDIN_FILENO) {}
    byte_source(const byte_source&) = delete;
    byte_source& operator=(const byte_source&) = delete;
    ~byte_source() {
        if (descriptor_ != STDIN_FILENO) close(descriptor_);
    }

    [[nodiscard]] const std::string& name() const noexcept { return name_; }
    /// The size in bytes; 0 if it is unknown.
    [[nodiscard]] std::uintmax_t size() const noexcept { return size_; }

    /// Appends the available bytes, at most `most`; blocks until there are any.
    /// @returns false at the end
    /// @throws aabb::input_error if reading fails.
    bool read(std::size_t most, std::string& bytes) {
        if (!ahead_.empty()) {
            bytes += ahead_;
            ahead_.clear();
            return true;
        }
        const std::size_t before = bytes.size();
        bytes.resize(before + most);
        ssize_t count = 0;
        do count = ::read(descriptor_, bytes.data() + before, most);
        while (count < 0 && errno == EINTR);
        if (count < 0)
            reject(name_, errno == EISDIR ? "is a folder, not a file" : "cannot be read: " + system_error_text());
        bytes.resize(before + static_cast<std::size_t>(count));
        return count > 0;
    }

private:
    /// Anonymous pipes, such as those of <(command), had a writer from the start, so their end is not awaited.
    void wait_for_writer() {
        struct statfs system{};
        if (fstatfs(descriptor_, &system) == 0 && system.f_type == PIPEFS_MAGIC) return;
        constexpr std::chrono::seconds timeout{3};
        const auto end = std::chrono::steady_clock::now() + timeout;
        for (;;) {
            std::array<char, 1> first{};
            const ssize_t count = ::read(descriptor_, first.data(), first.size());
            if (count > 0) ahead_ = first[0];
            if (count != 0) return;  // data, or a writer that has not written yet
            if (std::chrono::steady_clock::now() > end) reject(name_, "is a named pipe with no writer");
            std::this_thread::sleep_for(std::chrono::milliseconds(10));
        }
    }

    std::string name_;
    int descriptor_;
    std::uintmax_t size_ = 0;
    std::string ahead_;  // read while waiting for a writer
};

}  // namespace

struct line_stream::state {
    byte_source source;
    text_decoder decoder;
    std::string bytes;
    std::string text;    // the decoded text that is not consumed yet
    std::size_t at = 0;  // the offset of the next line in it
    bool ended = false;
    std::uintmax_t read = 0;
    std::string_view line;
    std::size_t number = 0;

    state() = default;
    state(const std::filesystem::path& file, const std::string& name) : source(file, name) {}

    /// Reads and decodes another block, and detects the end.
    void read_block() {
        bytes.clear();
        if (source.read(most_at_once, bytes))
            decoder.add(bytes, text);
        else {
            ended = true;
            decoder.finish(text);
        }
        read += bytes.size();
        ended |= !decoder.problem().empty();
    }
};

line_stream::line_stream() : state_(std::make_unique<state>()) {}
line_stream::line_stream(const std::filesystem::path& file, const std::string& name)
    : state_(std::make_unique<state>(file, name)) {}
line_stream::~line_stream() = default;
line_stream::line_stream(line_stream&&) noexcept = default;

bool line_stream::next() {
    state& s = *state_;
    ++s.number;
    const std::uintmax_t read_before = s.read;
    std::size_t end = 0;
    std::size_t searched = s.at;
    while ((end = s.text.find('\n', searched)) == std::string::npos && !s.ended) {
        if (s.read - read_before > longest_line)
            fail("the line is longer than " + std::to_string(longest_line) + " bytes; expected text of short lines");
        s.text.erase(0, s.at);
        s.at = 0;
        searched = s.text.size();
        s.read_block();
    }
    // Valid lines before malformed text are returned first.
    if (end == std::string::npos && !s.decoder.problem().empty()) reject(s.source.name(), s.decoder.problem());
    if (end == std::string::npos && s.at == s.text.size()) return false;
    const std::size_t length = end == std::string::npos ? std::string::npos : end - s.at;
    s.line = line_without_return(std::string_view(s.text).substr(s.at, length),
                                 [this](const std::string& sentence) { fail(sentence); });
    s.at = end == std::string::npos ? s.text.size() : end + 1;
    return true;
}

std::string_view line_stream::line() const noexcept {
    return state_->line;
}
std::size_t line_stream::number() const noexcept {
    return state_->number;
}
std::uintmax_t line_stream::bytes_read() const noexcept {
    return state_->read;
}
std::uintmax_t line_stream::size() const noexcept {
    return state_->source.size();
}

void line_stream::fail(const std::string& sentence) const {
    reject(state_->source.name() + ":" + std::to_string(state_->number), sentence);
}

std::string text_of_file(const std::filesystem::path& file, std::size_t most) {
    byte_source source(file);
    std::string bytes;
    while (bytes.size() <= most && source.read(most + 1 - bytes.size(), bytes)) continue;
    // A truncated text is not decoded: the caller rejects it as too long.
    return bytes.size() > most ? bytes : as_text({source.name(), std::move(bytes)}).text;
}

}  // namespace aabblab
