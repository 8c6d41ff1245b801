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
    int group = 0;                 ///< of processes, which it joins with all that it starts
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

/// A folder and a group of processes that end with this: the folder is removed, the processes are killed. So it is too
/// where this process ends, by whatever signal.
class folder_guard {
public:
    /// @param folder that is there, and is nobody else's
    explicit folder_guard(std::filesystem::path folder);
    folder_guard(const folder_guard&) = delete;
    folder_guard& operator=(const folder_guard&) = delete;
    ~folder_guard();

    /// For `surroundings`.
    [[nodiscard]] int group() const { return guard_; }

private:
    std::filesystem::path folder_;
    int held_ = -1;  // an end of a pipe, which closes with this process
    int guard_ = 0;  // waits for that; 0 where it could not be started
};

}  // namespace aabblab
