module aabblab.files;

import :text_decoder;

namespace aabblab {

namespace {

using namespace std::string_view_literals;

constexpr char ctrl_z = '\x1a';
constexpr char32_t replacement = 0xfffd;  // U+FFFD stands for malformed input

bool is_padding(char c) {
    return c == '\0' || c == ctrl_z;
}
bool is_blank(char c) {
    return c == ' ' || (c >= '\t' && c <= '\r');
}

bool is_high_surrogate(char32_t unit) {
    return unit >= 0xd800 && unit < 0xdc00;
}
bool is_low_surrogate(char32_t unit) {
    return unit >= 0xdc00 && unit < 0xe000;
}

void append_utf8(char32_t character, std::string& text) {
    const auto append = [&](char32_t byte) { text += static_cast<char>(byte); };
    const auto append_rest = [&](unsigned bits) { append(0x80U | (character >> bits & 0x3fU)); };
    if (character < 0x80) return append(character);
    if (character < 0x800) {
        append(0xc0U | character >> 6U);
    } else if (character < 0x10000) {
        append(0xe0U | character >> 12U);
        append_rest(6);
    } else {
        append(0xf0U | character >> 18U);
        append_rest(12);
        append_rest(6);
    }
    append_rest(0);
}

/// Whether decoding leaves the bytes unchanged, as for nearly every file.
bool is_plain(std::string_view bytes) {
    for (const std::string_view mark : {"\xef\xbb\xbf"sv, "\xff\xfe"sv, "\xfe\xff"sv})
        if (bytes.starts_with(mark)) return false;
    if (bytes.find('\0') != std::string_view::npos || bytes.find(ctrl_z) != std::string_view::npos) return false;
    const std::size_t first = bytes.find('\r');
    if (first == std::string_view::npos) return true;
    if (bytes.substr(0, first).find('\n') != std::string_view::npos) return true;
    const std::size_t next = bytes.find_first_not_of('\r', first);
    return next != std::string_view::npos && bytes[next] == '\n';
}

}  // namespace

text_encoding text_encoding_of(std::string_view bytes) noexcept {
    if (bytes.starts_with("\xff\xfe\0\0"sv) || bytes.starts_with("\0\0\xfe\xff"sv)) return text_encoding::utf32;
    if (bytes.starts_with("\xff\xfe")) return text_encoding::utf16_little;
    if (bytes.starts_with("\xfe\xff")) return text_encoding::utf16_big;
    const auto is_nul = [&](std::size_t i) { return i < bytes.size() && bytes[i] == 0; };
    const bool by_twos = bytes.size() >= 4 && is_nul(0) == is_nul(2) && is_nul(1) == is_nul(3);
    return by_twos && is_nul(0) != is_nul(1) ? text_encoding::utf16_unmarked : text_encoding::utf8;
}

void text_decoder::add(std::string_view bytes, std::string& text) {
    std::string begun;
    if (!encoding_) {
        start_ += bytes;
        begin(false);
        begun = encoding_ ? std::exchange(start_, {}) : "";
        bytes = begun;
    }
    if (!encoding_ || !problem_.empty()) return;
    if (*encoding_ == text_encoding::utf8)
        take(bytes, text);
    else
        take_utf16(bytes, text);
}

void text_decoder::finish(std::string& text) {
    if (!encoding_) {
        begin(true);
        add(std::exchange(start_, {}), text);
    }
    if (!problem_.empty()) return;
    // Padding may be a single byte after UTF-16.
    const bool is_cut_off = half_ && !is_padding(static_cast<char>(*half_));
    if (is_cut_off || high_surrogate_ != 0) take_character(replacement, text);
    // Nothing follows the pending carriage returns, so they end lines.
    text.append(std::exchange(returns_, 0), '\n');
}

/// Detects the encoding and drops the byte order mark, unless more bytes are needed.
/// @param is_whole whether no more bytes follow
void text_decoder::begin(bool is_whole) {
    constexpr std::string_view mark = "\xef\xbb\xbf";
    const std::string_view start = start_;
    const bool is_plain = start.size() >= 2 && start.substr(0, 2).find_first_of("\xef\xfe\xff\0"sv) == start.npos;
    if (!is_whole && !is_plain && start.size() < 4) return;
    encoding_ = text_encoding_of(start);
    if (*encoding_ == text_encoding::utf32) problem_ = "is text in UTF-32; expected UTF-8";
    if (*encoding_ == text_encoding::utf16_unmarked)
        problem_ = "is text in UTF-16 without a byte order mark; expected UTF-8";
    if (*encoding_ != text_encoding::utf8)
        start_.erase(0, 2);
    else if (start.starts_with(mark))
        start_.erase(0, mark.size());
}

void text_decoder::take_utf16(std::string_view bytes, std::string& text) {
    for (const char c : bytes) {
        const auto second = static_cast<unsigned char>(c);
        if (!half_) {
            half_ = second;
            continue;
        }
        const unsigned char first = *half_;
        half_.reset();
        const char32_t unit = *encoding_ == text_encoding::utf16_little ? first + second * 256U : second + first * 256U;
        const char32_t before = std::exchange(high_surrogate_, 0);
        if (before != 0 && is_low_surrogate(unit)) {
            take_character(0x10000 + ((before - 0xd800) << 10U) + (unit - 0xdc00), text);
            continue;
        }
        if (before != 0) take_character(replacement, text);
        if (is_high_surrogate(unit))
            high_surrogate_ = unit;
        else
            take_character(is_low_surrogate(unit) ? replacement : unit, text);
    }
}

void text_decoder::take_character(char32_t character, std::string& text) {
    std::string utf8;
    append_utf8(character, utf8);
    take(utf8, text);
}

/// Whether the bytes can be copied: lines end in line feeds, and no byte may be padding.
bool text_decoder::is_unchanged(std::string_view utf8) const noexcept {
    return ends_ == line_end::feed && padding_ == ' ' && std::ranges::none_of(utf8, is_padding);
}

void text_decoder::take(std::string_view utf8, std::string& text) {
    if (is_unchanged(utf8)) {
        line_ += static_cast<std::size_t>(std::ranges::count(utf8, '\n'));
        text += utf8;
        return;
    }
    for (const char c : utf8) {
        if (!problem_.empty()) return;
        take_byte(c, text);
    }
}

void text_decoder::take_byte(char c, std::string& text) {
    if (is_padding(c)) {
        if (padding_ == ' ') padding_ = c;
        return;
    }
    if (padding_ != ' ') {
        if (is_blank(c)) return;
        problem_ = std::string("is not text: ") + (padding_ == ctrl_z ? "Ctrl-Z" : "a NUL byte") + " in line " +
                   std::to_string(line_) + ", with more text after it";
        return;
    }
    if (ends_ == line_end::unknown) {
        if (c == '\r') {
            ++returns_;
            return;
        }
        if (c == '\n')
            ends_ = line_end::feed;
        else if (returns_ > 0)
            ends_ = line_end::carriage_return;
        const char end = ends_ == line_end::feed ? '\r' : '\n';
        line_ += end == '\n' ? returns_ : 0;
        text.append(std::exchange(returns_, 0), end);
    }
    // If lines end in carriage returns, the roles of both characters are swapped.
    if (ends_ == line_end::carriage_return && (c == '\r' || c == '\n')) c = c == '\r' ? '\n' : '\r';
    line_ += c == '\n';
    text += c;
}

decoded_text decoded(std::string bytes) {
    if (is_plain(bytes)) return {std::move(bytes), {}};
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
