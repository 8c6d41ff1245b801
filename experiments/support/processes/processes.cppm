module;
#include <filesystem>
#include <string>
#include <vector>

/// Other programs, run to their end.
export module aabblab.processes;

export namespace aabblab {

/// Where a program begins; what is empty is ours.
struct surroundings {
    std::filesystem::path folder;
    std::filesystem::path input;
    std::filesystem::path errors;  ///< appended to; /dev/stdout: they go where its output goes
};

/// What a program left.
struct child_result {
    int refused;  ///< errno where it could not be started, otherwise 0
    int status;   ///< of waitpid
    std::string printed;
};

/// Runs a program to its end. It does not outlive the thread that calls this, however that ends.
/// @param program a path, or a name without slashes to be looked up in PATH
[[nodiscard]] child_result run_child(const std::string& program, const std::vector<std::string>& arguments,
                                     const surroundings& where);

}  // namespace aabblab
