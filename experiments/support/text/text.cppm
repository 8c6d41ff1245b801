/// Breaks text into lines by the number of characters, not bytes.
export module aabblab.text;

import aabb.std;

export namespace aabblab {

[[nodiscard]] std::size_t characters(std::string_view utf8);

/// Replaces control characters, such as newlines, by blanks.
[[nodiscard]] std::string one_line(std::string_view text);

/// Inserts blanks into words longer than `length` characters, preferably after a comma or colon.
[[nodiscard]] std::string with_breaks(std::string_view text, std::size_t length);

/// Breaks text at blanks into lines of at most `length` characters; a longer word gets a line of its own.
[[nodiscard]] std::vector<std::string> lines_of(std::string_view text, std::size_t length);

}  // namespace aabblab
