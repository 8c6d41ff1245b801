/// Runs other programs to their end.
export module aabblab.processes;

import aabb.std;

export namespace aabblab {

/// How a program runs; what is empty is inherited from this process.
struct process_options {
    std::filesystem::path folder = {}, input = {};
    std::filesystem::path errors = {};  ///< appended to; with /dev/stdout errors are part of the output
    bool has_keeper = false;            ///< detached from the terminal; all descendants are killed at its end
    std::chrono::seconds timeout{0};    ///< time until it is killed; 0 for none
};

struct program_result {
    int start_error = 0;     ///< errno if it could not be started, otherwise 0
    int status = 0;          ///< of waitpid
    bool timed_out = false;  ///< it was killed; its descendants survive unless it had a keeper
    std::string printed = {};
};

/// Runs a program to its end. Neither it nor, with a keeper, any descendant ever outlives the calling thread.
/// @param program a path, or a name without slashes to be looked up in PATH
[[nodiscard]] program_result run_child(const std::string& program, const std::vector<std::string>& arguments,
                                       const process_options& options);

struct ended_process {
    int status;
    std::vector<std::string> lines;  ///< its output
};

/// Runs a program that must exit normally. Flushes our output first, so that it precedes the program's.
/// @param log the file for its standard error; if empty, inherits ours
/// @throws aabb::input_error if it cannot be started, or if its exit status is not 0 or 1.
[[nodiscard]] ended_process run_to_end(const std::filesystem::path& program, const std::vector<std::string>& arguments,
                                       const std::filesystem::path& log);

/// Runs this program in a new process, which must print one line per failure.
/// @throws aabb::input_error also if it ends with 1 and has printed nothing.
[[nodiscard]] std::vector<std::string> lines_of_own_process(const std::vector<std::string>& arguments);

[[nodiscard]] std::filesystem::path own_folder();

/// Makes a temporary folder, below TMPDIR, which only the user can access.
/// @param need begins the message: "an archive cannot be unpacked"
/// @throws aabb::input_error if there is no folder for temporary files.
[[nodiscard]] std::filesystem::path make_temporary_folder(std::string_view need);

/// Owns a temporary folder: removes it on destruction, and also if this process is killed by any signal.
class folder_guard {
public:
    /// @param folder an existing folder that is not used otherwise
    explicit folder_guard(std::filesystem::path folder);
    folder_guard(const folder_guard&) = delete;
    folder_guard& operator=(const folder_guard&) = delete;
    ~folder_guard();

    [[nodiscard]] const std::filesystem::path& folder() const { return folder_; }

private:
    std::filesystem::path folder_;
    int held_ = -1;   // an end of a pipe, which closes when this process and its keepers have ended
    int guard_ = -1;  // the process that waits for that; negative if it could not be started
};

}  // namespace aabblab
