module aabblab.figures;

import aabblab.fmt;
import aabblab.markup;
import :sheet;

namespace aabblab {

namespace {

constexpr double em = 9;  // in points

/// Widths of Helvetica's characters from the space on, in thousandths of an em (Adobe's font metrics).
constexpr std::array<int, 95> widths = {278,  278, 355, 556, 556, 889, 667, 191, 333, 333, 389, 584, 278, 333, 278, 278,
                                        556,  556, 556, 556, 556, 556, 556, 556, 556, 556, 278, 278, 584, 584, 584, 556,
                                        1015, 667, 667, 722, 722, 667, 611, 778, 722, 278, 500, 667, 556, 833, 722, 778,
                                        667,  778, 722, 667, 611, 722, 667, 944, 667, 667, 611, 278, 278, 278, 469, 556,
                                        333,  556, 556, 500, 556, 556, 278, 556, 556, 222, 222, 500, 222, 833, 556, 556,
                                        556,  556, 333, 500, 278, 556, 500, 722, 500, 500, 500, 334, 260, 334, 584};
constexpr int usual_width = 556;  // of letters with accents
constexpr int sign_width = 584;   // of mathematical signs

/// Characters outside Latin-1, and their codes: as in Windows-1252, or control codes for signs that it lacks.
constexpr std::array<char32_t, 12> beyond_latin = {U'\u2212', U'\u2264', U'\u2265', U'\u20ac', U'\u2026', U'\u2018',
                                                   U'\u2019', U'\u201c', U'\u201d', U'\u2022', U'\u2013', U'\u2014'};
constexpr std::string_view codes = "\x01\x02\x03\x80\x85\x91\x92\x93\x94\x95\x96\x97";
constexpr std::string_view encoding =
    "<</Type/Encoding/BaseEncoding/WinAnsiEncoding/Differences[1/minus/lessequal/greaterequal]>>";

/// The code of a character; a question mark if the font lacks it.
char code_of(char32_t character) {
    if ((character >= ' ' && character < 0x7f) || (character >= 0xa0 && character <= 0xff))
        return static_cast<char>(character);
    const auto known = std::ranges::find(beyond_latin, character);
    return known == beyond_latin.end() ? '?' : codes[static_cast<std::size_t>(known - beyond_latin.begin())];
}

/// Converts UTF-8 to the codes of the font's characters, one byte each, since PDF's standard fonts know no Unicode. The
/// first byte of a character says by its leading ones how many bits it has; each further byte, 10xxxxxx, has six.
std::string encoded(std::string_view utf8) {
    std::string text;
    for (std::size_t i = 0; i < utf8.size();) {
        const auto first = static_cast<unsigned char>(utf8[i++]);
        char32_t character = first < 0x80   ? first
                             : first < 0xe0 ? first & 0x1fU
                             : first < 0xf0 ? first & 0x0fU
                                            : first & 0x07U;
        for (; i < utf8.size() && (static_cast<unsigned char>(utf8[i]) & 0xc0U) == 0x80; ++i)
            character = character << 6U | (static_cast<unsigned char>(utf8[i]) & 0x3fU);
        text += code_of(character);
    }
    return text;
}

/// The width in Helvetica, in ems, for centred texts. Control codes stand for mathematical signs, others for accents.
double width_of(std::string_view encoded_text) {
    double width = 0;
    for (const char c : encoded_text)
        width += c >= ' ' && c < 0x7f ? widths[static_cast<std::size_t>(c - ' ')]
                 : c > 0 && c < ' '   ? sign_width
                                      : usual_width;
    return width / 1000;
}

/// A string literal of PDF, in which brackets and backslashes are escaped.
std::string in_brackets(std::string_view encoded_text) {
    std::string text = "(";
    for (const char c : encoded_text) {
        if (c == '(' || c == ')' || c == '\\') text += '\\';
        text += c;
    }
    return text + ")";
}

/// "#0072B2" as the operands of a PDF colour operator: "0.000 0.447 0.698 ".
std::string operands_of(std::string_view hexadecimal) {
    std::string text;
    for (std::size_t i = 1; i < hexadecimal.size(); i += 2)
        text += fmt::format("{:.3f} ", std::stoi(std::string(hexadecimal.substr(i, 2)), nullptr, 16) / 255.0);
    return text;
}

/// The operators that draw lines or fill areas (strokes without a width): colour (RG, rg), opacity (gs), width (w),
/// caps (J), dashes (d), path (m, l, h: close) and paint (S: stroke, f: fill), within q and Q.
std::string operators_of(const strokes& s) {
    const bool is_area = s.width == 0;
    std::string text = "q ";
    if (is_area) {
        text += operands_of(s.colour) + (s.faint ? "rg /Faint gs\n" : "rg\n");
    } else {
        text += operands_of(s.colour) + "RG " + short_number(s.width * em) + " w " + (s.round ? "1 J [" : "0 J [");
        for (const double length : s.dashes) text += short_number(length * em) + " ";
        text += "] 0 d\n";
    }
    for (const std::vector<place>& line : s.lines) {
        const auto add = [&](const place& p, char path_operator) {
            text += short_number(p.x * em) + " " + short_number(p.y * em) + " " + path_operator + "\n";
        };
        for (const place& p : line) add(p, &p == line.data() ? 'm' : 'l');
        if (line.size() == 1) add(line.front(), 'l');  // to itself: with round caps, a disc
        if (s.closed) text += "h\n";
    }
    return text + (is_area ? "f Q\n" : "S Q\n");
}

/// The PDF operators that write a text with its superscript, turned about its anchor, `w.at`. PDF places the left end
/// of the baseline, (x, y): `offset` to the left of the anchor along the text, and `baseline` below it.
std::string operators_of(const words& w) {
    const std::string text = encoded(w.text);
    const std::string power = encoded(w.power);
    const double width = w.size * (width_of(text) + power_size * width_of(power));
    const double offset = w.end == words::anchor::left ? 0 : w.end == words::anchor::middle ? width / 2 : width;
    const double turn = w.angle * std::numbers::pi / 180;
    const double size = w.size * em;
    const double x = w.at.x - offset * std::cos(turn) + baseline * w.size * std::sin(turn);
    const double y = w.at.y - offset * std::sin(turn) - baseline * w.size * std::cos(turn);
    std::string ops =
        fmt::format("BT /F {} Tf {:.4f} {:.4f} {:.4f} {:.4f} {:.2f} {:.2f} Tm {} Tj", short_number(size),
                    std::cos(turn), std::sin(turn), -std::sin(turn), std::cos(turn), x * em, y * em, in_brackets(text));
    if (!power.empty())
        ops += fmt::format(" /F {} Tf {} Ts {} Tj 0 Ts", short_number(power_size * size),
                           short_number(power_rise * size), in_brackets(power));
    return ops + " ET\n";
}

}  // namespace

/// A PDF file of one page: catalog, pages, page, content, font, then their byte positions (xref).
std::string pdf_of(const sheet& s) {
    std::string page;  // its content
    for (const auto& part : s.parts) page += std::visit([](const auto& p) { return operators_of(p); }, part);
    const std::vector<std::string> objects = {
        "<</Type/Catalog/Pages 2 0 R>>", "<</Type/Pages/Kids[3 0 R]/Count 1>>",
        fmt::format("<</Type/Page/Parent 2 0 R/MediaBox[0 0 {} {}]/Contents 4 0 R/Resources<</Font<</F 5 0 R>>/"
                    "ExtGState<</Faint<</ca {}>>>>>>>>",
                    short_number(s.width * em), short_number(s.height * em), faint_opacity),
        fmt::format("<</Length {}>>stream\n{}\nendstream", page.size(), page),
        fmt::format("<</Type/Font/Subtype/Type1/BaseFont/Helvetica/Encoding{}>>", encoding)};
    // The second line marks the file as binary.
    std::string pdf = "%PDF-1.4\n%\xe2\xe3\xcf\xd3\n";
    std::string positions;
    for (std::size_t i = 0; i < objects.size(); ++i) {
        positions += fmt::format("{:010} 00000 n \n", pdf.size());
        pdf += fmt::format("{} 0 obj\n{}\nendobj\n", i + 1, objects[i]);
    }
    const std::size_t count = objects.size() + 1;
    return pdf +
           fmt::format("xref\n0 {}\n0000000000 65535 f \n{}trailer\n<</Size {}/Root 1 0 R>>\nstartxref\n{}\n%%EOF\n",
                       count, positions, count, pdf.size());
}

}  // namespace aabblab
