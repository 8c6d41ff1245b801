module;
#include <algorithm>
#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

/// Text on its way into a gnuplot script.
module aabblab.figures:text;

namespace aabblab {

/// Newlines and the like become blanks.
[[nodiscard]] inline std::string one_line(std::string_view text) {
    std::string line(text);
    for (char& c : line)
        if (static_cast<unsigned char>(c) < ' ' || c == '\x7f') c = ' ';
    return line;
}

/// In single quotes, within which gnuplot leaves backslashes and `commands` alone. It also has a way to write a quote
/// there, which fails for two of them and at the beginning; so each is a string of its own.
[[nodiscard]] inline std::string in_double_quotes(std::string_view text) {
    std::string in_quotes = "'";
    for (const char c : one_line(text)) in_quotes += c == '\'' ? "' . \"'\" . '" : std::string(1, c);
    return in_quotes + "'";
}

/// Several lines of text in one string.
[[nodiscard]] inline std::string in_double_quotes(const std::vector<std::string>& lines) {
    std::string together;
    for (const std::string& line : lines)
        together += (together.empty() ? "" : " . \"\\n\" . ") + in_double_quotes(line);
    return lines.empty() ? "''" : together;
}

/// The label of a tick is a format to gnuplot, in which the number would follow a percent sign. It has room for so few
/// bytes of such labels that it cuts characters in two.
[[nodiscard]] inline std::string without_format(std::string_view text) {
    constexpr std::size_t room = 48;
    if (text.find('%') != std::string_view::npos && text.size() > room) {
        std::size_t end = room - 3;
        while ((static_cast<unsigned char>(text[end]) & 0xc0) == 0x80) --end;
        return without_format(text.substr(0, end)) + "\u2026";
    }
    std::string doubled;
    for (const char c : text) doubled += c == '%' ? "%%" : std::string(1, c);
    return doubled;
}

[[nodiscard]] inline std::size_t characters(std::string_view utf8) {
    return static_cast<std::size_t>(
        std::ranges::count_if(utf8, [](char c) { return (static_cast<unsigned char>(c) & 0xc0) != 0x80; }));
}

/// With a blank wherever a word would not fit on a line of so many characters, behind a comma or colon if there is one.
[[nodiscard]] inline std::string with_breaks(std::string_view text, std::size_t length) {
    std::string broken;
    std::size_t word = 0;      // where it begins in `broken`
    std::size_t break_at = 0;  // where it can be broken
    for (const char c : text) {
        const bool begins = (static_cast<unsigned char>(c) & 0xc0) != 0x80;
        if (begins && c != ' ' && characters(std::string_view(broken).substr(word)) == length) {
            if (break_at <= word) break_at = broken.size();
            broken.insert(break_at, " ");
            word = break_at + 1;
        }
        broken += c;
        if (c == ' ') word = broken.size();
        if (c == ',' || c == ':') break_at = broken.size();
    }
    return broken;
}

/// Broken at blanks into lines of at most so many characters; a longer word has a longer line.
[[nodiscard]] inline std::vector<std::string> lines_of(std::string_view text, std::size_t length) {
    std::vector<std::string> lines;
    const std::string words = one_line(text);
    for (std::size_t begin = 0; begin < words.size();) {
        const std::size_t end = std::min(words.find(' ', begin), words.size());
        const std::string word = words.substr(begin, end - begin);
        if (!lines.empty() && characters(lines.back()) + 1 + characters(word) <= length)
            lines.back() += " " + word;
        else if (!word.empty())
            lines.push_back(word);
        begin = end + 1;
    }
    return lines;
}

}  // namespace aabblab
