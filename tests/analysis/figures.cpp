#include <catch2/generators/catch_generators.hpp>
#include <regex>

#include "../experiments/temporary_folder.hpp"
#include "../matches.hpp"

import aabb;
import aabblab.figures;
import aabblab.scale;

using aabblab::figure;
using aabblab::figure_point;
using aabblab::series_style;
using Catch::Matchers::ContainsSubstring;

namespace {

constexpr double not_a_number = std::numeric_limits<double>::quiet_NaN();
constexpr double infinity = std::numeric_limits<double>::infinity();

aabblab::series series_of(std::string label, series_style style, std::vector<figure_point> points) {
    return {std::move(label), style, std::move(points)};
}

figure figure_of(std::vector<aabblab::series> lines) {
    return {"figure1", "Time against the number of objects.", {"objects"}, {"time a frame (ms)"}, std::move(lines)};
}

/// A line with varying quartiles, one without, points, a level and a mark.
figure every_style() {
    figure f = figure_of({series_of("varies", series_style::line, {{100, 2, 1, 3}, {1000, 20, 15, 30}}),
                          series_of("stays", series_style::line, {{100, 5, 5, 5}, {1000, 6, 6, 6}}),
                          series_of("dots", series_style::points, {{200, 3, 2, 4}, {500, 9, 9, 9}}),
                          series_of("line", series_style::level, {{not_a_number, 7, 6, 8}, {0, 1000, 1, 1}})});
    f.x.logarithmic = true;
    f.marks = {{300, "three hundred"}};
    return f;
}

/// Whether tags are balanced and special characters are escaped.
bool well_formed(std::string_view xml) {
    std::vector<std::string_view> open;
    for (std::size_t i = 0; i < xml.size(); ++i) {
        if (xml[i] == '&') {
            const std::size_t end = xml.find(';', i);
            if (end == std::string_view::npos || end - i > 8 || xml.find(' ', i) < end) return false;
        }
        if (xml[i] != '<') continue;
        const std::size_t end = xml.find('>', i);
        if (end == std::string_view::npos) return false;
        std::string_view tag = xml.substr(i + 1, end - i - 1);
        i = end;
        if (tag.empty() || tag.find('<') != std::string_view::npos) return false;
        if (tag.front() == '?' || tag.front() == '!' || tag.back() == '/') continue;
        if (tag.front() == '/') {
            if (open.empty() || open.back() != tag.substr(1)) return false;
            open.pop_back();
        } else {
            open.push_back(tag.substr(0, tag.find_first_of(" \n\t")));
        }
    }
    return open.empty();
}

/// A text of an SVG with its bounding box, for letters as wide as in the widest usual sans serif font.
struct placed_text {
    std::string text;
    double left, right, top, bottom;
};

std::vector<placed_text> texts_of(const std::string& svg) {
    std::vector<placed_text> texts;
    const std::regex element(R"re(<text x="([-0-9.]+)" y="([-0-9.]+)" dy="[0-9.]+"( font-size="([0-9.]+)")?)re"
                             R"re( text-anchor="([a-z]+)"( transform="rotate\(([-0-9.]+)[^"]*")?>(.*?)</text>)re");
    for (std::sregex_iterator i(svg.begin(), svg.end(), element), end; i != end; ++i) {
        std::string text = std::regex_replace((*i)[8].str(), std::regex("<[^>]*>"), "");
        text = std::regex_replace(text, std::regex("&[a-z]+;"), "x");
        const auto letters = std::ranges::count_if(text, [](char c) { return (c & 0xc0) != 0x80; });
        const double size = (*i)[4].matched ? std::stod((*i)[4]) : 16;
        const double width = size * 0.6 * static_cast<double>(letters);
        const double x = std::stod((*i)[1]);
        const double y = std::stod((*i)[2]);
        const double before = (*i)[5] == "start" ? 0 : (*i)[5] == "middle" ? width / 2 : width;
        const double behind = width - before;
        const double turn = (*i)[7].matched ? std::stod((*i)[7]) * 3.14159265358979 / 180 : 0;
        // The extent along the line of text; across it the text takes less than half a line.
        const auto [from_x, to_x] = std::minmax(x - before * std::cos(turn), x + behind * std::cos(turn));
        const auto [from_y, to_y] = std::minmax(y - before * std::sin(turn), y + behind * std::sin(turn));
        const double half = turn == 0 ? size / 2 : 0;
        texts.push_back({text, from_x, to_x, from_y - half, to_y + half});
    }
    return texts;
}

placed_text text_in(const std::string& svg, const std::string& text) {
    const std::vector<placed_text> texts = texts_of(svg);
    const auto match = std::ranges::find(texts, text, &placed_text::text);
    REQUIRE(match != texts.end());
    return *match;
}

/// The edges of the first plot, given by its axes.
struct edges {
    double left, right, top, bottom;
};

edges plot_of(const std::string& svg) {
    std::smatch match;
    REQUIRE(std::regex_search(svg, match, std::regex(R"re(d="M([0-9.]+) ([0-9.]+)L\1 ([0-9.]+)L([0-9.]+) \3M)re")));
    return {std::stod(match[1]), std::stod(match[4]), std::stod(match[2]), std::stod(match[3])};
}

std::set<std::string> set_in(const std::string& text, const std::string& pattern) {
    const std::vector<std::string> matches = found_in(text, pattern);
    return {matches.begin(), matches.end()};
}

/// Requires that no text is cut off.
void require_texts_inside(const std::string& svg) {
    std::smatch size;
    REQUIRE(std::regex_search(svg, size, std::regex("<svg [^>]*width=\"([0-9.]+)\" height=\"([0-9.]+)\"")));
    const std::vector<placed_text> texts = texts_of(svg);
    REQUIRE(!texts.empty());
    for (const placed_text& t : texts) {
        CAPTURE(t.text, t.left, t.right, t.top, t.bottom);
        CHECK(t.left >= 0);
        CHECK(t.right <= std::stod(size[1]));
        CHECK(t.top >= 0);
        CHECK(t.bottom <= std::stod(size[2]));
    }
}

void require_texts_disjoint(const std::string& svg) {
    const std::vector<placed_text> texts = texts_of(svg);
    for (const placed_text& a : texts)
        for (const placed_text& b : texts) {
            if (&a >= &b) continue;
            CAPTURE(a.text, b.text);
            const bool disjoint = a.right <= b.left || b.right <= a.left || a.bottom <= b.top || b.bottom <= a.top;
            CHECK(disjoint);
        }
}

void require_svg(const std::string& svg) {
    REQUIRE(svg.starts_with("<svg xmlns="));
    REQUIRE(well_formed(svg));
}

/// Requires a PDF whose cross-reference table is at the offset that the end of the file states.
void require_pdf(const std::string& pdf) {
    REQUIRE(pdf.starts_with("%PDF-"));
    REQUIRE(pdf.ends_with("%%EOF\n"));
    const std::size_t startxref = pdf.rfind("startxref\n");
    REQUIRE(startxref != std::string::npos);
    const std::size_t table = std::stoul(pdf.substr(startxref + 10));
    REQUIRE(table < pdf.size());
    REQUIRE((pdf.compare(table, 4, "xref") == 0 || std::isdigit(static_cast<unsigned char>(pdf[table])) != 0));
}

/// Three lines whose ends differ by this factor, which decides whether labels fit beside them.
figure three_lines(double factor) {
    std::vector<aabblab::series> lines;
    double end = 1;
    for (const char* label : {"Shell sort", "insertion sort, axial cut", "incremental"}) {
        lines.push_back(series_of(label, series_style::line, {{100, 1, 1, 1}, {100000, end, end, end}}));
        end *= factor;
    }
    figure f = figure_of(lines);
    f.x.logarithmic = f.y.logarithmic = true;
    return f;
}

/// Panels with two lines and a level, all with the same labels.
figure small_multiples(std::size_t count) {
    figure f = figure_of({series_of("equal", series_style::level, {{0, 1, 1, 1}})});
    f.x.logarithmic = true;
    for (std::size_t i = 0; i < count; ++i) {
        const double y = static_cast<double>(i) + 2;
        f.panels.push_back({"displacement " + std::to_string(i),
                            {series_of("Shell sort", series_style::line, {{100, 1, 1, 1}, {1000000, y, y, y}}),
                             series_of("insertion sort", series_style::line, {{100, 2, 2, 2}, {1000000, 3, 3, 3}})},
                            {{1000, "a mark"}}});
    }
    return f;
}

}  // namespace

TEST_CASE_METHOD(in_folder, "A figure is written as CSV, SVG and PDF, in a folder that is created") {
    figure other = every_style();
    other.name = "other";
    const std::array figures{every_style(), other};
    const std::filesystem::path deep = folder / "in" / "deep";
    aabblab::draw(deep, figures);
    for (const figure& f : figures) {
        REQUIRE(bytes_of_file(deep / (f.name + ".csv")) == csv_of(f));
        REQUIRE(bytes_of_file(deep / (f.name + ".svg")) == svg_of(f));
        REQUIRE(bytes_of_file(deep / (f.name + ".pdf")) == pdf_of(f));
        require_svg(svg_of(f));
        require_pdf(pdf_of(f));
    }
    REQUIRE(std::distance(std::filesystem::directory_iterator(deep), {}) == 6);
    for (const char* text : {"objects", "time a frame (ms)", "varies", "stays", "dots", "line", "three hundred"}) {
        REQUIRE_THAT(svg_of(other), ContainsSubstring(">" + std::string(text) + "</text>"));
        const std::string in_pdf = std::regex_replace(text, std::regex("[()]"), "\\$&");
        REQUIRE_THAT(pdf_of(other), ContainsSubstring("(" + in_pdf + ") Tj"));
    }
}

TEST_CASE("The CSV file of a figure has its points") {
    figure f =
        figure_of({series_of("a, \"b\"\nc", series_style::points, {{1, 0.1, 0.05, 2e-7}, {2, 3, 1, 4}}),
                   series_of("nothing", series_style::line, {}),
                   series_of("not finite", series_style::line,
                             {{1, not_a_number, 1, 2}, {infinity, 1, 1, 2}, {2, 5, not_a_number, 6}, {3, 0, -1, 1}}),
                   series_of("level", series_style::level,
                             {{not_a_number, infinity, 1, 2}, {not_a_number, 4, 3, 5}, {1, 9, 9, 9}})});
    f.y.logarithmic = true;
    SECTION("with numbers on the axes") {
        REQUIRE(csv_of(f) ==
                "number,x,y,low,high,series\n"
                "1,1,0.1,0.1,0.1,\"a, \"\"b\"\" c\"\n"
                "1,2,3,1,4,\"a, \"\"b\"\" c\"\n"
                "3,2,5,5,5,not finite\n"
                "3,3,0,-1,1,not finite\n"
                "4,,4,3,5,level\n");
    }
    SECTION("with names") {
        f.x.names = {{1, "one"}, {2, "two, too"}};
        f.lines.resize(1);
        REQUIRE(csv_of(f) ==
                "number,x,y,low,high,series,x_name\n"
                "1,1,0.1,0.1,0.1,\"a, \"\"b\"\" c\",one\n"
                "1,2,3,1,4,\"a, \"\"b\"\" c\",\"two, too\"\n");
    }
    require_svg(svg_of(f));
}

TEST_CASE("Special characters in texts are escaped in SVG and PDF") {
    // Quotes, special characters of shells, format strings, XML and PDF, and UTF-8.
    const std::string text = "'it''s' \"a_b^{c}\" `date` $x 5% %g \\n <&amp;> (é";
    const std::string in_svg = "'it''s' &quot;a_b^{c}&quot; `date` $x 5% %g \\n &lt;&amp;amp;&gt; (é";
    figure f = figure_of({series_of(text, series_style::points, {{1, 1, 1, 1}})});
    f.x.label = text;
    SECTION("of labels") {
        f.y.label = "'a_b' `date`";
        f.marks = {{1, text}};
        require_svg(svg_of(f));
        REQUIRE(count_of(">" + in_svg + "</text>", svg_of(f)) == 3);
        REQUIRE_THAT(svg_of(f), ContainsSubstring(">'a_b' `date`</text>"));
        require_pdf(pdf_of(f));
        REQUIRE_THAT(pdf_of(f), ContainsSubstring("%g \\\\n <&amp;> \\(\xe9) Tj"));
    }
    SECTION("of names") {
        f.x.names = {{1, "'a_b'\n50%"}};
        f.y.names = {{1, "{a}^b %g"}};
        require_svg(svg_of(f));
        REQUIRE_THAT(svg_of(f), ContainsSubstring(">'a_b' 50%</text>"));
        REQUIRE_THAT(svg_of(f), ContainsSubstring(">{a}^b %g</text>"));
    }
    SECTION("that the encoding of a PDF font remaps or lacks") {
        f.y.label = "\u2212 \u2265 \u2026 \u6f22";
        REQUIRE_THAT(pdf_of(f), ContainsSubstring("(\x01 \x03 \x85 ?) Tj"));
    }
}

TEST_CASE("A long label is wrapped without losing words") {
    std::string words;
    for (int i = 0; i < 30; ++i) words += "word" + std::to_string(i) + ' ';
    const std::string svg = svg_of(figure_of({series_of(words, series_style::line, {{1, 1, 1, 1}}),
                                              series_of(std::string(150, 'w'), series_style::line, {{1, 2, 2, 2}})}));
    require_svg(svg);
    for (int i = 0; i < 30; ++i) REQUIRE_THAT(svg, ContainsSubstring("word" + std::to_string(i)));
    REQUIRE(count_of("w", svg) >= 150);
    REQUIRE_THAT(svg, !ContainsSubstring(std::string(60, 'w')));
}

TEST_CASE("Long names leave room for the plot") {
    const auto name = "compressed:build=sah,leaf_test=triangle_aabb,and=so,on=and,on=for,ever=" + std::string(60, 'x');
    for (const bool on_x : {true, false}) {
        figure f = figure_of({series_of("s", series_style::points, {{1, 1, 1, 1}, {2, 2, 2, 2}})});
        (on_x ? f.x : f.y).names = {{1, name}, {2, name}};
        const auto [left, right, top, bottom] = plot_of(svg_of(f));
        REQUIRE(left >= 0);
        REQUIRE(right - left > 0.3 * 36 * 16);
        REQUIRE(bottom - top > 0.15 * 36 * 16);
        require_svg(svg_of(f));
        require_texts_inside(svg_of(f));
    }
}

TEST_CASE("A figure without data says so") {
    std::vector<figure> empty{figure_of({}), figure_of({series_of("left out", series_style::line, {})}),
                              figure_of({series_of("left out", series_style::level, {{0, -1, -1, -1}})})};
    empty.back().y.logarithmic = true;
    for (const figure& f : empty) {
        require_svg(svg_of(f));
        require_pdf(pdf_of(f));
        REQUIRE_THAT(svg_of(f), ContainsSubstring("no data"));
        REQUIRE_THAT(svg_of(f), !ContainsSubstring("left out"));
    }
}

TEST_CASE("A series without points is omitted, and the others keep their styles") {
    const auto second = series_of("second", series_style::line, {{1, 1, 1, 1}, {2, 2, 2, 2}});
    const std::string without = svg_of(figure_of({series_of("first", series_style::line, {}), second}));
    const std::string with = svg_of(figure_of({series_of("first", series_style::line, {{1, 1, 1, 1}}), second}));
    const std::string colours = "stroke=\"(#[A-F0-9]*)\"[^>]* stroke-dasharray";
    REQUIRE(set_in(without, colours).size() == 1);
    REQUIRE(set_in(without, colours) == set_in(with, colours));
    REQUIRE_THAT(without, !ContainsSubstring("first"));
}

TEST_CASE("A single point is drawn on linear and logarithmic axes") {
    for (const double y : {0., 3., -2., 1e-200, 1e200})
        for (const bool logarithmic : {false, true})
            for (const auto style : {series_style::line, series_style::points, series_style::level}) {
                figure f = figure_of({series_of("one", style, {{1, y, y, y}})});
                f.y.logarithmic = logarithmic;
                const std::string svg = svg_of(f);
                require_svg(svg);
                REQUIRE((svg.find("no data") != std::string::npos) == (logarithmic && y <= 0));
            }
}

TEST_CASE("A logarithmic axis omits values that are not positive") {
    const std::vector<figure_point> positive{{1, 1, 1, 1}, {10, 100, 50, 200}, {100, 30, 30, 30}};
    std::vector<figure_point> more = positive;
    more.insert(more.end(), {{0, 5, 5, 5}, {-7, 5, 5, 5}, {5, 0, 0, 0}, {5, -3, -4, 5000}});
    figure f = figure_of({series_of("points", series_style::points, positive)});
    figure g = figure_of({series_of("points", series_style::points, more)});
    f.x.logarithmic = f.y.logarithmic = g.x.logarithmic = g.y.logarithmic = true;
    g.marks = {{0, "nowhere"}};
    REQUIRE(svg_of(f) == svg_of(g));
    // A quartile of a visible point that lies outside the axis is clipped to its end.
    f.lines[0].points[0].low = -1;
    f.lines[0].points[0].high = 2;
    require_svg(svg_of(f));
}

TEST_CASE("Bands and error bars are drawn only for quartiles that differ") {
    const auto svg = [](series_style style, double low, double high) {
        return svg_of(figure_of({series_of("s", style, {{1, 5, low, high}, {2, 5, low, high}})}));
    };
    for (const auto style : {series_style::line, series_style::points, series_style::level}) {
        const std::size_t parts = count_of("<path", svg(style, 5, 5));
        CHECK(count_of("<path", svg(style, 4, 6)) == parts + 1);
        CHECK(count_of("fill-opacity", svg(style, 4, 6)) == (style == series_style::points ? 0 : 1));
        for (const auto& [low, high] : {std::pair(6., 4.), std::pair(not_a_number, 6.), std::pair(4., infinity)})
            CHECK(svg(style, low, high) == svg(style, 5, 5));
    }
}

TEST_CASE("Intervals of x are drawn as bars, widen the axis and are in the CSV file") {
    const auto drawn = [](double low, double high) {
        return figure_of({series_of("s", series_style::curve,
                                    {{.x = 10, .y = 5, .x_low = low, .x_high = high}, {.x = 20, .y = 6}})});
    };
    const std::size_t parts = count_of("<path", svg_of(drawn(10, 10)));
    CHECK(count_of("<path", svg_of(drawn(9, 12))) == parts + 1);
    for (const auto& [low, high] : {std::pair(12., 9.), std::pair(not_a_number, 12.), std::pair(9., infinity)}) {
        CHECK(svg_of(drawn(low, high)) == svg_of(drawn(10, 10)));
        CHECK(csv_of(drawn(low, high)) == csv_of(drawn(10, 10)));
    }
    // Bars of both, but no band.
    figure both = drawn(9, 12);
    both.lines[0].points[0].low = 4;
    CHECK(count_of("fill-opacity", svg_of(both)) == 0);
    CHECK(svg_of(both) != svg_of(drawn(9, 12)));
    // The bar ends inside the plot.
    const std::string wide = svg_of(drawn(1, 500));
    CHECK_THAT(wide, ContainsSubstring(">500</text>"));
    CHECK(csv_of(drawn(9, 12)) == "number,x,y,low,high,series,x_low,x_high\n1,10,5,5,5,s,9,12\n1,20,6,6,6,s,20,20\n");
}

TEST_CASE("Points have labels, beside them or with a line to them") {
    figure f = figure_of({series_of("s", series_style::curve, {})});
    for (int i = 1; i <= 6; ++i)
        f.lines[0].points.push_back(
            {.x = static_cast<double>(i), .y = static_cast<double>(i % 2), .label = "bits=" + std::to_string(i)});
    const std::string svg = svg_of(f);
    require_svg(svg);
    require_pdf(pdf_of(f));
    require_texts_inside(svg);
    require_texts_disjoint(svg);
    const edges plot = plot_of(svg);
    double previous = 0;
    for (int i = 1; i <= 6; ++i) {
        const placed_text label = text_in(svg, "bits=" + std::to_string(i));
        CHECK(label.left >= plot.left);
        CHECK(label.right <= plot.right);
        CHECK(label.top >= plot.top);
        CHECK(label.bottom <= plot.bottom);
        CHECK(label.left > previous);  // each at its own point
        previous = label.left;
    }
    CHECK(csv_of(f).starts_with("number,x,y,low,high,series,label\n1,1,1,1,1,s,bits=1\n"));
    // In a crowd all have one too.
    figure crowd = f;
    for (int i = 0; i < 40; ++i)
        crowd.lines[0].points.push_back(
            {.x = 3 + i * 0.001, .y = 0.5 + i * 0.001, .label = "crowded " + std::to_string(i)});
    const std::string crowded = svg_of(crowd);
    require_svg(crowded);
    require_texts_inside(crowded);
    require_texts_disjoint(crowded);
    CHECK(count_of(">crowded ", crowded) == 40);
    CHECK(count_of(",crowded ", csv_of(crowd)) == 40);
}

TEST_CASE("Ten series are distinguishable in black and white") {
    std::vector<aabblab::series> ten;
    for (int i = 0; i < 10; ++i)
        ten.push_back(series_of("series " + std::to_string(i), series_style::line, {{1, 1, 1, 1}, {2, 1, 1, 1}}));
    const std::string svg = svg_of(figure_of(ten));
    // One of the ten lines is solid.
    REQUIRE(set_in(svg, "stroke-dasharray=\"([^\"]*)\"").size() == 9);
    // The legend follows all texts: a line and a marker for each series.
    const std::vector<std::string> paths = found_in(svg.substr(svg.rfind("</text>")), "(<path [^>]*>)");
    REQUIRE(paths.size() == 20);
    std::set<std::string> shapes;
    for (std::size_t i = 1; i < paths.size(); i += 2) {
        // The shape is compared without position and colour.
        std::vector<double> numbers;
        for (const std::string& number : found_in(paths[i], "[ML ]([0-9.]+)")) numbers.push_back(std::stod(number));
        std::string shape = std::regex_replace(paths[i], std::regex("#[A-F0-9]*| d=\"[^\"]*\""), "");
        for (std::size_t k = 2; k < numbers.size(); ++k)
            shape += " " + std::to_string(std::lround(numbers[k] - numbers[k - 2]));
        shapes.insert(shape);
    }
    REQUIRE(shapes.size() == 10);
}

TEST_CASE("Axes have round tick values in readable notation") {
    const auto [least, greatest, logarithmic, labels] = GENERATE(table<double, double, bool, std::string>({
        {1, 1e5, true, "1 10 100 1,000 10,000 100,000"},
        {1e-7, 1, true, "10^\u22126 10^\u22124 10^\u22122 10^0"},
        {1e-30, 1e30, true, "10^\u221230 10^\u221220 10^\u221210 10^0 10^10 10^20 10^30"},
        {20, 80, true, "20 40 60 80"},
        {41, 44, true, "41 42 43 44"},
        {3, 9, false, "0 2 4 6 8 10"},
        {-0.1, 0.25, false, "\u22120.1 0.0 0.1 0.2 0.3"},
        {1000, 20000, false, "0 5,000 10,000 15,000 20,000"},
        {1e8, 3e8, false, "0 10^8 2\u00d710^8 3\u00d710^8"},
    }));
    std::string shown;
    for (const aabblab::tick& t : scale_of(least, greatest, logarithmic, aabblab::scale_end::on_ticks).ticks)
        if (!t.label.empty()) shown += (shown.empty() ? "" : " ") + t.label + (t.power.empty() ? "" : "^" + t.power);
    CHECK(shown == labels);
}

TEST_CASE("Round values are finitely many, even far from 0") {
    CHECK(aabblab::round_values(1e30, 1e30 + 1, aabblab::round_step(1, 5)).size() < 10);
    CHECK(aabblab::round_values(-0.25, 0.25, 0.1) == std::vector{-0.2, -0.1, 0., 0.1, 0.2});
    for (const auto& [span, step] : {std::pair(10., 2.), std::pair(11., 5.), std::pair(0.3, 0.1)})
        CHECK(aabblab::round_step(span, 5) == step);
}

TEST_CASE("Points of several series at one category are drawn side by side") {
    const std::vector<figure_point> points{{1, 1, 1, 1}, {2, 2, 2, 2}};
    figure f = figure_of({series_of("", series_style::points, points), series_of("", series_style::points, points)});
    // The positions of discs, and of the left edges of squares.
    const auto distance = [&] {
        const auto at = found_in(svg_of(f), "d=\"M([0-9.]+) [^\"]*(?:h0|z)\"[^>]* stroke=\"#");
        REQUIRE(at.size() == 2);
        return std::stod(at[1]) - std::stod(at[0]);
    };
    const double half_square = distance();
    CHECK(std::abs(half_square) < 4);
    f.x.names = {{1, "one"}, {2, "two"}};
    const auto [left, right, top, bottom] = plot_of(svg_of(f));
    // Two categories share the width, and the two series are 0.3 of half a category apart.
    CHECK(std::abs(distance() - half_square - 0.15 * (right - left) / 2) < 0.1);
}

TEST_CASE_METHOD(in_folder, "A folder that cannot be created is named in the error") {
    folder.write("file", "");
    const figure f = every_style();
    REQUIRE_THROWS_AS(aabblab::draw(folder / "file", {&f, 1}), aabb::input_error);
    REQUIRE_THROWS_WITH(aabblab::draw(folder / "file", {&f, 1}), ContainsSubstring((folder / "file").string()));
}

TEST_CASE("Lines are labelled at their ends if these are far enough apart") {
    const std::string svg = svg_of(three_lines(10));
    CHECK(text_in(svg, "incremental").left > plot_of(svg).right);
    require_svg(svg);
    require_texts_inside(svg);
    require_texts_disjoint(svg);
    for (const char* words :
         {">Shell sort</text>", ">insertion sort,</text>", ">axial cut</text>", ">incremental</text>"})
        REQUIRE_THAT(svg, ContainsSubstring(words));
    // Labels are ordered as the ends of the lines.
    CHECK(text_in(svg, "incremental").top < text_in(svg, "insertion sort,").top);
    CHECK(text_in(svg, "axial cut").top < text_in(svg, "Shell sort").top);
}

TEST_CASE("Overlapping labels are shifted slightly, or moved to a legend if that does not suffice") {
    const std::string near = svg_of(three_lines(1.3));
    require_texts_inside(near);
    require_texts_disjoint(near);
    std::vector<aabblab::series> many;
    for (int i = 0; i < 9; ++i)
        many.push_back(series_of("line " + std::to_string(i), series_style::line, {{1, 1, 1, 1}, {2, 2, 2, 2}}));
    many.push_back(series_of("far", series_style::line, {{1, 1, 1, 1}, {2, 100, 100, 100}}));
    // A line that ends before the others has no end there, and neither have points.
    figure early = three_lines(10);
    early.lines[1].points.back().x = 1000;
    figure dots = three_lines(10);
    dots.lines[1].style = series_style::points;
    for (const figure& f : {figure_of(many), early, dots}) {
        const std::string svg = svg_of(f);
        CHECK(text_in(svg, f.lines.back().label).top > plot_of(svg).bottom);
        require_texts_inside(svg);
    }
}

TEST_CASE("Labels at the ends of lines stay within the figure") {
    std::vector<aabblab::series> lines;
    for (const auto& [label, end] :
         {std::pair("canonical", 31.), {"shared planes", 33.}, {"compressed", 36.}, {"leafless", 37.}})
        lines.push_back(
            series_of(label, series_style::line, {{1000, end / 50, end / 50, end / 50}, {1e6, end, end, end}}));
    figure high = figure_of(lines);
    figure low = high;
    for (aabblab::series& s : low.lines) std::swap(s.points[0].y, s.points[1].y);
    for (figure& f : {std::ref(high), std::ref(low)}) {
        f.x.logarithmic = f.y.logarithmic = true;
        const std::string svg = svg_of(f);
        require_texts_inside(svg);
        require_texts_disjoint(svg);
    }
    // They stand close together there, and not in a legend.
    const std::string svg = svg_of(high);
    CHECK(text_in(svg, "leafless").left > plot_of(svg).right);
}

TEST_CASE("The line of a mark does not run through the text of another") {
    figure f = figure_of({series_of("s", series_style::line, {{0.05, 1, 1, 1}, {2, 2, 2, 2}})});
    f.x.logarithmic = true;
    f.marks = {{0.157, "5 %"}, {0.314, "10 % of the contact time"}, {1, "dormand_prince 0.9984"}, {2, "verlet 2"}};
    const std::string svg = svg_of(f);
    require_texts_inside(svg);
    struct area {
        double left, top, right, bottom;
    };
    std::vector<area> blank;
    const std::regex white(R"re(d="M([0-9.]+) ([0-9.]+)L([0-9.]+) \2L\3 ([0-9.]+)L[^"]*" fill="#FFFFFF")re");
    for (std::sregex_iterator i(svg.begin(), svg.end(), white), end; i != end; ++i)
        blank.push_back({std::stod((*i)[1]), std::stod((*i)[4]), std::stod((*i)[3]), std::stod((*i)[2])});
    std::size_t crossings = 0;
    const std::regex line(R"re(d="M([0-9.]+) ([0-9.]+)L\1 ([0-9.]+)"[^>]*stroke-dasharray="2.4 4")re");
    std::size_t marks = 0;
    for (std::sregex_iterator i(svg.begin(), svg.end(), line), end; i != end; ++i, ++marks) {
        const double x = std::stod((*i)[1]);
        const double top = std::stod((*i)[3]);
        for (const aabblab::figure_mark& m : f.marks) {
            const placed_text text = text_in(svg, m.label);
            if (x <= text.left || text.right <= x || text.bottom <= top) continue;
            ++crossings;
            CAPTURE(m.label, x, text.left, text.right);
            CHECK(std::ranges::any_of(blank, [&](const area& a) {
                return a.left <= text.left + 1 && text.right - 1 <= a.right && a.top <= text.top &&
                       text.bottom <= a.bottom;
            }));
        }
    }
    CHECK(marks == f.marks.size());
    CHECK(crossings > 0);  // without an area behind the text
}

TEST_CASE("Panels share axes, styles and a legend") {
    for (const std::size_t count : {1, 2, 3, 4, 7}) {
        CAPTURE(count);
        const figure f = small_multiples(count);
        const std::string svg = svg_of(f);
        require_svg(svg);
        require_pdf(pdf_of(f));
        require_texts_inside(svg);
        require_texts_disjoint(svg);
        for (std::size_t i = 0; i < count; ++i) CHECK(count_of(">displacement " + std::to_string(i) + "<", svg) == 1);
        for (const char* once : {"objects", "time a frame (ms)", "Shell sort", "insertion sort"})
            CHECK(count_of(">" + std::string(once) + "</text>", svg) == 1);
        CHECK(count_of(">a mark</text>", svg) == count);
        // Three styles, a frame and a grid.
        CHECK(set_in(svg, "stroke=\"(#[A-F0-9]*)\"").size() == 5);
        CHECK(
            csv_of(f).starts_with("number,x,y,low,high,series,panel\n1,,1,1,1,equal,\n"
                                  "2,100,1,1,1,Shell sort,displacement 0\n"));
    }
}

TEST_CASE("No text of a figure is cut off or overlaps another") {
    figure wide = figure_of({series_of("a line with a long label that has to stand in a legend below the plot",
                                       series_style::line, {{1, 1e6, 1e6, 1e6}, {1e6, 3e6, 3e6, 3e6}})});
    wide.x.label = "number of objects that move by a tenth of their edge in a frame, over all scenes and seeds";
    wide.y.label = "time of a frame over that of the axial cut in the same repeat (median)";
    wide.x.logarithmic = true;
    wide.marks = {{1e5, "the first of two long marks"}, {9e5, "and the second of them"}};
    figure ticks = figure_of({series_of("s", series_style::line, {{1e6, 1, 1, 1}, {9e6, 2, 2, 2}})});
    figure slanted = figure_of({series_of("s", series_style::points, {})});
    for (int i = 0; i < 9; ++i) {
        slanted.x.names.emplace_back(i, "triangle/moller:epsilon=scaled" + std::to_string(i));
        slanted.lines.front().points.push_back({static_cast<double>(i), 1, 1, 1});
    }
    require_texts_inside(svg_of(slanted));
    for (const figure& f : {every_style(), wide, ticks, three_lines(100)}) {
        CAPTURE(f.lines.front().label);
        const std::string svg = svg_of(f);
        require_texts_inside(svg);
        require_texts_disjoint(svg);
    }
}
