/// A whole file in memory, and how its words are quoted to the user.
module aabblab.files:file_text;

import aabb.base;
import :text_decoder;

namespace aabblab {

/// "FILE: SENTENCE"
[[noreturn]] inline void refuse(const std::filesystem::path& file, const std::string& sentence) {
    throw aabb::input_error(file.string() + ": " + sentence);
}

struct file_text {
    std::string name;  ///< as the user gave it
    std::string text;

    [[noreturn]] void fail(const std::string& sentence) const { refuse(name, sentence); }
};

/// The word in quotes, for a sentence: at most 40 bytes of it, and no part of a character.
[[nodiscard]] inline std::string in_quotes(std::string_view word) {
    std::size_t end = std::min<std::size_t>(word.size(), 40);
    while (end > 0 && end < word.size() && (static_cast<unsigned char>(word[end]) & 0xc0U) == 0x80) --end;
    return "'" + std::string(word.substr(0, end)) + (end < word.size() ? "…'" : "'");
}

/// "1 vertex", "3 vertices"
/// @param many where it is not `one` and an s
[[nodiscard]] inline std::string counted(std::size_t count, std::string_view one, std::string_view many = {}) {
    const std::string several = many.empty() ? std::string(one) + "s" : std::string(many);
    return std::to_string(count) + " " + (count == 1 ? std::string(one) : several);
}

/// Two sizes in bytes for a sentence, each in a unit that fits it; in bytes where they would look alike.
[[nodiscard]] std::array<std::string, 2> different_sizes(double a, double b);

/// Refuses what is not a regular file.
/// @return its size in bytes.
/// @throws aabb::input_error that says what it is instead.
[[nodiscard]] std::size_t size_of_file(const std::filesystem::path& file);

/// Refuses what is not a file with something in it, as `size_of_file`.
[[nodiscard]] inline std::size_t require_file(const std::filesystem::path& file) {
    const std::size_t size = size_of_file(file);
    if (size == 0) refuse(file, "is empty");
    return size;
}

struct close_file {
    void operator()(std::FILE* file) const noexcept { std::fclose(file); }
};
using file_handle = std::unique_ptr<std::FILE, close_file>;

[[nodiscard]] std::string system_error_text();

/// A regular file that is read from its begin on, as often as is asked for.
class whole_file {
public:
    /// @param size what `require_file` says
    /// @throws aabb::input_error when it cannot be opened.
    whole_file(const std::filesystem::path& file, std::size_t size);
    /// False when there is not so much.
    [[nodiscard]] bool has_read(void* to, std::size_t bytes);
    /// @throws aabb::input_error when there is not so much.
    void read(void* to, std::size_t bytes);

private:
    std::filesystem::path name_;
    std::size_t size_;
    std::size_t done_ = 0;
    file_handle file_;
};

/// All of a file.
/// @param size what `require_file` says
/// @param times how many times as much memory as the text what is read from it takes at most, the text included
/// @throws aabb::input_error when it cannot be read or does not fit into memory.
[[nodiscard]] file_text read_whole(const std::filesystem::path& file, std::size_t size, double times);

/// The text that the bytes of a file are, see `text_decoder`.
/// @throws aabb::input_error where they are none.
[[nodiscard]] inline file_text as_text(file_text file) {
    decoded_text text = decoded(std::move(file.text));
    if (!text.problem.empty()) file.fail(text.problem);
    return {std::move(file.name), std::move(text.text)};
}

/// The line without what a carriage return before its line feed leaves at its end.
/// @param fail is called with a sentence where one stands alone
[[nodiscard]] inline std::string_view line_without_return(std::string_view line, auto fail) {
    while (line.ends_with('\r')) line.remove_suffix(1);
    if (line.find('\r') != std::string_view::npos)
        fail("some lines end in carriage returns alone, others in line feeds; expected one of the two");
    return line;
}

}  // namespace aabblab
