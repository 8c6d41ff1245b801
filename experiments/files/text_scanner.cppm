/// Splits a text file into lines and words, parses numbers, and reports errors with file and line.
module aabblab.files:text_scanner;

import aabb.geometry;
import :comment;
import :file_text;

namespace aabblab {

template <class Number>
struct read_number {
    /// Parses the whole text by std::from_chars. That takes no plus sign, so one before a floating-point number is
    /// skipped.
    explicit read_number(std::string_view text) {
        const bool has_plus = std::floating_point<Number> && text.starts_with('+') && !text.starts_with("+-");
        const char* const end = text.data() + text.size();
        const auto [stopped, error] = std::from_chars(text.data() + has_plus, end, value);
        is_number = stopped == end && error != std::errc::invalid_argument;
        out_of_range = error == std::errc::result_out_of_range;
        // from_chars gives no value for underflow and overflow; strtod gives zero (or a subnormal) and infinity.
        if constexpr (std::same_as<Number, double>)
            if (out_of_range) value = std::strtod(std::string(text).c_str(), nullptr);
    }

    Number value = 0;
    bool is_number = false;  ///< whether the whole text is one number
    bool out_of_range = false;
};

inline constexpr char no_comments = '\0';

class text_scanner {
public:
    /// @param comment the character that begins a comment up to the end of the line, or `no_comments`
    text_scanner(const file_text& file, char comment) : file_(file.name), rest_(file.text), comment_(comment) {}

    /// Advances to the next line that has a word; false at the end of the file.
    bool next_line() {
        while (!rest_.empty()) {
            const std::size_t end = rest_.find('\n');
            line_ = rest_.substr(0, end);
            rest_.remove_prefix(end == std::string_view::npos ? rest_.size() : end + 1);
            ++number_;
            line_ = line_without_return(line_, [this](const std::string& sentence) { fail(sentence); });
            if (comment_ != no_comments) line_ = without_comment(line_, comment_);
            skip_blanks();
            if (!line_.empty()) return true;
        }
        return false;
    }

    /// The next word of the line; empty at its end.
    std::string_view word() {
        skip_blanks();
        std::size_t length = 0;
        while (length < line_.size() && !is_blank(line_[length])) ++length;
        const std::string_view next_word = line_.substr(0, length);
        line_.remove_prefix(length);
        return next_word;
    }

    [[nodiscard]] bool has_word() {
        skip_blanks();
        return !line_.empty();
    }

    /// Moves the cursor of the line back to a word.
    void back_to(std::string_view word) { line_ = std::string_view(word.begin(), line_.end()); }

    [[nodiscard]] std::size_t line() const noexcept { return number_; }

    /// @throws aabb::input_error with the file, the line and the sentence.
    [[noreturn]] void fail(const std::string& sentence) const {
        reject(file_ + ":" + std::to_string(number_), sentence);
    }
    [[noreturn]] void fail_expected(const std::string& noun, std::string_view actual) const {
        fail("expected " + noun + ", found " + (actual.empty() ? "the end of the line" : in_quotes(actual)));
    }
    [[noreturn]] void fail_at_end(const std::string& where) const { reject(file_, "ends " + where); }

    /// Parses an integer in the range of its type.
    template <std::integral Integer>
    [[nodiscard]] Integer integer(const std::string& noun) {
        const std::string_view text = word();
        const read_number<Integer> number(text);
        if (!number.is_number || number.out_of_range) fail_expected(noun, text);
        return number.value;
    }

    /// Parses a finite number, correctly rounded to double.
    [[nodiscard]] double number(const std::string& noun) {
        const std::string_view text = word();
        const read_number<double> number(text);
        if (!number.is_number) fail_expected(noun, text);
        if (!std::isfinite(number.value)) fail(in_quotes(text) + " is not a finite number");
        return number.value;
    }

    /// Parses a coordinate, correctly rounded to double. It is NaN or infinite only if the text is.
    [[nodiscard]] double coordinate(std::string_view text) {
        const read_number<double> number(text);
        if (!number.is_number) fail_expected("three coordinates", text);
        if (number.out_of_range && std::isinf(number.value))
            fail("the coordinate " + in_quotes(text) + " is too large for a double");
        return number.value;
    }

private:
    [[nodiscard]] static bool is_blank(char c) noexcept { return c == ' ' || c == '\t' || c == '\v' || c == '\f'; }
    void skip_blanks() {
        std::size_t blanks = 0;
        while (blanks < line_.size() && is_blank(line_[blanks])) ++blanks;
        line_.remove_prefix(blanks);
    }

    std::string file_;
    std::string_view rest_;
    std::string_view line_;
    std::size_t number_ = 0;
    char comment_;
};

}  // namespace aabblab
