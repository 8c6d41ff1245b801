#include "command_parser.hpp"

import aabblab.files;
import aabblab.inputs;
import aabblab.numbers;
import aabblab.progress;

namespace aabblab {

namespace {

struct convert_request {
    std::string from, to;
};

/// Writes the boxes of a file in the format of another ending.
void convert(const convert_request& request) {
    if (!is_file_of_boxes(request.to))
        throw aabb::input_error(request.to + ": expected the ending .aabbs, .csv or .npy, which decides the format");
    require_other_file(request.to, request.from);
    const auto scene = open_boxes(request.from);
    const std::size_t objects = scene->objects(), frames = scene->frames();
    progress shown("frames converted", frames);
    write_boxes(*scene, request.to, [&](std::size_t done) { shown.update(done); });
    print(fmt::format("{}: {}, {}, {}\n", visible(request.to), counted(objects, "object"), counted(frames, "frame"),
                      scene->in_double().empty() ? "floats" : "doubles"));
}

}  // namespace

void add_convert(const command_parser& program) {
    const command_parser command =
        program.add_command("convert", "Convert boxes between recordings (.aabbs), tables (.csv) and arrays (.npy)");
    auto& request = command.set_action(convert);
    command.argument(
        "FROM", &request.from,
        "Boxes: a recording (.aabbs); rows of [[frame,] object,] min x, y, z, max x, y, z (.csv); an array "
        "of the shape ([frames,] objects, 6) or ([frames,] objects, 2, 3) (.npy)");
    command.argument("TO", &request.to, "The file to write; its ending decides the format");
}

}  // namespace aabblab
