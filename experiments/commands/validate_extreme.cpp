#include "command_parser.hpp"

import aabb.extreme;
import aabblab.extreme;
import aabblab.suites;

namespace aabblab {

namespace {

struct extreme_request {
    std::string cases = default_cases();
    std::optional<std::string> out;
    bool quick = false;
};

int validate_extreme(const extreme_request& request) {
    outlive_reader();
    const std::filesystem::path folder =
        request.out.value_or(request.quick ? "results/extreme-quick" : "results/extreme");
    const suite_report report = run_extreme_suite(folder, request.cases, request.quick, /*shown=*/true);
    print("\nEvery result is in " + visible((folder / "extreme.csv").string()) + "\n");
    print(report.failures.empty()
              ? "Everything that must be exact is exact, and everything that must be rejected is rejected.\n"
              : std::to_string(report.failures.size()) + " results are not as expected.\n");
    return report.failures.empty() ? 0 : 1;
}

}  // namespace

void add_validate_extreme(const command_parser& program) {
    const command_parser command =
        program.command("validate")
            .add_command("extreme", "Validate extreme scenes, invalid input, rounding modes and hard triangle pairs");
    command.footer([] {
        std::string text = "Scenes (pairs_*: triangle pairs); results must be exact unless 'rejected':\n";
        for (const aabb::extreme_scene& scene : all_extreme_scenes(aabb::extreme_size::full).scenes)
            text += entry(scene.name, scene.summary + (scene.rejection.empty() ? "" : ": rejected"));
        return text.substr(0, text.size() - 1);  // the parser prints the last line end
    });
    auto& request = command.set_action(validate_extreme);
    command.option("--cases FILE", &request.cases, "Pairs of triangles (default validation/cases/triangles.toml)");
    command.option("--out DIR", &request.out,
                   "Folder of extreme.csv (default results/extreme, with --quick results/extreme-quick)");
    command.flag("--quick", &request.quick, "Use only default parameters, and fewer coincident triangles");
}

}  // namespace aabblab
