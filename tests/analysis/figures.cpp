#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <catch2/catch_test_macros.hpp>
#include <catch2/generators/catch_generators.hpp>
#include <catch2/matchers/catch_matchers_string.hpp>
#include <cctype>
#include <cmath>
#include <csignal>
#include <cstddef>
#include <cstdlib>
#include <filesystem>
#include <limits>
#include <regex>
#include <set>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "../experiments/temporary_folder.hpp"

import aabb;
import aabblab.figures;

using aabblab::figure;
using aabblab::figure_point;
using aabblab::series_style;
using Catch::Matchers::ContainsSubstring;
using Catch::Matchers::EndsWith;

namespace {

constexpr double not_a_number = std::numeric_limits<double>::quiet_NaN();
constexpr double infinity = std::numeric_limits<double>::infinity();

aabblab::series series_of(std::string label, series_style style, std::vector<figure_point> points) {
    aabblab::series s;
    s.label = std::move(label);
    s.style = style;
    s.points = std::move(points);
    return s;
}

figure figure_of(std::vector<aabblab::series> lines) {
    figure f;
    f.name = "figure1";
    f.caption = "Time against the number of objects.";
    f.x.label = "objects";
    f.y.label = "time a frame (ms)";
    f.lines = std::move(lines);
    return f;
}

/// One that varies, one that does not, points, a level and a mark.
figure every_style() {
    figure f = figure_of({series_of("varies", series_style::line, {{100, 2, 1, 3}, {1000, 20, 15, 30}}),
                          series_of("stays", series_style::line, {{100, 5, 5, 5}, {1000, 6, 6, 6}}),
                          series_of("dots", series_style::points, {{200, 3, 2, 4}, {500, 9, 9, 9}}),
                          series_of("line", series_style::level, {{not_a_number, 7, 6, 8}, {0, 1000, 1, 1}})});
    f.x.logarithmic = true;
    f.marks = {{300, "three hundred"}};
    return f;
}

struct pictures {
    std::string svg;
    std::string pdf;
};

pictures drawn(const figure& f) {
    const temporary_folder folder;
    aabblab::draw(folder.path(), {&f, 1});
    return {bytes_of_file(folder / (f.name + ".svg")), bytes_of_file(folder / (f.name + ".pdf"))};
}

std::size_t count_of(std::string_view part, std::string_view text) {
    std::size_t count = 0;
    for (std::size_t at = text.find(part); at != std::string_view::npos; at = text.find(part, at + 1)) ++count;
    return count;
}

/// Tags close in the order in which they opened, and nothing that must be escaped is not.
bool well_formed(std::string_view xml) {
    std::vector<std::string_view> open;
    for (std::size_t i = 0; i < xml.size(); ++i) {
        if (xml[i] == '&') {
            const std::size_t end = xml.find(';', i);
            if (end == std::string_view::npos || end - i > 8 ||
                xml.substr(i, end - i).find(' ') != std::string_view::npos)
                return false;
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

/// A text of an SVG, as far as gnuplot writes it, with the box that it takes where letters are as wide as in the widest
/// usual sans.
struct placed_text {
    std::string text;
    double left, right, top, bottom;
};

std::vector<placed_text> texts_of(const std::string& svg) {
    std::vector<placed_text> all;
    const std::regex one(
        R"re(<g transform="translate\(([-0-9.]+),([-0-9.]+)\)( rotate\(([-0-9.]+)\))?"[^>]*text-anchor="([a-z]+)">\s*<text>(.*?)</text>)re");
    for (std::sregex_iterator i(svg.begin(), svg.end(), one), end; i != end; ++i) {
        std::string text = std::regex_replace((*i)[6].str(), std::regex("<[^>]*>"), "");
        text = std::regex_replace(text, std::regex("&[a-z]+;"), "x");
        if (text.empty()) continue;
        const auto letters = std::ranges::count_if(text, [](char c) { return (c & 0xc0) != 0x80; });
        const double width = 16 * 0.6 * static_cast<double>(letters);
        const double x = std::stod((*i)[1]);
        const double y = std::stod((*i)[2]);
        const double before = (*i)[5] == "start" ? 0 : (*i)[5] == "middle" ? width / 2 : width;
        const double behind = width - before;
        const double turn = (*i)[4].matched ? std::stod((*i)[4]) * 3.14159265358979 / 180 : 0;
        // Along the line of text; up and down it takes less than half a line.
        const auto [from_x, to_x] = std::minmax(x - before * std::cos(turn), x + behind * std::cos(turn));
        const auto [from_y, to_y] = std::minmax(y - before * std::sin(turn), y + behind * std::sin(turn));
        all.push_back({text, from_x, to_x, from_y - (turn == 0 ? 12 : 0), to_y + (turn == 0 ? 4 : 0)});
    }
    return all;
}

/// No text is cut off.
void require_texts_inside(const std::string& svg) {
    const std::regex size("<svg\\s+width=\"([0-9.]+)\" height=\"([0-9.]+)\"");
    std::smatch found;
    REQUIRE(std::regex_search(svg, found, size));
    const std::vector<placed_text> texts = texts_of(svg);
    REQUIRE(!texts.empty());
    for (const placed_text& t : texts) {
        CAPTURE(t.text, t.left, t.right, t.top, t.bottom);
        CHECK(t.left >= 0);
        CHECK(t.right <= std::stod(found[1]));
        CHECK(t.top >= 0);
        CHECK(t.bottom <= std::stod(found[2]));
    }
}

void require_texts_apart(const std::string& svg) {
    const std::vector<placed_text> texts = texts_of(svg);
    for (const placed_text& a : texts)
        for (const placed_text& b : texts) {
            if (&a >= &b) continue;
            CAPTURE(a.text, b.text);
            const bool apart = a.right <= b.left || b.right <= a.left || a.bottom <= b.top || b.bottom <= a.top;
            CHECK(apart);
        }
}

void require_svg(const std::string& svg) {
    REQUIRE(svg.starts_with("<?xml"));
    REQUIRE_THAT(svg, ContainsSubstring("<svg"));
    REQUIRE(well_formed(svg));
}

/// Also that the table of its parts is where the end of the file says.
void require_pdf(const std::string& pdf) {
    REQUIRE(pdf.starts_with("%PDF-"));
    REQUIRE(pdf.ends_with("%%EOF\n"));
    const std::size_t said = pdf.rfind("startxref\n");
    REQUIRE(said != std::string::npos);
    const std::size_t table = std::stoul(pdf.substr(said + 10));
    REQUIRE(table < pdf.size());
    REQUIRE((pdf.compare(table, 4, "xref") == 0 || std::isdigit(static_cast<unsigned char>(pdf[table])) != 0));
}

/// A value of the environment until the end of the scope.
class environment {
public:
    environment(const char* name, const std::string& value) : name_(name) {
        if (const char* const before = std::getenv(name)) before_ = before;
        setenv(name, value.c_str(), 1);
    }
    environment(const environment&) = delete;
    environment& operator=(const environment&) = delete;
    ~environment() { setenv(name_, before_.c_str(), 1); }

private:
    const char* name_;
    std::string before_;
};

/// A gnuplot that does something else.
void write_gnuplot(const temporary_folder& folder, const std::string& commands) {
    const auto file = folder.write("gnuplot", "#!/bin/sh\n" + commands);
    std::filesystem::permissions(file, std::filesystem::perms::owner_all);
}

}  // namespace

TEST_CASE("A figure is a table, a script and two pictures, in a folder that need not be there") {
    const temporary_folder folder;
    figure other = every_style();
    other.name = "other";
    const std::array figures{every_style(), other};
    const std::filesystem::path deep = folder / "in" / "deep";
    aabblab::draw(deep, figures);
    for (const figure& f : figures) {
        REQUIRE(bytes_of_file(deep / (f.name + ".csv")) == aabblab::csv_of(f));
        REQUIRE(bytes_of_file(deep / (f.name + ".gp")) == aabblab::script_of(f));
        require_svg(bytes_of_file(deep / (f.name + ".svg")));
        require_pdf(bytes_of_file(deep / (f.name + ".pdf")));
    }
    REQUIRE(std::distance(std::filesystem::directory_iterator(deep), {}) == 8);
    const std::string svg = bytes_of_file(deep / "other.svg");
    for (const char* text : {"objects", "time a frame (ms)", "varies", "stays", "dots", "line", "three hundred"})
        REQUIRE_THAT(svg, ContainsSubstring(">" + std::string(text) + "</text>"));
}

TEST_CASE("The same figure gives the same files") {
    const pictures one = drawn(every_style());
    const pictures again = drawn(every_style());
    REQUIRE(one.svg == again.svg);
    REQUIRE(one.pdf.find("/CreationDate (") == std::string::npos);
    // Newer versions of cairo compress the date, which nothing but another clock changes then.
    if (one.pdf.find("/ObjStm") == std::string::npos) REQUIRE(one.pdf == again.pdf);
}

TEST_CASE("A figure's script draws it again from its own folder") {
    const temporary_folder folder;
    const figure f = every_style();
    aabblab::draw(folder.path(), {&f, 1});
    const std::string svg = bytes_of_file(folder / "figure1.svg");
    std::filesystem::remove(folder / "figure1.svg");
    std::filesystem::remove(folder / "figure1.pdf");
    REQUIRE_THAT(bytes_of_file(folder / "figure1.gp"), ContainsSubstring("gnuplot figure1.gp"));
    REQUIRE(std::system(("cd '" + folder.path().string() + "' && gnuplot figure1.gp").c_str()) == 0);
    REQUIRE(bytes_of_file(folder / "figure1.svg") == svg);
    require_pdf(bytes_of_file(folder / "figure1.pdf"));
}

TEST_CASE("A figure's table has its points") {
    figure f =
        figure_of({series_of("a, \"b\"\nc", series_style::points, {{1, 0.1, 0.05, 2e-7}, {2, 3, 1, 4}}),
                   series_of("nothing", series_style::line, {}),
                   series_of("not finite", series_style::line,
                             {{1, not_a_number, 1, 2}, {infinity, 1, 1, 2}, {2, 5, not_a_number, 6}, {3, 0, -1, 1}}),
                   series_of("level", series_style::level,
                             {{not_a_number, infinity, 1, 2}, {not_a_number, 4, 3, 5}, {1, 9, 9, 9}})});
    f.y.logarithmic = true;
    SECTION("with numbers on the axes") {
        REQUIRE(aabblab::csv_of(f) ==
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
        REQUIRE(aabblab::csv_of(f) ==
                "number,x,y,low,high,series,x_name\n"
                "1,1,0.1,0.1,0.1,\"a, \"\"b\"\" c\",one\n"
                "1,2,3,1,4,\"a, \"\"b\"\" c\",\"two, too\"\n");
    }
    require_svg(drawn(f).svg);
}

TEST_CASE("What is text to the user is text to gnuplot") {
    // Quotes, a command, a variable, enhanced text, a format, an escape, XML, and UTF-8.
    const std::string text = "'it''s' \"a_b^{c}\" `date` $x @y 5% %g \\n <&amp;> é";
    const std::string in_svg = "'it''s' \"a_b^{c}\" `date` $x @y 5% %g \\n &lt;&amp;amp;> é";
    figure f = figure_of({series_of(text, series_style::points, {{1, 1, 1, 1}})});
    f.caption = text + "\\";
    f.x.label = text;
    // A backslash would take the next line into the comment.
    REQUIRE_THAT(aabblab::script_of(f), !ContainsSubstring("\\\nreset"));
    SECTION("of labels") {
        // Shorter, because it stands along the height.
        f.y.label = "'a_b' `date`";
        f.marks = {{1, text}};
        const std::string svg = drawn(f).svg;
        require_svg(svg);
        REQUIRE(count_of("<text>" + in_svg + "</text>", svg) == 3);
        REQUIRE_THAT(svg, ContainsSubstring("<text>'a_b' `date`</text>"));
    }
    SECTION("of names") {
        f.x.names = {{1, "'a_b' `date` 50%"}};
        f.y.names = {{1, "{a}^b %g"}};
        const std::string svg = drawn(f).svg;
        require_svg(svg);
        REQUIRE_THAT(svg, ContainsSubstring("<text>'a_b' `date` 50%</text>"));
        REQUIRE_THAT(svg, ContainsSubstring("<text>{a}^b %g</text>"));
    }
    SECTION("of long names with a format, for which gnuplot has no room") {
        f.y.names = {{1, "50% " + std::string(40, 'x') + "éééééééééé"}};
        const std::string svg = drawn(f).svg;
        require_svg(svg);
        REQUIRE_THAT(svg, ContainsSubstring("50%"));
        REQUIRE_THAT(svg, ContainsSubstring("\u2026</text>"));
    }
}

TEST_CASE("A long label is broken into lines and keeps every word") {
    std::string words;
    for (int i = 0; i < 30; ++i) words += "word" + std::to_string(i) + ' ';
    const std::string one_word(150, 'w');
    const std::string svg = drawn(figure_of({series_of(words, series_style::line, {{1, 1, 1, 1}}),
                                             series_of(one_word, series_style::line, {{1, 2, 2, 2}})}))
                                .svg;
    require_svg(svg);
    for (int i = 0; i < 30; ++i) REQUIRE_THAT(svg, ContainsSubstring("word" + std::to_string(i)));
    REQUIRE(count_of("w", svg) >= 150);
    REQUIRE_THAT(svg, !ContainsSubstring(std::string(60, 'w')));
}

TEST_CASE("Long names leave room for the plot") {
    const std::string name =
        "compressed:build=sah,leaf_test=triangle_aabb,and=so,on=and,on=for,ever=" + std::string(60, 'x');
    for (const bool on_x : {true, false}) {
        figure f = figure_of({series_of("s", series_style::points, {{1, 1, 1, 1}, {2, 2, 2, 2}})});
        (on_x ? f.x : f.y).names = {{1, name}, {2, name}};
        const std::string script = aabblab::script_of(f);
        const auto margin = [&](const std::string& which) {
            const std::string set = "set " + which + " at screen ";
            return std::stod(script.substr(script.find(set) + set.size()));
        };
        REQUIRE(margin("lmargin") >= 0);
        REQUIRE(margin("rmargin") - margin("lmargin") > 0.3);
        REQUIRE(margin("bmargin") >= 0);
        REQUIRE(margin("tmargin") - margin("bmargin") > 0.15);
        require_svg(drawn(f).svg);
    }
}

TEST_CASE("A figure without anything to show says so") {
    std::vector<figure> empty{figure_of({}), figure_of({series_of("left out", series_style::line, {})}),
                              figure_of({series_of("left out", series_style::level, {{0, -1, -1, -1}})})};
    empty.back().y.logarithmic = true;
    for (const figure& f : empty) {
        const pictures p = drawn(f);
        require_svg(p.svg);
        require_pdf(p.pdf);
        REQUIRE_THAT(p.svg, ContainsSubstring("no data"));
        REQUIRE_THAT(p.svg, !ContainsSubstring("left out"));
    }
}

TEST_CASE("A series without points is left out, and the others look as if it were there") {
    const auto second = series_of("second", series_style::line, {{1, 1, 1, 1}, {2, 2, 2, 2}});
    const figure without = figure_of({series_of("first", series_style::line, {}), second});
    const figure with = figure_of({series_of("first", series_style::line, {{1, 1, 1, 1}}), second});
    const std::string script = aabblab::script_of(without);
    REQUIRE_THAT(script, !ContainsSubstring("style line 1 "));
    const std::size_t begin = script.find("set style line 2 ");
    REQUIRE(begin != std::string::npos);
    REQUIRE_THAT(aabblab::script_of(with), ContainsSubstring(script.substr(begin, script.find('\n', begin) - begin)));
    REQUIRE_THAT(drawn(without).svg, !ContainsSubstring("first"));
}

TEST_CASE("A single point is drawn, on every kind of axis") {
    for (const double y : {0., 3., -2., 1e-200, 1e200})
        for (const bool logarithmic : {false, true})
            for (const auto style : {series_style::line, series_style::points, series_style::level}) {
                figure f = figure_of({series_of("one", style, {{1, y, y, y}})});
                f.y.logarithmic = logarithmic;
                const std::string svg = drawn(f).svg;
                require_svg(svg);
                REQUIRE((svg.find("no data") != std::string::npos) == (logarithmic && y <= 0));
            }
}

TEST_CASE("A logarithmic axis leaves out what is not positive") {
    const std::vector<figure_point> positive{{1, 1, 1, 1}, {10, 100, 50, 200}, {100, 30, 30, 30}};
    std::vector<figure_point> more = positive;
    more.push_back({0, 5, 5, 5});
    more.push_back({-7, 5, 5, 5});
    more.push_back({5, 0, 0, 0});
    more.push_back({5, -3, -4, 5000});
    figure f = figure_of({series_of("points", series_style::points, positive)});
    figure g = figure_of({series_of("points", series_style::points, more)});
    f.x.logarithmic = f.y.logarithmic = g.x.logarithmic = g.y.logarithmic = true;
    g.marks = {{0, "nowhere"}};
    REQUIRE(drawn(f).svg == drawn(g).svg);
    // Of a point that is shown, a quartile that has no place is the end of the axis.
    f.lines[0].points[0].low = -1;
    f.lines[0].points[0].high = 2;
    require_svg(drawn(f).svg);
}

TEST_CASE("Bands and bars show quartiles that differ, and nothing else") {
    const auto script = [](series_style style, double low, double high) {
        return aabblab::script_of(figure_of({series_of("s", style, {{1, 5, low, high}, {2, 5, low, high}})}));
    };
    REQUIRE_THAT(script(series_style::line, 4, 6), ContainsSubstring("filledcurves"));
    REQUIRE_THAT(script(series_style::level, 4, 6), ContainsSubstring("boxxyerror"));
    REQUIRE_THAT(script(series_style::points, 4, 6), ContainsSubstring("column(\"high\") - column(\"low\")"));
    for (const auto style : {series_style::line, series_style::points, series_style::level})
        for (const auto& [low, high] :
             {std::pair(5., 5.), std::pair(6., 4.), std::pair(not_a_number, 6.), std::pair(4., infinity)})
            REQUIRE_THAT(script(style, low, high), !ContainsSubstring("high"));
}

TEST_CASE("Ten series differ in black and white") {
    std::vector<aabblab::series> ten;
    for (int i = 0; i < 10; ++i)
        ten.push_back(series_of("series " + std::to_string(i), series_style::line, {{1, i + 1., i + 1., i + 1.}}));
    const std::string script = aabblab::script_of(figure_of(ten));
    std::set<std::string> dashes;
    std::set<std::string> shapes;
    for (std::size_t at = script.find("dashtype"); at != std::string::npos; at = script.find("dashtype", at + 1)) {
        const std::size_t shape = script.find("pointtype", at);
        if (shape == std::string::npos) break;
        dashes.insert(script.substr(at, shape - at));
        shapes.insert(script.substr(shape, script.find(" pointsize", shape) - shape));
    }
    REQUIRE(dashes.size() == 10);
    REQUIRE(shapes.size() == 10);
}

TEST_CASE("The numbers of an axis are those that people would write") {
    const auto script = [](double least, double greatest, bool logarithmic) {
        figure f = figure_of(
            {series_of("", series_style::line, {{1, least, least, least}, {2, greatest, greatest, greatest}})});
        f.y.logarithmic = logarithmic;
        return aabblab::script_of(f);
    };
    SECTION("on a logarithmic axis") {
        REQUIRE_THAT(script(1, 1e5, true),
                     ContainsSubstring("'10' 10, '' 20 1,") && ContainsSubstring("'100,000' 100000"));
        REQUIRE_THAT(script(1e-7, 1, true),
                     ContainsSubstring("'10^{\u22126}' 1e-06") && ContainsSubstring("'10^{0}' 1"));
        REQUIRE_THAT(script(1e-30, 1e30, true),
                     ContainsSubstring("'10^{\u221220}' 1e-20") && !ContainsSubstring("'10^{21}'"));
        REQUIRE_THAT(script(20, 80, true), ContainsSubstring("('20' 20, '40' 40, '60' 60, '80' 80)"));
        REQUIRE_THAT(script(41, 44, true), ContainsSubstring("'42' 42") && ContainsSubstring("'44' 44"));
    }
    SECTION("on a linear axis") {
        REQUIRE_THAT(script(3, 9, false), ContainsSubstring("'0' 0, '2' 2, '4' 4, '6' 6, '8' 8, '10' 10"));
        REQUIRE_THAT(script(-0.1, 0.25, false), ContainsSubstring("'\u22120.1' -0.1, '0.0' 0, '0.1' 0.1"));
        REQUIRE_THAT(script(1000, 20000, false), ContainsSubstring("'5,000' 5000, '10,000' 10000"));
        REQUIRE_THAT(script(1e8, 3e8, false), ContainsSubstring("'10^{8}' 100000000, '2\u00d710^{8}' 200000000"));
    }
}

TEST_CASE("Points of several series over one name stand side by side") {
    const std::vector<figure_point> points{{1, 1, 1, 1}, {2, 2, 2, 2}};
    figure f = figure_of({series_of("a", series_style::points, points), series_of("b", series_style::points, points)});
    REQUIRE_THAT(aabblab::script_of(f), ContainsSubstring("(x_of(1)):") && ContainsSubstring("(x_of(2)):"));
    f.x.names = {{1, "one"}, {2, "two"}};
    REQUIRE_THAT(aabblab::script_of(f),
                 ContainsSubstring("(x_of(1) -0.075):") && ContainsSubstring("(x_of(2) +0.075):"));
}

TEST_CASE("Without gnuplot there is one sentence, and what it would have drawn from") {
    const temporary_folder folder;
    const environment path("PATH", "");
    const figure f = every_style();
    REQUIRE_THROWS_AS(aabblab::draw(folder.path(), {&f, 1}), aabb::input_error);
    REQUIRE_THROWS_WITH(aabblab::draw(folder.path(), {&f, 1}), ContainsSubstring("gnuplot-nox"));
    REQUIRE(folder.files() == 2);
}

TEST_CASE("What gnuplot says last is why it failed, and half a picture is none") {
    const temporary_folder folder;
    const temporary_folder programs;
    const environment path("PATH", programs.path().string());
    const figure f = every_style();
    write_gnuplot(programs,
                  "echo half >figure1.svg\necho first >&2\necho 'line 5: the reason' >&2\necho >&2\nexit 3\n");
    REQUIRE_THROWS_AS(aabblab::draw(folder.path(), {&f, 1}), aabb::input_error);
    REQUIRE_THROWS_WITH(aabblab::draw(folder.path(), {&f, 1}),
                        EndsWith("figure1.gp: gnuplot fails: line 5: the reason"));
    REQUIRE(folder.files() == 2);
    write_gnuplot(programs, "kill -9 $$\n");
    REQUIRE_THROWS_WITH(aabblab::draw(folder.path(), {&f, 1}), EndsWith("gnuplot was ended by signal 9"));
}

TEST_CASE("gnuplot ends with whoever draws, however that ends") {
    const int signal = GENERATE(SIGKILL, SIGTERM, SIGINT);
    const temporary_folder folder;
    const temporary_folder programs;
    // It takes the place of the shell, so that there is one process.
    write_gnuplot(programs, "echo $$ >pid.part && mv pid.part pid && exec sleep 20\n");
    const environment path("PATH", programs.path().string() + ":" + std::getenv("PATH"));
    const figure f = every_style();
    REQUIRE(prctl(PR_SET_CHILD_SUBREAPER, 1) == 0);  // what it leaves behind becomes ours
    const pid_t drawing = fork();
    if (drawing == 0) {
        std::signal(signal, SIG_DFL);
        aabblab::draw(folder.path(), {&f, 1});
        _exit(0);
    }
    while (!std::filesystem::exists(folder / "pid") && waitpid(drawing, nullptr, WNOHANG) == 0) usleep(1000);
    REQUIRE(kill(drawing, signal) == 0);
    REQUIRE(waitpid(drawing, nullptr, 0) == drawing);
    int status = 0;
    const pid_t gnuplot = std::stoi(bytes_of_file(folder / "pid"));
    REQUIRE(waitpid(gnuplot, &status, 0) == gnuplot);
    REQUIRE(prctl(PR_SET_CHILD_SUBREAPER, 0) == 0);
    REQUIRE(WIFSIGNALED(status));
}

TEST_CASE("A folder that cannot be made is named") {
    const temporary_folder folder;
    folder.write("file", "");
    const figure f = every_style();
    REQUIRE_THROWS_AS(aabblab::draw(folder / "file", {&f, 1}), aabb::input_error);
    REQUIRE_THROWS_WITH(aabblab::draw(folder / "file", {&f, 1}), ContainsSubstring((folder / "file").string()));
}

namespace {

/// Three lines that end so far apart that each can have its label beside it, or so near that they cannot.
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

/// So many panels with two lines and a level, which all have the same labels.
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

TEST_CASE("Lines have their labels at their ends, where they are far enough apart for it") {
    const figure apart = three_lines(10);
    REQUIRE_THAT(aabblab::script_of(apart), ContainsSubstring("unset key") && !ContainsSubstring("set key at"));
    const std::string svg = drawn(apart).svg;
    require_svg(svg);
    require_texts_inside(svg);
    require_texts_apart(svg);
    for (const char* words :
         {">Shell sort</text>", ">insertion sort,</text>", ">axial cut</text>", ">incremental</text>"})
        REQUIRE_THAT(svg, ContainsSubstring(words));
    // From top to bottom as the lines end.
    const auto top_of = [texts = texts_of(svg)](const std::string& text) {
        return std::ranges::find(texts, text, &placed_text::text)->top;
    };
    CHECK(top_of("incremental") < top_of("insertion sort,"));
    CHECK(top_of("axial cut") < top_of("Shell sort"));
}

TEST_CASE("Labels that meet give way a little, and stand in a legend where they would have to give way far") {
    const std::string near = drawn(three_lines(1.3)).svg;
    require_texts_inside(near);
    require_texts_apart(near);
    std::vector<aabblab::series> many;
    for (int i = 0; i < 9; ++i)
        many.push_back(series_of("line " + std::to_string(i), series_style::line, {{1, 1, 1, 1}, {2, 2, 2, 2}}));
    many.push_back(series_of("far", series_style::line, {{1, 1, 1, 1}, {2, 100, 100, 100}}));
    const figure crowded = figure_of(many);
    REQUIRE_THAT(aabblab::script_of(crowded), ContainsSubstring("set key at"));
    require_texts_inside(drawn(crowded).svg);
    // A line that ends before the others has no end there.
    figure early = three_lines(10);
    early.lines[1].points.back().x = 1000;
    REQUIRE_THAT(aabblab::script_of(early), ContainsSubstring("set key at"));
    figure dots = three_lines(10);
    dots.lines[1].style = series_style::points;
    REQUIRE_THAT(aabblab::script_of(dots), ContainsSubstring("set key at"));
}

TEST_CASE("Panels share axes, looks and a legend") {
    for (const std::size_t count : {1, 2, 3, 4, 7}) {
        CAPTURE(count);
        const figure f = small_multiples(count);
        const pictures p = drawn(f);
        require_svg(p.svg);
        require_pdf(p.pdf);
        require_texts_inside(p.svg);
        require_texts_apart(p.svg);
        for (std::size_t i = 0; i < count; ++i)
            CHECK(count_of(">displacement " + std::to_string(i) + "</text>", p.svg) == 1);
        for (const char* once : {"objects", "time a frame (ms)", "Shell sort", "insertion sort"})
            CHECK(count_of(">" + std::string(once) + "</text>", p.svg) == 1);
        CHECK(count_of(">a mark</text>", p.svg) == count);
        const std::string script = aabblab::script_of(f);
        CHECK(count_of("set style line ", script) == 3);
        CHECK(count_of("set xrange", script) == 1);
        CHECK(
            aabblab::csv_of(f).starts_with("number,x,y,low,high,series,panel\n1,,1,1,1,equal,\n"
                                           "2,100,1,1,1,Shell sort,displacement 0\n"));
    }
}

TEST_CASE("No text of a figure is cut off, and no number of an axis runs into the next") {
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
    require_texts_inside(drawn(slanted).svg);
    for (const figure& f : {every_style(), wide, ticks, three_lines(100)}) {
        CAPTURE(f.lines.front().label);
        const std::string svg = drawn(f).svg;
        require_texts_inside(svg);
        require_texts_apart(svg);
    }
}
