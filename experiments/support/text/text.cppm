/// Breaks text into lines by the number of characters, not bytes.
export module aabblab.text;

import aabb.std;

namespace aabblab {

[[nodiscard]] bool begins_character(char c) {
    return (static_cast<unsigned char>(c) & 0xc0) != 0x80;
}

}  // namespace aabblab

export namespace aabblab {

[[nodiscard]] std::size_t characters(std::string_view utf8) {
    return static_cast<std::size_t>(std::ranges::count_if(utf8, begins_character));
}

/// Replaces control characters, such as newlines, by blanks.
[[nodiscard]] std::string one_line(std::string_view text) {
    std::string line(text);
    for (char& c : line)
        if (static_cast<unsigned char>(c) < ' ' || c == '\x7f') c = ' ';
    return line;
}

/// Inserts blanks into words longer than `length` characters, preferably after a comma or colon, so that lines can
/// break.
[[nodiscard]] std::string with_breaks(std::string_view text, std::size_t length) {
    std::string result;
    std::size_t word_begin = 0;  // the offset in `result` of the current word
    std::size_t break_at = 0;    // that after the word's last comma or colon, if it is greater than `word_begin`
    for (const char c : text) {
        if (begins_character(c) && c != ' ' && characters(std::string_view(result).substr(word_begin)) == length) {
            if (break_at <= word_begin) break_at = result.size();
            result.insert(break_at, " ");
            word_begin = break_at + 1;
        }
        result += c;
        if (c == ' ') word_begin = result.size();
        if (c == ',' || c == ':') break_at = result.size();
    }
    return result;
}

/// Breaks text at blanks into lines of at most `length` characters; a longer word gets a line of its own.
[[nodiscard]] std::vector<std::string> lines_of(std::string_view text, std::size_t length) {
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
