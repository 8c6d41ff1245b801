/// A whole file in memory, and helpers that quote its contents in messages.
module aabblab.files:file_text;

import aabb.base;
import :text_decoder;

namespace aabblab {

/// Throws an input_error: "FILE: SENTENCE".
[[noreturn]] inline void reject(const std::filesystem::path& file, const std::string& sentence) {
    throw aabb::input_error(file.string() + ": " + sentence);
}

struct file_text {
    std::string name;  ///< as the user wrote it
    std::string text;

    [[noreturn]] void fail(const std::string& sentence) const { reject(name, sentence); }
};

/// The word in quotes, for a message: at most 40 bytes of it, cut between characters.
[[nodiscard]] inline std::string in_quotes(std::string_view word) {
    std::size_t end = std::min<std::size_t>(word.size(), 40);
    while (end > 0 && end < word.size() && (static_cast<unsigned char>(word[end]) & 0xc0U) == 0x80) --end;
    return "'" + std::string(word.substr(0, end)) + (end < word.size() ? "…'" : "'");
}

/// A count with its noun: "1 vertex", "3 vertices".
/// @param plural if it is not the singular and an s
[[nodiscard]] inline std::string counted(std::size_t count, std::string_view singular, std::string_view plural = {}) {
    const std::string several = plural.empty() ? std::string(singular) + "s" : std::string(plural);
    return std::to_string(count) + " " + (count == 1 ? std::string(singular) : several);
}

/// Formats two sizes in bytes, each in a suitable unit, or in bytes if they would round to the same text.
[[nodiscard]] std::array<std::string, 2> different_sizes(double a, double b);

[[nodiscard]] std::size_t size_of_file(const std::filesystem::path& file);

/// Like `size_of_file`, but also rejects empty files.
[[nodiscard]] inline std::size_t require_file(const std::filesystem::path& file) {
    const std::size_t size = size_of_file(file);
    if (size == 0) reject(file, "is empty");
    return size;
}

struct close_file {
    void operator()(std::FILE* file) const noexcept { std::fclose(file); }
};
using file_handle = std::unique_ptr<std::FILE, close_file>;

[[nodiscard]] std::string system_error_text();

/// A regular file that is read sequentially from its beginning.
class input_file {
public:
    input_file(const std::filesystem::path& file, std::size_t size);
    /// @returns false if fewer bytes are left
    [[nodiscard]] bool try_read(void* to, std::size_t bytes);
    void read(void* to, std::size_t bytes);

private:
    std::filesystem::path name_;
    std::size_t size_;
    std::size_t done_ = 0;
    file_handle file_;
};

/// Reads a whole file.
/// @param size as returned by `require_file`
/// @param memory_factor the maximum memory of the text and everything parsed from it, as a multiple of the file size
[[nodiscard]] file_text read_file(const std::filesystem::path& file, std::size_t size, double memory_factor);

/// Decodes the bytes of a file with `text_decoder`, and rejects what is not text.
[[nodiscard]] inline file_text as_text(file_text file) {
    decoded_text text = decoded(std::move(file.text));
    if (!text.problem.empty()) file.fail(text.problem);
    return {std::move(file.name), std::move(text.text)};
}

/// The line without trailing carriage returns, which precede its line feed.
/// @param fail is called with a message if a carriage return stands elsewhere in the line
[[nodiscard]] inline std::string_view line_without_return(std::string_view line, auto fail) {
    while (line.ends_with('\r')) line.remove_suffix(1);
    if (line.find('\r') != std::string_view::npos)
        fail("some lines end in carriage returns alone, others in line feeds; expected one of the two");
    return line;
}

}  // namespace aabblab
