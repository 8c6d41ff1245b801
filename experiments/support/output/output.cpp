module;
#include <sys/ioctl.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>

module aabblab.output;

import aabb.base;
import aabblab.fmt;
import aabblab.text;

namespace aabblab {

namespace {

bool outlives_reader = false, reader_has_gone = false;

void handle_write_error(int error) {
    if (error != EPIPE)
        throw aabb::input_error("cannot write to standard output: " + std::generic_category().message(error));
    if (!outlives_reader) throw output_closed();
    reader_has_gone = true;
}

/// The length in bytes of the first character of UTF-8; 0 if it is a control character or invalid. Its first byte has
/// as many leading ones as it has bytes, each further byte begins with 10 and holds six bits.
std::size_t printable_length(std::string_view text) {
    const auto byte = [&](std::size_t i) { return static_cast<unsigned char>(text[i]); };
    if (byte(0) < 0x80) return byte(0) >= ' ' && byte(0) != 0x7f ? 1 : 0;
    const std::size_t length = byte(0) >= 0xf0 ? 4 : byte(0) >= 0xe0 ? 3 : 2;
    if (byte(0) < 0xc0 || byte(0) > 0xf4 || text.size() < length) return 0;
    std::uint32_t code = byte(0) & (0x7fU >> length);
    for (std::size_t i = 1; i < length; ++i) {
        if ((byte(i) & 0xc0U) != 0x80) return 0;
        code = code << 6U | (byte(i) & 0x3fU);
    }
    // Rejects C1 control characters, overlong forms, surrogates, and code points beyond Unicode.
    constexpr std::array<std::uint32_t, 5> least = {0, 0, 0xa0, 0x800, 0x10000};
    return code >= least[length] && (code < 0xd800 || code > 0xdfff) && code <= 0x10ffff ? length : 0;
}

constexpr std::size_t least_width = 40;

std::optional<std::size_t> width_of_terminal(int stream) {
    winsize window{};
    if (ioctl(stream, TIOCGWINSZ, &window) != 0 || window.ws_col == 0) return std::nullopt;
    return std::max<std::size_t>(window.ws_col, least_width);
}

/// Replaces control characters and invalid UTF-8 by hexadecimal escapes, so that text cannot control a terminal.
/// @param keep_lines whether line feeds stay
std::string escaped(std::string_view text, bool keep_lines) {
    std::string shown;
    while (!text.empty()) {
        const std::size_t length = keep_lines && text[0] == '\n' ? 1 : printable_length(text);
        if (length == 0)
            shown += fmt::format("\\x{:02x}", static_cast<unsigned char>(text[0]));
        else
            shown += text.substr(0, length);
        text.remove_prefix(std::max<std::size_t>(length, 1));
    }
    return shown;
}

}  // namespace

std::string visible(std::string_view text) {
    return escaped(text, /*keep_lines=*/false);
}

void print(std::string_view text) {
    if (reader_has_gone) return;
    const std::string shown = escaped(text, /*keep_lines=*/true);
    if (std::fwrite(shown.data(), 1, shown.size(), stdout) != shown.size()) handle_write_error(errno);
}

void flush_output() {
    if (!reader_has_gone && std::fflush(stdout) != 0) handle_write_error(errno);
}

void outlive_reader() {
    outlives_reader = true;
}

std::size_t output_width() {
    std::size_t width = 80;
    if (const char* columns = std::getenv("COLUMNS")) std::from_chars(columns, columns + std::strlen(columns), width);
    return std::max(width_of_terminal(STDOUT_FILENO).value_or(width), least_width);
}

std::size_t paragraph_width() {
    return std::min<std::size_t>(output_width(), 80);
}

/// Breaks text at blanks into lines of at most `most` characters; other blanks are kept.
std::string wrapped(std::string_view text, std::size_t most) {
    std::string lines;
    std::size_t width = 0;
    for (std::size_t from = 0; from < text.size();) {
        const std::size_t to = std::min(text.find(' ', from), text.size());
        const std::string_view word = text.substr(from, to - from);
        const std::size_t with_word = width + 1 + characters(word);
        const bool fits = with_word <= most;
        if (width > 0) lines += fits ? " " : "\n";
        width = width > 0 && fits ? with_word : characters(word);
        lines += word;
        from = to + 1;
    }
    return lines;
}

void print_paragraph(std::string_view text) {
    print(wrapped(text) + "\n");
}

/// A hanging indent: `before`, then the text, broken into lines of at most `most` characters and indented by it.
std::string hanging(std::string_view before, std::string_view text, std::size_t most) {
    const std::size_t indent = characters(before);
    std::string result(before);
    for (const char c : wrapped(text, most > indent ? most - indent : 0)) {
        result += c;
        if (c == '\n') result.append(indent, ' ');
    }
    return result;
}

/// A line of a list or of help: the name, then the text in a second column, or below a name that is too long.
std::string entry(std::string_view name, std::string_view text) {
    const std::size_t column = std::min<std::size_t>(30, output_width() / 2);
    const std::string pad(column, ' ');
    const std::size_t width = characters(name);
    if (text.empty()) return std::string(name) + "\n";
    if (width >= column) return std::string(name) + "\n" + hanging(pad, text) + "\n";
    return hanging(std::string(name) + pad.substr(width), text) + "\n";
}

void note(std::string_view text) {
    const std::string shown = visible(text);
    const std::optional<std::size_t> width = width_of_terminal(STDERR_FILENO);
    std::fprintf(stderr, "%s\n", (width ? hanging("aabblab: ", shown, *width) : "aabblab: " + shown).c_str());
}

}  // namespace aabblab
