/// Text as programs of many systems write it, made UTF-8 with line feeds at the ends of lines.
module aabblab.files:text_decoder;

import aabb.std;

namespace aabblab {

enum class text_encoding : std::uint8_t { utf8, utf16_little, utf16_big, utf16_unmarked, utf32 };
/// By the first bytes, four of them or all there are.
[[nodiscard]] text_encoding text_encoding_of(std::string_view bytes) noexcept;

/// Takes a text piece by piece. A byte order mark is dropped, UTF-16 that begins with one is converted, carriage
/// returns become line feeds where the first line ends in one alone, and what pads the end of a file is dropped: NULs,
/// and Ctrl-Z, which CP/M and DOS end text with. A carriage return before a line feed stays, as readers skip it; alone
/// in a text of line feeds it stays too, as does the reverse, as a carriage return: `line_without_return` refuses both.
class text_decoder {
public:
    /// Appends what the bytes say.
    void add(std::string_view bytes, std::string& text);
    /// Appends what waited for more bytes: these were the last.
    void finish(std::string& text);
    /// Why this is no such text, to be said after its name; empty while it is. Nothing is appended any more then.
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
    std::string start_;  // bytes that the encoding is not known from yet
    std::optional<unsigned char> half_;
    char32_t high_surrogate_ = 0;
    line_end ends_ = line_end::unknown;
    std::size_t returns_ = 0;  // that wait for the next byte, which tells how lines end
    char padding_ = ' ';       // its first byte; a blank where there is none
    std::size_t line_ = 1;
    std::string problem_;
};

/// A text and why it is none, see `text_decoder`.
struct decoded_text {
    std::string text;
    std::string problem;
};
[[nodiscard]] decoded_text decoded(std::string bytes);

}  // namespace aabblab
