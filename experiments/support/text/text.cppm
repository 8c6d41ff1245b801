/// Text in lines of so many characters, which are counted, not bytes.
export module aabblab.text;

import aabb.std;

export namespace aabblab {

[[nodiscard]] std::size_t characters(std::string_view utf8);

/// Newlines and the like become blanks.
[[nodiscard]] std::string one_line(std::string_view text);

/// With a blank wherever a word would not fit on a line of so many characters, behind a comma or colon if there is one.
[[nodiscard]] std::string with_breaks(std::string_view text, std::size_t length);

/// Broken at blanks into lines of at most so many characters; a longer word has a longer line.
[[nodiscard]] std::vector<std::string> lines_of(std::string_view text, std::size_t length);

}  // namespace aabblab
