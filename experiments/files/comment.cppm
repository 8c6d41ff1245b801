export module aabblab.files:comment;

import aabb.std;

export namespace aabblab {

/// The line up to the comment that `mark` begins. Behind a full stop it begins none: "1.#INF" and "1.#QNAN" are what
/// some programs write for infinity and NaN, and no numbers here.
[[nodiscard]] constexpr std::string_view without_comment(std::string_view line, char mark = '#') noexcept {
    std::size_t at = line.find(mark);
    while (at != std::string_view::npos && at > 0 && line[at - 1] == '.') at = line.find(mark, at + 1);
    return line.substr(0, at);
}

}  // namespace aabblab
