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

std::string with_breaks(std::string_view text, std::size_t length) {
    std::string broken;
    std::size_t word = 0;      // where it begins in `broken`
    std::size_t break_at = 0;  // where it can be broken
    for (const char c : text) {
        if (begins_character(c) && c != ' ' && characters(std::string_view(broken).substr(word)) == length) {
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
