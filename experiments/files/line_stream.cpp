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
/// No line of any format is nearly as long, but input without an end may have no end of a line either.
constexpr std::size_t longest_line = std::size_t{1} << 24U;

/// Bytes of a file, a pipe or a device as they come.
class byte_source {
public:
    /// Opens it for reading.
    /// @param name for messages, in place of the file's
    /// @throws aabb::input_error where that cannot be, where it is a folder, or a named pipe that nobody opens for
    /// writing within some seconds.
    explicit byte_source(const std::filesystem::path& file, const std::string& name = {})
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
    /// Standard input.
    byte_source() : name_("standard input"), descriptor_(STDIN_FILENO) {}
    byte_source(const byte_source&) = delete;
    byte_source& operator=(const byte_source&) = delete;
    ~byte_source() {
        if (descriptor_ != STDIN_FILENO) close(descriptor_);
    }

    [[nodiscard]] const std::string& name() const noexcept { return name_; }
    /// In bytes; 0 where it is not known.
    [[nodiscard]] std::uintmax_t size() const noexcept { return size_; }

    /// Appends what is there, at most so many bytes; waits until there is something.
    /// @returns false at the end
    /// @throws aabb::input_error where it cannot be read.
    bool read(std::size_t most, std::string& bytes) {
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
        if (got < 0)
            refuse(name_, errno == EISDIR ? "is a folder, not a file" : "cannot be read: " + system_error_text());
        bytes.resize(before + static_cast<std::size_t>(got));
        return got > 0;
    }

private:
    /// A pipe without a name, as a shell makes for <(command), had a writer from the first; its end is its end.
    void wait_for_writer() {
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
    std::string text;    // decoded, from some line on
    std::size_t at = 0;  // where the next line begins in it
    bool ended = false;
    std::uintmax_t read = 0;
    std::string_view line;
    std::size_t number = 0;

    state() = default;
    state(const std::filesystem::path& file, const std::string& name) : source(file, name) {}

    /// Decodes some more bytes; notices the end.
    void read_on() {
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
    const std::uintmax_t begun = s.read;
    std::size_t end = 0;
    std::size_t searched = s.at;
    while ((end = s.text.find('\n', searched)) == std::string::npos && !s.ended) {
        if (s.read - begun > longest_line)
            fail("the line is longer than " + std::to_string(longest_line) + " bytes; expected text of short lines");
        s.text.erase(0, s.at);
        s.at = 0;
        searched = s.text.size();
        s.read_on();
    }
    // Lines before what is no text were handed out first.
    if (end == std::string::npos && !s.decoder.problem().empty()) refuse(s.source.name(), s.decoder.problem());
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
    refuse(state_->source.name() + ":" + std::to_string(state_->number), sentence);
}

std::string text_of_file(const std::filesystem::path& file, std::size_t most) {
    byte_source source(file);
    std::string bytes;
    while (bytes.size() <= most && source.read(most + 1 - bytes.size(), bytes)) continue;
    // Cut off, it is no text any more, and too long as it is.
    return bytes.size() > most ? bytes : as_text({source.name(), std::move(bytes)}).text;
}

}  // namespace aabblab
