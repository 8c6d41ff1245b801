export module aabb.base:statement;

import aabb.std;

export namespace aabb {

/// The shortest decimals that read back to the same number.
template <std::floating_point Real>
[[nodiscard]] std::string shortest(Real number) {
    std::array<char, 32> text{};
    return {text.data(), std::to_chars(text.data(), text.data() + text.size(), number).ptr};
}

/// A sentence about numbers, which stand in it as their names in braces: "a list of {pairs} pairs". Programs read the
/// numbers, `to_text` makes the sentence.
struct statement {
    struct number {
        std::string_view name;
        double value = 0;

        bool operator==(const number&) const = default;
    };

    std::string_view text;  ///< that outlives it
    std::array<number, 4> numbers{};

    /// 0 where there is no such number.
    [[nodiscard]] constexpr double operator[](std::string_view name) const {
        for (const number& one : numbers)
            if (one.name == name) return one.value;
        return 0;
    }
    bool operator==(const statement&) const = default;
};

[[nodiscard]] inline std::string to_text(const statement& told) {
    // Counts in full, all else to the digits of a float.
    constexpr double greatest_count = 0x1p63;
    std::string text(told.text);
    for (const statement::number& one : told.numbers) {
        const std::size_t at = one.name.empty() ? std::string::npos : text.find("{" + std::string(one.name) + "}");
        if (at == std::string::npos) continue;
        const bool is_count = one.value >= 0 && one.value < greatest_count && one.value == std::floor(one.value);
        text.replace(
            at, one.name.size() + 2,
            is_count ? std::to_string(static_cast<std::uint64_t>(one.value)) : shortest(static_cast<float>(one.value)));
    }
    return text;
}

}  // namespace aabb
