/// Other programs, run to their end.
export module aabblab.processes;

import aabb.std;

export namespace aabblab {

/// Where a program begins; what is empty is ours.
struct surroundings {
    std::filesystem::path folder;
    std::filesystem::path input;
    std::filesystem::path errors;     ///< appended to; /dev/stdout: they go where its output goes
    bool kept = false;                ///< apart from the terminal, and killed at its end with all that it starts
    std::chrono::seconds timeout{0};  ///< after which it is killed; 0: never
};

struct child_result {
    int refused;     ///< errno where it could not be started, otherwise 0
    int status;      ///< of waitpid
    bool timed_out;  ///< it was killed; what it started lives on, unless it was kept
    std::string printed;
};

/// Runs a program to its end. It does not outlive the calling thread, however that ends, nor, if kept, what it starts.
/// @param program a path, or a name without slashes to be looked up in PATH
[[nodiscard]] child_result run_child(const std::string& program, const std::vector<std::string>& arguments,
                                     const surroundings& where);

/// What a program that ended by itself left.
struct ended_process {
    int status;
    std::vector<std::string> lines;  ///< that it printed
};

/// Runs a program to its end, which it must reach by itself. What we have printed so far comes before what it says.
/// @param log of what it says on standard error; empty: goes to ours
/// @throws aabb::input_error where it cannot be run, or ends otherwise than with 0 or 1.
[[nodiscard]] ended_process run_to_end(const std::filesystem::path& program, const std::vector<std::string>& arguments,
                                       const std::filesystem::path& log);

/// This program started afresh, which must print a line for all that is wrong.
/// @throws aabb::input_error also where it ends with 1 and has not said why.
[[nodiscard]] std::vector<std::string> lines_of_own_process(const std::vector<std::string>& arguments);

[[nodiscard]] std::filesystem::path own_folder();

/// A folder that is removed with this, and with this process, by whatever signal it ends.
class folder_guard {
public:
    /// @param folder that is there, and is nobody else's
    explicit folder_guard(std::filesystem::path folder);
    folder_guard(const folder_guard&) = delete;
    folder_guard& operator=(const folder_guard&) = delete;
    ~folder_guard();

    [[nodiscard]] const std::filesystem::path& folder() const { return folder_; }

private:
    std::filesystem::path folder_;
    int held_ = -1;   // an end of a pipe, which closes with this process and those that keep programs for it
    int guard_ = -1;  // the process that waits for that; less than 0 where it could not be started
};

}  // namespace aabblab
