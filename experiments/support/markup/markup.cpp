module aabblab.markup;

import aabblab.fmt;

namespace aabblab {

/// Replaces the characters that HTML and SVG reserve.
std::string markup_text(std::string_view text) {
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

std::string short_number(double value) {
    std::string text = fmt::format("{:.2f}", value);
    text.erase(text.find_last_not_of('0') + 1);
    if (text.back() == '.') text.pop_back();
    return text == "-0" ? "0" : text;
}

std::string element(std::string_view tag, const attributes& list, std::optional<std::string_view> content) {
    std::string text = "<" + std::string(tag);
    for (const attribute& a : list)
        if (!a.value.empty()) text += fmt::format(" {}=\"{}\"", a.name, a.value);
    return text + (content ? fmt::format(">{}</{}>", *content, tag) : "/>");
}

}  // namespace aabblab
