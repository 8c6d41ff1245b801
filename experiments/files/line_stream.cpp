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
    /// Opens a file, a device or a pipe; rejects a named pipe that has no writer within a few seconds.
    /// @param name replaces the file's name in messages
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
    byte_source() : name_("standard input"), descriptor_(STDIN_FILENO) {}
    byte_source(const byte_source&) = delete;
    byte_source& operator=(const byte_source&) = delete;
    ~byte_source() {
        if (descriptor_ != STDIN_FILENO) close(descriptor_);
    }

    [[nodiscard]] const std::string& name() const noexcept { return name_; }
    /// The size in bytes; 0 if it is unknown.
    [[nodiscard]] std::uintmax_t size() const noexcept { return size_; }

    /// Appends the available bytes, at most `most`, and waits until a pipe has some. Returns false at the end.
    bool read(std::size_t most, std::string& bytes) {
        // First the byte that `wait_for_writer` has read.
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
    /// Waits a few seconds until a program opens the pipe for writing, which reads as ended until then. Anonymous
    /// pipes, such as those of <(command), had a writer from the start, so their end is not awaited.
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
    std::string block;
    std::string text;           // decoded; from next_line on not consumed yet
    std::size_t next_line = 0;  // its offset in the text
    bool has_ended = false;
    std::uintmax_t bytes_read = 0;
    std::string_view line;
    std::size_t line_number = 0;

    state() = default;
    state(const std::filesystem::path& file, const std::string& name) : source(file, name) {}

    /// Appends a decoded block to `text`. Sets `has_ended` at the end of the input, or if it is not text.
    void read_block() {
        block.clear();
        has_ended = !source.read(most_at_once, block);
        if (has_ended)
            decoder.finish(text);
        else
            decoder.add(block, text);
        bytes_read += block.size();
        has_ended |= !decoder.problem().empty();
    }
};

line_stream::line_stream() : state_(std::make_unique<state>()) {}
line_stream::line_stream(const std::filesystem::path& file, const std::string& name)
    : state_(std::make_unique<state>(file, name)) {}
line_stream::~line_stream() = default;
line_stream::line_stream(line_stream&&) noexcept = default;

/// Advances to the next line, at offset `next_line`; false after the last. Earlier lines are discarded to bound memory.
bool line_stream::next() {
    state& s = *state_;
    ++s.line_number;
    const std::uintmax_t read_before = s.bytes_read;
    std::size_t end = 0;
    std::size_t searched = s.next_line;  // no line feed before this offset
    while ((end = s.text.find('\n', searched)) == std::string::npos && !s.has_ended) {
        if (s.bytes_read - read_before > longest_line)
            fail("the line is longer than " + std::to_string(longest_line) + " bytes; expected text of short lines");
        s.text.erase(0, s.next_line);
        s.next_line = 0;
        searched = s.text.size();
        s.read_block();
    }
    // Valid lines before malformed text are returned first.
    if (end == std::string::npos && !s.decoder.problem().empty()) reject(s.source.name(), s.decoder.problem());
    if (end == std::string::npos && s.next_line == s.text.size()) return false;
    end = std::min(end, s.text.size());
    s.line = line_without_return(std::string_view(s.text).substr(s.next_line, end - s.next_line),
                                 [this](const std::string& sentence) { fail(sentence); });
    s.next_line = std::min(end + 1, s.text.size());
    return true;
}

std::string_view line_stream::line() const noexcept {
    return state_->line;
}
std::size_t line_stream::number() const noexcept {
    return state_->line_number;
}
std::uintmax_t line_stream::bytes_read() const noexcept {
    return state_->bytes_read;
}
std::uintmax_t line_stream::size() const noexcept {
    return state_->source.size();
}

void line_stream::fail(const std::string& sentence) const {
    reject(state_->source.name() + ":" + std::to_string(state_->line_number), sentence);
}

std::string text_of_file(const std::filesystem::path& file, std::size_t most) {
    byte_source source(file);
    std::string bytes;
    while (bytes.size() <= most && source.read(most + 1 - bytes.size(), bytes)) continue;
    // A truncated text is not decoded: the caller rejects it as too long.
    return bytes.size() > most ? bytes : as_text({source.name(), std::move(bytes)}).text;
}

}  // namespace aabblab
