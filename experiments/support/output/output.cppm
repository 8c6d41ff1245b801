/// What the program says on its standard streams.
export module aabblab.output;

import aabb.std;

export namespace aabblab {

/// Whoever read our standard output has gone, as `head` does: the end of the program, but no error.
class output_closed : public std::runtime_error {
public:
    output_closed() : runtime_error("standard output was closed") {}
};

/// The text with every byte that a terminal would obey, or that is no UTF-8, written as \x1b is; one line.
[[nodiscard]] std::string visible(std::string_view text);

/// Writes to standard output, which is buffered: lines, made visible.
/// @throws output_closed, or aabb::input_error when it cannot be written (a full disk).
void print(std::string_view text);

/// Writes out what the buffer still holds; throws as `print` does.
void flush_output();

/// Characters of a line on standard output: of the terminal, else COLUMNS in the environment, else 80.
[[nodiscard]] std::size_t output_width();

/// Of paragraphs: as wide as the output, at most 80.
[[nodiscard]] std::size_t paragraph_width();

/// The text in lines of at most so many characters, as far as no word is longer.
[[nodiscard]] std::string wrapped(std::string_view text, std::size_t most = paragraph_width());

void print_paragraph(std::string_view text);

/// The same behind what stands before its first line; further lines are indented as far.
[[nodiscard]] std::string hanging(std::string_view before, std::string_view text, std::size_t most = output_width());

/// A line of a list, with its end: a name, and in a second column what is said of it, below a name that is too long.
[[nodiscard]] std::string entry(std::string_view name, std::string_view text);

/// For commands whose work is not what they print: once the reader of standard output has gone, only the work goes on.
void outlive_reader();

/// A note for the user, on standard error: one line, made visible; on a terminal, lines that fit it.
void note(std::string_view text);

}  // namespace aabblab
