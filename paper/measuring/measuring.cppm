/// The reproduction from its configs to its report: what is measured, and where it leaves what.
export module aabblab.measuring;

import aabb.std;
import aabblab.configs;
import aabblab.reproduction;

export namespace aabblab {

struct reproduce_request {
    std::optional<std::string> out;
    std::optional<std::string> archive;  ///< to be written, of what was judged
    std::vector<std::string> sources;    ///< folders and archives to judge, in place of the one of `out`
    bool quick = false;
    bool judge = false;  ///< results that are there
};

/// Measures, judges and reports, and prints the verdicts.
/// @returns the exit status: 1 where anything is wrong
/// @throws aabb::input_error where results are not there, are damaged or do not go together.
[[nodiscard]] int reproduce(const reproduce_request& request);

}  // namespace aabblab
