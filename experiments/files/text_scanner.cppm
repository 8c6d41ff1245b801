/// Words of a text file, line by line; numbers in them; errors with the file and the line.
module aabblab.files:text_scanner;

import aabb.geometry;
import :comment;
import :file_text;

namespace aabblab {

template <class Number>
struct read_number {
    explicit read_number(std::string_view text) {
        // from_chars takes no plus sign.
        const bool has_plus = std::floating_point<Number> && text.starts_with('+') && !text.starts_with("+-");
        const char* const end = text.data() + text.size();
        const auto [stopped, error] = std::from_chars(text.data() + has_plus, end, value);
        is_one = stopped == end && error != std::errc::invalid_argument;
        out_of_range = error == std::errc::result_out_of_range;
        // Too small is a rounded zero, too large infinite; only this tells which it was.
        if constexpr (std::floating_point<Number>)
            if (out_of_range) value = from_text(text);
    }

    Number value = 0;
    bool is_one = false;  ///< and nothing else
    bool out_of_range = false;

private:
    [[nodiscard]] static Number from_text(std::string_view text) {
        if constexpr (std::same_as<Number, float>)
            return std::strtof(std::string(text).c_str(), nullptr);
        else
            return std::strtod(std::string(text).c_str(), nullptr);
    }
};

class text_scanner {
public:
    /// @param comment what begins a comment that runs to the end of the line; '\0' for none.
    text_scanner(const file_text& file, char comment) : file_(file.name), rest_(file.text), comment_(comment) {}

    /// Goes to the next line that holds a word; false at the end of the file.
    bool next_line() {
        while (!rest_.empty()) {
            const std::size_t end = rest_.find('\n');
            line_ = rest_.substr(0, end);
            rest_.remove_prefix(end == std::string_view::npos ? rest_.size() : end + 1);
            ++number_;
            line_ = line_without_return(line_, [this](const std::string& sentence) { fail(sentence); });
            if (comment_ != '\0') line_ = without_comment(line_, comment_);
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
        const std::string_view found = line_.substr(0, length);
        line_.remove_prefix(length);
        return found;
    }

    /// Whether words are left on the line.
    [[nodiscard]] bool more() {
        skip_blanks();
        return !line_.empty();
    }

    /// Begins to read the line at a part of it.
    void back_to(std::string_view word) { line_ = std::string_view(word.begin(), line_.end()); }

    [[nodiscard]] std::size_t line() const noexcept { return number_; }

    /// @throws aabb::input_error with the file, the line and the sentence.
    [[noreturn]] void fail(const std::string& sentence) const {
        refuse(file_ + ":" + std::to_string(number_), sentence);
    }
    [[noreturn]] void expected(const std::string& what, std::string_view found) const {
        fail("expected " + what + ", found " + (found.empty() ? "the end of the line" : in_quotes(found)));
    }
    /// For a file that ends too early.
    [[noreturn]] void ends(const std::string& where) const { refuse(file_, "ends " + where); }

    /// A whole number that fits.
    template <std::integral Whole>
    [[nodiscard]] Whole whole(const std::string& what) {
        const std::string_view text = word();
        const read_number<Whole> number(text);
        if (!number.is_one || number.out_of_range) expected(what, text);
        return number.value;
    }

    /// A finite number, correctly rounded to double.
    [[nodiscard]] double number(const std::string& what) {
        const std::string_view text = word();
        const read_number<double> number(text);
        if (!number.is_one) expected(what, text);
        if (!std::isfinite(number.value)) fail(in_quotes(text) + " is not a finite number");
        return number.value;
    }

    /// Three coordinates, as `coordinate`.
    [[nodiscard]] aabb::vec3f point() {
        aabb::vec3f p{};
        for (int k = 0; k < 3; ++k) p[k] = coordinate(word());
        return p;
    }

    /// One coordinate, correctly rounded to float; NaN or infinite only where the text says so.
    [[nodiscard]] float coordinate(std::string_view text) {
        const read_number<float> number(text);
        if (!number.is_one) expected("three coordinates", text);
        if (number.out_of_range && std::isinf(number.value))
            fail("the coordinate " + in_quotes(text) + " is too large for a float");
        if (std::isfinite(number.value))
            rounded_ += number.out_of_range || read_number<double>(text).value != double{number.value};
        return number.value;
    }

    /// Coordinates so far whose text, read as a double, differs from the float.
    [[nodiscard]] std::size_t rounded() const noexcept { return rounded_; }

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
    std::size_t rounded_ = 0;
    char comment_;
};

}  // namespace aabblab
