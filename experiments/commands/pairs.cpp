#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <cstddef>
#include <memory>
#include <numeric>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "command_parser.hpp"
#include "commands.hpp"
#include "output.hpp"

// Imports, so it comes last.
#include "composing.hpp"

import aabb.base;
import aabb.digest;
import aabb.pipeline;
import aabb.policy;
import aabb.registry;
import aabb.selection;
import aabb.validation;
import aabblab.digits;
import aabblab.files;
import aabblab.numbers;
import aabblab.pair_output;
import aabblab.trials;
import aabblab.progress;

namespace aabblab {

namespace {

struct pairs_request {
    std::string recording;
    stage_options global{aabb::stage::global_search};
    std::optional<std::string> engine, out;
    bool json = false;
};

struct search_method {
    std::string name;
    bool exact;
    std::unique_ptr<aabb::global_stage> stage;
};

struct search_result {
    std::size_t objects = 0;
    std::size_t pairs = 0;
    std::string digest;
    std::vector<double> milliseconds;  ///< of update and search, by frame
};

search_method method_of(const pairs_request& request, const aabb::scene_outlook& outlook) {
    if (request.engine) {
        if (request.global.any())
            throw aabb::input_error("--engine stands in for " + request.global.names() + ", so give it alone");
        return {*request.engine, aabb::is_exact_engine(*request.engine), aabb::make_box_engine(*request.engine)};
    }
    aabb::named_strategies named;
    request.global.add_to(named);
    const aabb::composition composition = select_composition(named, outlook);
    return {aabb::to_text(composition, aabb::stage::global_search),
            aabb::is_exact(composition, aabb::stage::global_search),
            aabb::compose_global_search(composition, aabb::instrumentation::none)};
}

search_result search_all(scene_play& scene, search_method& method, std::optional<number_table>& table) {
    search_result result;
    result.objects = scene.objects();
    player who({std::move(method.stage), nullptr}, scene);
    progress shown("frames searched", scene.frames());
    aabb::digest digest;
    play(scene, who, [&](const played_frame& frame) {
        result.milliseconds.push_back(whole_nanoseconds(frame.ms()));
        require_each_once(frame.pairs, fmt::format("{}, frame {}", method.name, frame.number));
        digest.add(frame.number, frame.pairs);
        if (table)
            for (const auto [a, b] : frame.pairs) table->add({frame.number, a, b});
        result.pairs += frame.pairs.size();
        shown.at(frame.number + 1);
    });
    result.digest = digest.text();
    return result;
}

void print_json(const search_method& method, const search_result& result) {
    const nlohmann::ordered_json summary = {{"objects", result.objects}, {"frames", result.milliseconds.size()},
                                            {"pairs", result.pairs},     {"digest", result.digest},
                                            {"ms", result.milliseconds}, {"method", method.name},
                                            {"exact", method.exact}};
    print(summary.dump() + "\n");
}

void print_text(const pairs_request& request, const search_method& method, const search_result& result) {
    print(fmt::format("{}: {}, {}\n", visible(request.recording), counted(result.objects, "object"),
                      counted(result.milliseconds.size(), "frame")));
    print(fmt::format("{}, digest {}\n", counted(result.pairs, "overlapping pair"), result.digest));
    if (!result.milliseconds.empty())
        // A list of neighbours serves most frames, and is made in a few.
        print(fmt::format("{}{}: {:.4g} ms a frame (mean)\n", method.name, method.exact ? "" : " (inexact)",
                          std::accumulate(result.milliseconds.begin(), result.milliseconds.end(), 0.0) /
                              static_cast<double>(result.milliseconds.size())));
}

void find_pairs(const pairs_request& request) {
    // What makes no sense is refused before anything is read.
    static_cast<void>(method_of(request, {}));
    scene_play scene(open_recording(request.recording));
    search_method method = method_of(request, outlook_of(scene));
    std::optional<number_table> table;
    if (request.out) {
        require_other_file(*request.out, {&request.recording, 1});
        table.emplace(*request.out, "frame,a,b");
    }
    const search_result result = search_all(scene, method, table);
    if (table) table->commit();
    if (request.json)
        print_json(method, result);
    else
        print_text(request, method, result);
}

}  // namespace

void add_pairs(const command_parser& program, int&) {
    const command_parser command =
        program.add_command("pairs", "Global search on a recording: every pair of overlapping boxes");
    auto request = std::make_shared<pairs_request>();
    command.add_option("SCENE", request->recording, "Recording of boxes (.aabbs)").required().type_name("");
    request->global.add_to(command);
    command.add_option("--engine", request->engine, "Reference system in place of all of these").type_name("E");
    command.add_option("--out", request->out, "Write the pairs, rows frame,a,b, to this CSV file").type_name("FILE");
    command.add_flag("--json", request->json, "Print the summary as JSON");
    command.callback([request] { find_pairs(*request); });
}

}  // namespace aabblab
