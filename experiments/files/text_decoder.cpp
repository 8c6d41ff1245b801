module aabblab.files;

import :text_decoder;

namespace aabblab {

namespace {

using namespace std::string_view_literals;

constexpr char ctrl_z = '\x1a';
constexpr char32_t replacement = 0xfffd;  // U+FFFD stands for malformed input

constexpr auto is_padding = [](char c) { return c == '\0' || c == ctrl_z; };
constexpr auto is_blank = [](char c) { return c == ' ' || (c >= '\t' && c <= '\r'); };
constexpr auto is_high_surrogate = [](char32_t unit) { return unit >= 0xd800 && unit < 0xdc00; };
constexpr auto is_low_surrogate = [](char32_t unit) { return unit >= 0xdc00 && unit < 0xe000; };

/// Appends a character in UTF-8: a byte that holds its upper bits and the length, then six bits in each byte.
void append_utf8(char32_t character, std::string& text) {
    const auto append = [&](char32_t byte) { text += static_cast<char>(byte); };
    const auto append_six_bits = [&](unsigned shift) { append(0x80U | (character >> shift & 0x3fU)); };
    if (character < 0x80) return append(character);
    if (character < 0x800) {
        append(0xc0U | character >> 6U);
    } else if (character < 0x10000) {
        append(0xe0U | character >> 12U);
        append_six_bits(6);
    } else {
        append(0xf0U | character >> 18U);
        append_six_bits(12);
        append_six_bits(6);
    }
    append_six_bits(0);
}

/// Whether decoding leaves the bytes unchanged, as for nearly every file: no byte order mark, no padding, and a first
/// line that does not end in carriage returns alone. Only if it does are the line ends of the whole text converted.
bool is_plain(std::string_view bytes) {
    for (const std::string_view mark : {"\xef\xbb\xbf"sv, "\xff\xfe"sv, "\xfe\xff"sv})
        if (bytes.starts_with(mark)) return false;
    if (bytes.find('\0') != std::string_view::npos || bytes.find(ctrl_z) != std::string_view::npos) return false;
    const std::size_t first_return = bytes.find('\r');
    if (first_return == std::string_view::npos) return true;
    if (bytes.substr(0, first_return).find('\n') != std::string_view::npos) return true;
    // Carriage returns before a line feed belong to its line end: CR LF, or CR CR LF if it was converted twice.
    const std::size_t after_returns = bytes.find_first_not_of('\r', first_return);
    return after_returns != std::string_view::npos && bytes[after_returns] == '\n';
}

}  // namespace

/// Detects the encoding by the byte order mark, UTF-16 without one by alternating zeros in the first four bytes.
text_encoding text_encoding_of(std::string_view bytes) noexcept {
    if (bytes.starts_with("\xff\xfe\0\0"sv) || bytes.starts_with("\0\0\xfe\xff"sv)) return text_encoding::utf32;
    if (bytes.starts_with("\xff\xfe")) return text_encoding::utf16_little;
    if (bytes.starts_with("\xfe\xff")) return text_encoding::utf16_big;
    const auto is_nul = [&](std::size_t i) { return i < bytes.size() && bytes[i] == 0; };
    const bool alternates = bytes.size() >= 4 && is_nul(0) == is_nul(2) && is_nul(1) == is_nul(3);
    return alternates && is_nul(0) != is_nul(1) ? text_encoding::utf16_unmarked : text_encoding::utf8;
}

/// Decodes and appends the next bytes, which wait in `undetected_` until they suffice to detect the encoding.
void text_decoder::add(std::string_view bytes, std::string& text) {
    std::string first_bytes;
    if (!encoding_) {
        undetected_ += bytes;
        detect_encoding(/*is_at_end=*/false);
        first_bytes = encoding_ ? std::exchange(undetected_, {}) : "";
        bytes = first_bytes;
    }
    if (!encoding_ || !problem_.empty()) return;
    // Only UTF-8 and UTF-16 with a mark are left: `detect_encoding` sets a problem for others.
    if (*encoding_ == text_encoding::utf8)
        append_with_line_feeds(bytes, text);
    else
        append_utf16(bytes, text);
}

/// Ends the file, and appends what waited: short texts, an incomplete character (as U+FFFD), carriage returns.
void text_decoder::finish(std::string& text) {
    if (!encoding_) {
        detect_encoding(/*is_at_end=*/true);
        add(std::exchange(undetected_, {}), text);
    }
    if (!problem_.empty()) return;
    // Padding may be a single byte after UTF-16.
    const bool is_cut_off = first_byte_ && !is_padding(static_cast<char>(*first_byte_));
    if (is_cut_off || high_surrogate_ != 0) append_character(replacement, text);
    // Nothing follows the pending carriage returns, so they end lines.
    text.append(std::exchange(pending_returns_, 0), '\n');
}

/// Detects the encoding of `undetected_`, and drops a byte order mark; waits if the file has needed bytes.
void text_decoder::detect_encoding(bool is_at_end) {
    constexpr std::string_view mark = "\xef\xbb\xbf";
    const std::string_view start = undetected_;
    // Two bytes suffice for UTF-8 without a mark: neither is zero or belongs to a mark.
    const bool is_unmarked_utf8 =
        start.size() >= 2 && start.substr(0, 2).find_first_of("\xef\xfe\xff\0"sv) == start.npos;
    if (!is_at_end && !is_unmarked_utf8 && start.size() < 4) return;
    encoding_ = text_encoding_of(start);
    if (*encoding_ == text_encoding::utf32) problem_ = "is text in UTF-32; expected UTF-8";
    if (*encoding_ == text_encoding::utf16_unmarked)
        problem_ = "is text in UTF-16 without a byte order mark; expected UTF-8";
    if (*encoding_ != text_encoding::utf8)
        undetected_.erase(0, 2);
    else if (start.starts_with(mark))
        undetected_.erase(0, mark.size());
}

/// Converts UTF-16; two surrogate units encode a character beyond U+FFFF. As a call may end within a unit or a pair,
/// the first byte and the high surrogate are kept. An unpaired surrogate becomes U+FFFD.
void text_decoder::append_utf16(std::string_view bytes, std::string& text) {
    for (const char c : bytes) {
        const auto second = static_cast<unsigned char>(c);
        if (!first_byte_) {
            first_byte_ = second;
            continue;
        }
        const unsigned char first = *std::exchange(first_byte_, std::nullopt);
        const char32_t unit = *encoding_ == text_encoding::utf16_little ? first + second * 256U : second + first * 256U;
        const char32_t high = std::exchange(high_surrogate_, 0);
        if (high != 0 && is_low_surrogate(unit)) {
            append_character(0x10000 + ((high - 0xd800) << 10U) + (unit - 0xdc00), text);
            continue;
        }
        if (high != 0) append_character(replacement, text);
        if (is_high_surrogate(unit))
            high_surrogate_ = unit;
        else
            append_character(is_low_surrogate(unit) ? replacement : unit, text);
    }
}

void text_decoder::append_character(char32_t character, std::string& text) {
    std::string utf8;
    append_utf8(character, utf8);
    append_with_line_feeds(utf8, text);
}

/// Whether the bytes can be copied: lines end in line feeds, and no byte may be padding.
bool text_decoder::is_unchanged(std::string_view utf8) const noexcept {
    return line_end_ == line_end::feed && padding_ == ' ' && std::ranges::none_of(utf8, is_padding);
}

/// Appends UTF-8 with line ends converted to line feeds and padding dropped, at once if neither can occur in it.
void text_decoder::append_with_line_feeds(std::string_view utf8, std::string& text) {
    if (is_unchanged(utf8)) {
        line_ += static_cast<std::size_t>(std::ranges::count(utf8, '\n'));
        text += utf8;
        return;
    }
    for (const char c : utf8) {
        if (!problem_.empty()) return;
        append_byte(c, text);
    }
}

/// Appends a byte of UTF-8. Padding (NUL or Ctrl-Z) is dropped, and is an error before further text. Carriage returns
/// at the end of the first line wait: if no line feed follows, they end all lines, and become line feeds.
void text_decoder::append_byte(char c, std::string& text) {
    if (is_padding(c)) {
        if (padding_ == ' ') padding_ = c;  // the first one; a blank stands for none
        return;
    }
    if (padding_ != ' ') {
        if (is_blank(c)) return;
        problem_ = std::string("is not text: ") + (padding_ == ctrl_z ? "Ctrl-Z" : "a NUL byte") + " in line " +
                   std::to_string(line_) + ", with more text after it";
        return;
    }
    if (line_end_ == line_end::unknown) {
        if (c == '\r') {
            ++pending_returns_;
            return;
        }
        if (c == '\n')
            line_end_ = line_end::feed;
        else if (pending_returns_ > 0)
            line_end_ = line_end::carriage_return;
        // Appends the carriage returns that waited.
        const char end = line_end_ == line_end::feed ? '\r' : '\n';
        line_ += end == '\n' ? pending_returns_ : 0;
        text.append(std::exchange(pending_returns_, 0), end);
    }
    // If lines end in carriage returns, both characters are swapped, so that readers still see a mixture of line ends.
    if (line_end_ == line_end::carriage_return && (c == '\r' || c == '\n')) c = c == '\r' ? '\n' : '\r';
    line_ += c == '\n';
    text += c;
}

/// Decodes a file piece by piece, as most need no conversion. @returns the text, and the reason if it is not text
decoded_text decoded(std::string bytes) {
    if (is_plain(bytes)) return {std::move(bytes), /*problem=*/{}};
    constexpr std::size_t piece = 65'536;
    text_decoder decoder;
    decoded_text result;
    for (std::size_t offset = 0; offset < bytes.size(); offset += piece)
        decoder.add(std::string_view(bytes).substr(offset, piece), result.text);
    decoder.finish(result.text);
    result.problem = decoder.problem();
    return result;
}

}  // namespace aabblab
