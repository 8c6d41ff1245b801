export module aabb.base:shortest;

import aabb.std;

export namespace aabb {

/// The shortest decimals that read back to the same number.
template <std::floating_point Real>
[[nodiscard]] std::string shortest(Real number) {
    std::array<char, 32> text{};
    return {text.data(), std::to_chars(text.data(), text.data() + text.size(), number).ptr};
}

}  // namespace aabb
