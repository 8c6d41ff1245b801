#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "output.hpp"

#include "error_studies.hpp"

import aabblab.configs;
import aabblab.errors;
import aabblab.files;
import aabblab.results;
import aabblab.tables;

namespace aabblab {

namespace {

void print_tables(std::span<const error_point> points) {
    for (const pair_group group : groups_in(points)) {
        print(
            fmt::format("In {}: shares of pairs with a wrong answer, of\nintersecting ones that were missed, of others "
                        "that were invented; fewest wrong first\n\n{}\n",
                        title_of(group), to_text(error_summary(points, group), output_width())));
        print(fmt::format("By set, missed + invented as shares of all pairs\n\n{}\n",
                          to_text(errors_by_set(points, group), output_width())));
        print(group_statement(points, group) + "\n\n");
    }
}

}  // namespace

std::vector<std::filesystem::path> error_configs() {
    std::vector<std::filesystem::path> all;
    for (const auto& file : std::filesystem::directory_iterator(AABBLAB_ERROR_CONFIGS))
        if (file.path().extension() == ".toml") all.push_back(file.path());
    std::ranges::sort(all);
    return all;
}

std::vector<std::string> measure_study(const error_study& study, const std::filesystem::path& folder, printed shown) {
    std::vector<std::string> failures;
    std::filesystem::create_directories(folder);
    if (study.whole) {
        failures = play_experiment(*study.whole, folder, existing_results::replace, "the same command", shown);
        if (shown != printed::nothing)
            for (const std::string& text : metric_statements(study, summarise(read_rows(folder / "results.csv"))))
                print(text + "\n\n");
    } else {
        const std::vector<error_point> points = measure_errors(study);
        write_file(folder / "errors.csv", to_csv(error_rows(points)));
        if (shown != printed::nothing) print_tables(points);
    }
    write_file(folder / "config.toml", study.text);
    return failures;
}

}  // namespace aabblab
