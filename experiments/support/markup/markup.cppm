/// Writes elements of HTML and SVG.
export module aabblab.markup;

import aabb.std;
import aabblab.fmt;

export namespace aabblab {

/// Escapes text for elements and attributes.
[[nodiscard]] std::string markup_text(std::string_view text) {
    std::string safe;
    for (const char c : text) switch (c) {
            case '<': safe += "&lt;"; break;
            case '>': safe += "&gt;"; break;
            case '&': safe += "&amp;"; break;
            case '"': safe += "&quot;"; break;
            default: safe += c;
        }
    return safe;
}

/// A number with at most two decimals, enough for pictures.
[[nodiscard]] std::string short_number(double value) {
    std::string text = fmt::format("{:.2f}", value);
    text.erase(text.find_last_not_of('0') + 1);
    if (text.back() == '.') text.pop_back();
    return text == "-0" ? "0" : text;
}

/// A name and a value; attributes with an empty value are omitted.
struct attribute {
    std::string_view name;
    std::string value;

    attribute(std::string_view of, std::string_view text) : name(of), value(markup_text(text)) {}
    template <class Number>
        requires std::integral<Number> || std::floating_point<Number>
    attribute(std::string_view of, Number number) : name(of), value(short_number(static_cast<double>(number))) {}
};
using attributes = std::vector<attribute>;

/// @param content markup, in which text must be escaped by `markup_text`
[[nodiscard]] std::string element(std::string_view tag, const attributes& list,
                                  std::optional<std::string_view> content = {}) {
    std::string text = "<" + std::string(tag);
    for (const attribute& a : list)
        if (!a.value.empty()) text += fmt::format(" {}=\"{}\"", a.name, a.value);
    return text + (content ? fmt::format(">{}</{}>", *content, tag) : "/>");
}

}  // namespace aabblab
