/// Converts text from programs on many systems to UTF-8 with line feeds.
module aabblab.files:text_decoder;

import aabb.std;

namespace aabblab {

enum class text_encoding : std::uint8_t { utf8, utf16_little, utf16_big, utf16_unmarked, utf32 };
[[nodiscard]] text_encoding text_encoding_of(std::string_view bytes) noexcept;

/// Decodes a text incrementally. A byte order mark is dropped, UTF-16 with a mark is converted, carriage returns become
/// line feeds if the first line ends in one alone, and trailing padding is dropped: NULs, and Ctrl-Z, which ends text
/// in CP/M and DOS. A carriage return before a line feed stays. A line end of the other kind becomes or stays one.
class text_decoder {
public:
    void add(std::string_view bytes, std::string& text);
    void finish(std::string& text);
    /// The reason why the bytes are not text, to follow the file's name; else empty. It stops all further output.
    [[nodiscard]] const std::string& problem() const noexcept { return problem_; }

private:
    enum class line_end : std::uint8_t { unknown, feed, carriage_return };

    void detect_encoding(bool is_at_end);
    void append_utf16(std::string_view bytes, std::string& text);
    void append_character(char32_t character, std::string& text);
    void append_with_line_feeds(std::string_view utf8, std::string& text);
    void append_byte(char c, std::string& text);
    [[nodiscard]] bool is_unchanged(std::string_view utf8) const noexcept;

    std::optional<text_encoding> encoding_;
    std::string undetected_;                   // bytes before the encoding is known
    std::optional<unsigned char> first_byte_;  // of an incomplete UTF-16 unit
    char32_t high_surrogate_ = 0;              // of an incomplete pair; 0 if there is none
    line_end line_end_ = line_end::unknown;
    std::size_t pending_returns_ = 0;  // until the next byte shows how lines end
    char padding_ = ' ';               // the first padding byte; a blank if there is none
    std::size_t line_ = 1;
    std::string problem_;
};

struct decoded_text {
    std::string text;
    std::string problem;
};
[[nodiscard]] decoded_text decoded(std::string bytes);

}  // namespace aabblab
