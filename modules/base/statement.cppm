export module aabb.base:statement;

import aabb.std;

export namespace aabb {

/// The shortest decimal representation that parses to the same number.
template <std::floating_point Real>
[[nodiscard]] std::string shortest(Real number) {
    std::array<char, 32> text{};
    return {text.data(), std::to_chars(text.data(), text.data() + text.size(), number).ptr};
}

/// A sentence with numbers, which are referred to by their names in braces: "a list of {pairs} pairs". Programs read
/// the numbers; `to_text` formats the sentence.
struct statement {
    struct number {
        std::string_view name;
        double value = 0;

        bool operator==(const number&) const = default;
    };

    std::string_view text;  ///< must outlive the statement
    std::array<number, 4> numbers{};

    /// The number of this name; 0 if there is none.
    [[nodiscard]] constexpr double operator[](std::string_view name) const {
        for (const number& n : numbers)
            if (n.name == name) return n.value;
        return 0;
    }
    bool operator==(const statement&) const = default;
};

/// The sentence with its numbers in place of their names in braces: whole ones in full, others as floats.
[[nodiscard]] inline std::string to_text(const statement& s) {
    constexpr double greatest_count = 0x1p63;  // so that the conversion to u64 is defined
    std::string text(s.text);
    for (const auto& [name, value] : s.numbers) {
        const std::size_t at = name.empty() ? std::string::npos : text.find("{" + std::string(name) + "}");
        if (at == std::string::npos) continue;
        const bool is_count = value >= 0 && value < greatest_count && value == std::floor(value);
        text.replace(
            at, name.size() + 2,
            is_count ? std::to_string(static_cast<std::uint64_t>(value)) : shortest(static_cast<float>(value)));
    }
    return text;
}

}  // namespace aabb
