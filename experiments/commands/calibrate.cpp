#include "command_parser.hpp"

import aabb.costs;
import aabblab.calibrate;
import aabblab.configs;
import aabblab.files;
import aabblab.processor;
import aabblab.stopwatch;
import aabblab.tables;

namespace aabblab {

namespace {

struct calibrate_request {
    std::optional<std::string> out;
    bool quick = false, reset = false;
};

/// The fitted costs ("here") with 95 % intervals beside those that the program ships with (`cost_model`).
table table_of(const calibration& fit) {
    table t = empty_table({"cost", "unit"}, {"shipped", "here", "95 %"});
    for (std::size_t k = 0; k < aabb::cost_infos.size(); ++k) {
        const aabb::cost_info& cost = aabb::cost_infos[k];
        const auto [low, high] = fit.estimates[k].range();
        t.rows.push_back(
            {std::string(cost.name), std::string(cost.unit), fmt::format("{:.3g}", aabb::cost_model{}.*cost.value),
             fmt::format("{:.3g}", fit.costs.*cost.value), fmt::format("{:.3g}-{:.3g}", std::max(0.0, low), high)});
    }
    return t;
}

/// How far the fitted costs mispredict the times of held-out scenes.
table checks_of(const calibration& fit) {
    table t = empty_table({"predictions for held-out scenes"}, {"count", "median error factor", "worst"});
    for (const group_check& check : fit.checks)
        t.rows.push_back({std::string(check.group), std::to_string(check.held_out.observations),
                          fmt::format("{:.2f}", check.held_out.median), fmt::format("{:.2f}", check.held_out.worst)});
    return t;
}

/// Measures the costs of operations and stores them for commands, or in --out; or with --reset removes stored ones.
void calibrate(const calibrate_request& request) {
    const std::filesystem::path file = request.out ? std::filesystem::path(*request.out) : calibrated_costs_file();
    if (file.empty())
        throw aabb::input_error("neither XDG_CONFIG_HOME nor HOME names a folder; give --out FILE for the costs");
    if (request.reset)
        return print(std::filesystem::remove(file) ? "removed " + file.string() + ": the shipped costs are used\n"
                                                   : file.string() + " does not exist: the shipped costs are used\n");
    require_fine_clock();
    // An existing file is overwritten only if it is a file of costs.
    if (request.out && std::filesystem::is_regular_file(file) && std::filesystem::file_size(file) > 0)
        (void)read_costs(file);
    // Opened before measuring, so that an output error is reported without delay.
    if (file.has_parent_path()) std::filesystem::create_directories(file.parent_path());
    output_file out(file);
    const idlest_processor pinned;
    const calibration fit = request.quick ? calibrate(calibration_size::quick, /*seconds=*/12)
                                          : calibrate(calibration_size::full, /*seconds=*/95);
    const calibrated_costs kept = label_costs(fit.costs);
    out.write(text_of(kept));
    out.commit();
    print(kept.processor + ", " + kept.instructions + "; costs are processor times\n\n");
    print(to_text(table_of(fit), output_width()) + "\n");
    print(to_text(checks_of(fit), output_width()) + "\n");
    print("wrote " + file.string() +
          (request.out ? "\n" : ", which commands use from now on;\naabblab calibrate --reset removes it\n"));
}

}  // namespace

void add_calibrate(const command_parser& program) {
    const command_parser command = program.add_command("calibrate",
                                                       "Measure the costs of elementary operations on this machine, "
                                                       "and store them for the strategies' cost estimates");
    auto& request = command.set_action<calibrate_request>(calibrate);
    const parsed_option quick = command.flag("--quick", &request.quick, "Take about 20 seconds instead of two minutes");
    const parsed_option out = command.option(
        "--out FILE", &request.out, "Write the costs to this file only; strategies keep using the stored ones");
    command.flag("--reset", &request.reset, "Remove the stored costs: the shipped ones are used again")
        .excludes(quick)
        .excludes(out);
}

}  // namespace aabblab
