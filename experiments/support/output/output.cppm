/// Output on the standard streams.
export module aabblab.output;

import aabb.std;

export namespace aabblab {

/// The reader of standard output has closed it, as `head` does: the program ends, but without an error.
class output_closed : public std::runtime_error {
public:
    output_closed() : runtime_error("standard output was closed") {}
};

/// Escapes control characters, including line breaks, and invalid UTF-8, such as \x1b, for terminals.
[[nodiscard]] std::string visible(std::string_view text);

/// Writes lines to standard output, which is buffered; other control characters are escaped.
/// @throws output_closed, or aabb::input_error if writing fails, as on a full disk.
void print(std::string_view text);

/// Flushes the buffer; throws like `print`.
void flush_output();

/// The width of standard output in characters: of the terminal, otherwise COLUMNS in the environment, otherwise 80.
[[nodiscard]] std::size_t output_width();

/// The width of paragraphs: that of the output, at most 80.
[[nodiscard]] std::size_t paragraph_width();

/// Breaks the text into lines of at most `most` characters, unless a word is longer.
[[nodiscard]] std::string wrapped(std::string_view text, std::size_t most = paragraph_width());

void print_paragraph(std::string_view text);

/// Breaks the text after a prefix on its first line; further lines are indented by the width of the prefix.
[[nodiscard]] std::string hanging(std::string_view before, std::string_view text, std::size_t most = output_width());

/// An entry of a list: a name, then its description in a second column, or on the next line if the name is too long.
[[nodiscard]] std::string entry(std::string_view name, std::string_view text);

/// Continues the work of commands that do more than print, without output, if the reader closes standard output.
void outlive_reader();

/// Prints a note for the user on standard error: escaped, in one line, or wrapped if it is a terminal.
void note(std::string_view text);

}  // namespace aabblab
