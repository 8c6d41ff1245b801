/// The reproduction from its configs to its report.
export module aabblab.measuring;

import aabb.std;
import aabblab.configs;
import aabblab.reproduction;

export namespace aabblab {

struct reproduce_request {
    std::optional<std::string> out;
    std::optional<std::string> archive;  ///< to be written, with the judged results
    std::vector<std::string> sources;    ///< folders and archives to judge instead of `out`
    bool quick = false;
    bool judge = false;  ///< judge existing results
};

/// Measures, judges and reports, and prints the verdicts.
/// @returns the exit status: 1 if anything is wrong
/// @throws aabb::input_error if results are missing, damaged or incompatible.
[[nodiscard]] int reproduce(const reproduce_request& request);

/// The output of Google Benchmark without the line that names the program with the folder where this machine has it.
[[nodiscard]] std::string without_path_of_program(std::string times);

}  // namespace aabblab
