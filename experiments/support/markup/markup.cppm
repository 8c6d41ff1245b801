/// HTML, element by element, and what `aabblab.svg` draws with.
export module aabblab.markup;

import aabb.std;

export namespace aabblab {

/// Text as it stands between tags and in attributes.
[[nodiscard]] std::string markup_text(std::string_view text);

/// With at most two decimals: a picture shows no more.
[[nodiscard]] std::string short_number(double value);

/// A name and a value; one whose value is empty is left out.
struct attribute {
    std::string_view name;
    std::string value;

    attribute(std::string_view of, std::string_view text) : name(of), value(markup_text(text)) {}
    template <class Number>
        requires std::integral<Number> || std::floating_point<Number>
    attribute(std::string_view of, Number number) : name(of), value(short_number(static_cast<double>(number))) {}
};
using attributes = std::vector<attribute>;

/// @param content markup, in which text is `markup_text`
[[nodiscard]] std::string element(std::string_view tag, const attributes& all,
                                  std::optional<std::string_view> content = {});

}  // namespace aabblab
