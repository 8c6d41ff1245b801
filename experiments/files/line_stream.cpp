module aabblab.files;

import :byte_source;
import :file_text;
import :text_decoder;

namespace aabblab {

namespace {

constexpr std::size_t most_at_once = 65'536;
/// No line of any format is nearly as long, but input without an end may have no end of a line either.
constexpr std::size_t longest_line = std::size_t{1} << 24U;

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
