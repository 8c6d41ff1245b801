/// Converts text from programs on many systems to UTF-8 with line feeds.
module aabblab.files:text_decoder;

import aabb.std;

namespace aabblab {

enum class text_encoding : std::uint8_t { utf8, utf16_little, utf16_big, utf16_unmarked, utf32 };
/// Detects the encoding from the first four bytes, or all bytes if there are fewer.
[[nodiscard]] text_encoding text_encoding_of(std::string_view bytes) noexcept;

/// Decodes a text incrementally. A byte order mark is dropped, UTF-16 with a mark is converted, carriage returns become
/// line feeds if the first line ends in one alone, and trailing padding is dropped: NULs, and Ctrl-Z, which ends text
/// in CP/M and DOS. A carriage return before a line feed stays, as readers skip it. A line end of the other kind
/// becomes or stays a carriage return, which `line_without_return` rejects.
class text_decoder {
public:
    /// Appends the decoded bytes.
    void add(std::string_view bytes, std::string& text);
    /// Appends pending characters; no more bytes follow.
    void finish(std::string& text);
    /// The reason why the bytes are not text, to follow the file's name; else empty. It stops all further output.
    [[nodiscard]] const std::string& problem() const noexcept { return problem_; }

private:
    enum class line_end : std::uint8_t { unknown, feed, carriage_return };

    void begin(bool is_whole);
    void take_utf16(std::string_view bytes, std::string& text);
    void take_character(char32_t character, std::string& text);
    void take(std::string_view utf8, std::string& text);
    void take_byte(char c, std::string& text);
    [[nodiscard]] bool is_unchanged(std::string_view utf8) const noexcept;

    std::optional<text_encoding> encoding_;
    std::string start_;  // bytes before the encoding is known
    std::optional<unsigned char> half_;
    char32_t high_surrogate_ = 0;
    line_end ends_ = line_end::unknown;
    std::size_t returns_ = 0;  // pending until the next byte shows how lines end
    char padding_ = ' ';       // the first padding byte; a blank if there is none
    std::size_t line_ = 1;
    std::string problem_;
};

/// The result of `text_decoder` for a whole text.
struct decoded_text {
    std::string text;
    std::string problem;
};
[[nodiscard]] decoded_text decoded(std::string bytes);

}  // namespace aabblab
