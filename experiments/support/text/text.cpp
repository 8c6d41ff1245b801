module aabblab.text;

namespace aabblab {

namespace {

[[nodiscard]] bool begins_character(char c) {
    return (static_cast<unsigned char>(c) & 0xc0) != 0x80;
}

}  // namespace

std::size_t characters(std::string_view utf8) {
    return static_cast<std::size_t>(std::ranges::count_if(utf8, begins_character));
}

std::string one_line(std::string_view text) {
    std::string line(text);
    for (char& c : line)
        if (static_cast<unsigned char>(c) < ' ' || c == '\x7f') c = ' ';
    return line;
}

/// Inserts blanks into words longer than `length`, after a comma or colon if there is one, so that lines can break.
std::string with_breaks(std::string_view text, std::size_t length) {
    std::string result;
    std::size_t word_begin = 0, break_at = 0;  // in `result`: of the word, and its last possible break if greater
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

/// Fills lines with words; a word longer than a line gets its own.
std::vector<std::string> lines_of(std::string_view text, std::size_t length) {
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
