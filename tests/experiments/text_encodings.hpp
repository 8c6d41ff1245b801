#pragma once

#include "../testing.hpp"

/// A text as another system or program writes it.
struct encoded_text {
    std::string encoding;
    std::string bytes;
};

[[nodiscard]] inline std::string with_line_ends(const std::string& text, const std::string& end) {
    std::string other;
    for (const char c : text) other += c == '\n' ? end : std::string(1, c);
    return other;
}

/// ASCII in two or four bytes per character.
[[nodiscard]] inline std::string widened(const std::string& ascii, std::size_t zeros_before, std::size_t zeros_after) {
    std::string wide;
    for (const char c : ascii) wide += std::string(zeros_before, '\0') + c + std::string(zeros_after, '\0');
    return wide;
}

/// Encodings of a text with line feeds that can be read unambiguously.
[[nodiscard]] inline std::vector<encoded_text> unambiguous_encodings(const std::string& text) {
    const std::string mark = "\xef\xbb\xbf";
    return {
        {"byte order mark", mark + text},
        {"carriage returns and line feeds", with_line_ends(text, "\r\n")},
        {"two carriage returns and a line feed", with_line_ends(text, "\r\r\n")},
        {"carriage returns alone", with_line_ends(text, "\r")},
        {"UTF-16, little-endian", "\xff\xfe" + widened(text, 0, 1)},
        {"UTF-16, big-endian", "\xfe\xff" + widened(text, 1, 0)},
        {"a trailing NUL", text + std::string(1, '\0')},
        {"a block of trailing NULs", text + std::string(5000, '\0')},
        {"trailing Ctrl-Z", text + "\x1a"},
        {"a trailing line with Ctrl-Z", text + "\x1a\r\n"},
        {"a mark, carriage returns and Ctrl-Z", mark + with_line_ends(text, "\r") + "\x1a"},
        {"UTF-16 with carriage returns and a trailing NUL",
         "\xff\xfe" + widened(with_line_ends(text, "\r") + std::string(1, '\0'), 0, 1)},
    };
}
