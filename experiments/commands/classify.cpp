#include <unistd.h>

#include "command_parser.hpp"

import aabb.pipeline;
import aabb.registry;
import aabblab.configs;
import aabblab.files;
import aabblab.inputs;
import aabblab.pair_output;
import aabblab.progress;

namespace aabblab {

namespace {

struct classify_request {
    std::string file;
    std::string triangle{info_of(aabb::strategy_kind::triangle).fallback};
    bool keep_doubles = false, geometry = false;
};

/// The triangle test of this name, for --geometry; many tests only decide whether there is an intersection.
/// @throws aabb::input_error if the test does not construct intersections, with the names of those that do
std::unique_ptr<aabb::triangle_test> constructing_test(const aabb::strategy_choice& choice) {
    auto test = triangle_test_named(choice);
    if (test->constructs()) return test;
    throw aabb::input_error(
        fmt::format("--geometry: {} decides whether triangles intersect, but does not construct their intersection; "
                    "give --triangle {}",
                    choice.name, fmt::join(constructing_tests(), " or ")));
}

/// The line to print: 0 or 1, or with `geometry` the intersection; `words` are the 18 numbers of the corners.
template <class Real>
std::string result_of(const aabb::triangle_test& test, const std::vector<std::string>& words, bool geometry) {
    if (words.size() != 18)
        throw aabb::input_error(fmt::format("expected 18 numbers, two triangles, not {}", words.size()));
    aabb::triangle3<Real> triangles[2];
    for (std::size_t i = 0; i < 18; ++i)
        triangles[i / 9][static_cast<int>(i % 9 / 3)][static_cast<int>(i % 3)] = parse_number_of<Real>(words, i);
    if (geometry) return to_text(test.intersection(in_double(triangles[0]), in_double(triangles[1]))) + "\n";
    return test.intersects(triangles[0], triangles[1]) ? "1\n" : "0\n";
}

/// Prints the result of each line's pair. A malformed line ends the input with an error, after the earlier results.
void classify_lines(line_stream lines, const aabb::triangle_test& test, const classify_request& request) {
    std::optional<progress> shown;  // results on a terminal show the progress themselves
    if (isatty(STDOUT_FILENO) == 0) shown.emplace("bytes classified", lines.size());
    while (lines.next()) {
        if (shown) shown->update(lines.bytes_read());
        try {
            const std::vector<std::string> words = split_numbers(without_comment(lines.line()));
            if (words.empty()) continue;
            print(request.keep_doubles ? result_of<double>(test, words, request.geometry)
                                       : result_of<float>(test, words, request.geometry));
        } catch (const aabb::input_error& error) {
            lines.fail(error.what());
        }
    }
}

void classify(const classify_request& request) {
    const aabb::strategy_choice choice = aabb::parse_strategy(request.triangle);
    const auto test = request.geometry ? constructing_test(choice) : triangle_test_named(choice);
    if (request.keep_doubles && !test->takes_double())
        throw aabb::input_error("--double: " + choice.name + " tests triangles of floats only");
    classify_lines(request.file == "-" ? line_stream() : line_stream(request.file), *test, request);
}

}  // namespace

void add_classify(const command_parser& program) {
    const command_parser command = program.add_command(
        "classify", "Test whether two triangles intersect, and where: reads a pair per line, writes a result per line");
    auto& request = command.set_action(classify);
    command.argument("FILE", &request.file,
                     "18 numbers per line, the corners of both triangles, decimal or C99 hexadecimal, separated by "
                     "blanks or commas; # begins a comment; - is standard input");
    command.option("--triangle R", &request.triangle,
                   "Triangle test (default exact): a strategy, or a library test that `list` shows");
    command.flag("--double", &request.keep_doubles, "Keep the numbers as doubles instead of rounding to float");
    command.flag("--geometry", &request.geometry,
                 "Write intersections instead of 0 or 1: kind, number of vertices, vertices, error "
                 "bounds on x, y, z");
}

}  // namespace aabblab
