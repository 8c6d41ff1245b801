export module aabblab.files:comment;

import aabb.std;

export namespace aabblab {

/// Strips a comment, which `mark` begins unless it follows a full stop: some programs write infinity and NaN as
/// "1.#INF" and "1.#QNAN", which must be rejected, not cut to a number.
[[nodiscard]] constexpr std::string_view without_comment(std::string_view line, char mark = '#') noexcept {
    std::size_t begin = line.find(mark);
    while (begin != std::string_view::npos && begin > 0 && line[begin - 1] == '.') begin = line.find(mark, begin + 1);
    return line.substr(0, begin);
}

}  // namespace aabblab
