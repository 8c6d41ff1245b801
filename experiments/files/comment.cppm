export module aabblab.files:comment;

import aabb.std;

export namespace aabblab {

/// Strips a comment, which `mark` begins unless it follows a full stop: some programs write infinity and NaN as
/// "1.#INF" and "1.#QNAN", which must be rejected, not cut to a number.
[[nodiscard]] constexpr std::string_view without_comment(std::string_view line, char mark = '#') noexcept {
    std::size_t at = line.find(mark);
    while (at != std::string_view::npos && at > 0 && line[at - 1] == '.') at = line.find(mark, at + 1);
    return line.substr(0, at);
}

}  // namespace aabblab
