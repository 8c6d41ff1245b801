module;
#include <fcntl.h>
#include <poll.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>
// The header of glibc 2.36 lacks extern "C".
extern "C" {
#include <sys/pidfd.h>
}

#include <cerrno>
#include <csignal>
#include <cstdlib>

module aabblab.processes;

import aabb.base;
import aabblab.output;

namespace aabblab {

namespace {

/// A pipe; exec closes both ends in a child (O_CLOEXEC) unless they are passed to it.
struct pipe_ends {
    std::array<int, 2> ends{-1, -1};

    pipe_ends() = default;
    pipe_ends(const pipe_ends&) = delete;
    pipe_ends& operator=(const pipe_ends&) = delete;
    ~pipe_ends() {
        close_end(0);
        close_end(1);
    }
    [[nodiscard]] bool open() { return pipe2(ends.data(), O_CLOEXEC) == 0; }
    void close_end(std::size_t which) {
        if (const int end = std::exchange(ends[which], -1); end >= 0) close(end);
    }
};

/// Redirects a standard stream to a file; does nothing if the name is empty.
[[nodiscard]] bool redirect(const char* file, int flags, int place) {
    if (*file == 0) return true;
    const int opened = open(file, flags | O_CLOEXEC, 0666);
    return opened >= 0 && dup2(opened, place) >= 0;
}

// Between fork and exec: async-signal-safe functions only.

/// Makes the kernel send this process a signal when its parent ends.
void request_signal_at_end_of(pid_t parent, int signal) {
    prctl(PR_SET_PDEATHSIG, signal);
    if (getppid() != parent) _exit(127);  // the parent has already ended
}

/// Becomes the program, with streams, folder and default signal handling; returns only if that fails, with errno.
/// @param output the descriptor that receives what the program prints
void exec_program(char* const* arguments, const process_options& options, int output) {
    if (dup2(output, STDOUT_FILENO) < 0 || !redirect(options.input.c_str(), O_RDONLY, STDIN_FILENO) ||
        !redirect(options.errors.c_str(), O_WRONLY | O_CREAT | O_APPEND, STDERR_FILENO) ||
        (!options.folder.empty() && chdir(options.folder.c_str()) != 0))
        return;
    std::signal(SIGINT, SIG_DFL);
    std::signal(SIGPIPE, SIG_DFL);
    execvp(*arguments, arguments);
}

/// Kills all children until none is left: their own children become children of this process, as it is their subreaper.
/// The kernel lists children as numbers, each with a blank after it.
void kill_descendants() {
    std::array<char, 4096> list{};
    for (;;) {
        const int file = open("/proc/thread-self/children", O_RDONLY | O_CLOEXEC);
        const ssize_t size = file < 0 ? -1 : read(file, list.data(), list.size());
        if (file >= 0) close(file);
        if (size <= 0) return;
        pid_t child = 0;
        for (ssize_t i = 0; i < size; ++i) {
            const char c = list[static_cast<std::size_t>(i)];
            if (c >= '0' && c <= '9') {
                child = 10 * child + (c - '0');
            } else {
                kill(child, SIGKILL);
                child = 0;
            }
        }
        while (waitpid(-1, nullptr, 0) < 0 && errno == EINTR) continue;
    }
}

/// Waits until the program, a child, ends, or until this process gets SIGTERM.
/// @param awaited all signals, which must be blocked
/// @returns the status of the program as from waitpid
int wait_for_program(pid_t program, const sigset_t& awaited) {
    int status = 0;
    for (pid_t ended = 0; ended != program;) {
        if (sigwaitinfo(&awaited, nullptr) == SIGTERM) return SIGTERM;  // as if this signal had ended the program
        while (ended != program && (ended = waitpid(-1, &status, WNOHANG)) > 0) continue;
    }
    return status;
}

/// Ends this process in the way that a status from waitpid describes: with an exit status, or by a signal.
[[noreturn]] void end_like(int status) {
    if (!WIFSIGNALED(status)) _exit(WEXITSTATUS(status));
    prctl(PR_SET_DUMPABLE, 0);  // avoid a core dump of this process
    std::signal(WTERMSIG(status), SIG_DFL);
    sigset_t none;
    sigemptyset(&none);
    sigprocmask(SIG_SETMASK, &none, nullptr);
    kill(getpid(), WTERMSIG(status));
    _exit(127);  // not reached
}

/// Forks a process that will become the program, and makes this process its keeper: it waits until the program ends, or
/// until SIGTERM, which the end of the parent also causes. It then kills all descendants, in any session, so that none
/// outlives a timeout, and ends like the program.
/// @param output, start_errors pipes to the parent, which the keeper closes, as only the program writes to them
/// @returns true in the new process; false if fork fails; the keeper never returns
[[nodiscard]] bool fork_under_keeper(int output, int start_errors, pid_t parent) {
    sigset_t awaited, before;
    sigfillset(&awaited);
    sigprocmask(SIG_SETMASK, &awaited, &before);
    request_signal_at_end_of(parent, SIGTERM);
    prctl(PR_SET_CHILD_SUBREAPER, 1);
    setpgid(0, 0);
    const pid_t keeper = getpid();
    const pid_t program = fork();
    if (program < 0) return false;
    if (program == 0) {
        request_signal_at_end_of(keeper, SIGKILL);
        setpgid(0, 0);  // so that the keeper does not get signals to its group
        sigprocmask(SIG_SETMASK, &before, nullptr);
        return true;
    }
    close(output);
    close(start_errors);
    const int status = wait_for_program(program, awaited);
    kill_descendants();
    end_like(status);
}

/// Ends at the end of its standard input, which all keepers hold open, too.
constexpr const char* guard_script = "trap '' HUP INT TERM; read -r end; rm -rf -- \"$1\"";

/// Like `exec_program`, for the guard; its output goes to /dev/null so that readers of ours do not wait for it.
[[noreturn]] void exec_guard(int input, const char* folder) {
    setpgid(0, 0);
    if (dup2(input, STDIN_FILENO) >= 0 && redirect("/dev/null", O_WRONLY, STDOUT_FILENO) &&
        redirect("/dev/null", O_WRONLY, STDERR_FILENO))
        execl("/bin/sh", "sh", "-c", guard_script, "sh", folder, nullptr);
    _exit(127);
}

using clock = std::chrono::steady_clock;

/// Waits until input or its end arrives; false if `end` comes first. Without `end`, true: the read then waits.
bool becomes_readable(int input, const std::optional<clock::time_point>& end) {
    pollfd request{input, POLLIN, /*revents=*/0};
    while (end) {
        const auto left = std::chrono::ceil<std::chrono::milliseconds>(*end - clock::now()).count();
        if (left <= 0) return false;
        constexpr std::int64_t longest = std::numeric_limits<int>::max();
        if (poll(&request, 1, static_cast<int>(std::min<std::int64_t>(left, longest))) > 0) break;
    }
    return true;
}

/// Reads from a pipe until its other end closes, or until that time; without a time as long as it takes.
std::string read_all(int input, const std::optional<clock::time_point>& end = {}) {
    std::string text;
    std::array<char, 4096> part{};
    for (;;) {
        if (!becomes_readable(input, end)) return text;
        const ssize_t count = read(input, part.data(), part.size());
        if (count > 0)
            text.append(part.data(), static_cast<std::size_t>(count));
        else if (count == 0 || errno != EINTR)
            return text;
    }
}

/// Waits until a child process ends, or until that time.
/// @returns whether it may be waited for without a limit: it has ended, or has no handle by which to observe its end
bool ends_before(pid_t child, clock::time_point end) {
    const int handle = pidfd_open(child, 0);
    if (handle < 0) return true;
    const bool ended = becomes_readable(handle, end);
    close(handle);
    return ended;
}

}  // namespace

/// Runs a program in a child process, until it ends or the timeout of the options, and collects what it prints. Through
/// a second pipe the child reports the errno if the program could not be started.
program_result run_child(const std::string& program, const std::vector<std::string>& arguments,
                         const process_options& options) {
    std::vector<std::string> texts{program};
    texts.insert(texts.end(), arguments.begin(), arguments.end());
    std::vector<char*> pointers;
    for (std::string& text : texts) pointers.push_back(text.data());
    pointers.push_back(nullptr);
    pipe_ends output, start_errors;
    if (!output.open() || !start_errors.open()) return {.start_error = errno};
    const pid_t parent = getpid();
    const pid_t child = fork();
    if (child < 0) return {.start_error = errno};
    if (child == 0) {
        if (!options.has_keeper) request_signal_at_end_of(parent, SIGKILL);
        if (!options.has_keeper || fork_under_keeper(output.ends[1], start_errors.ends[1], parent))
            exec_program(pointers.data(), options, output.ends[1]);
        const int why = errno;
        _exit(write(start_errors.ends[1], &why, sizeof why) < 0 ? 126 : 127);  // as a shell does
    }
    output.close_end(1);
    start_errors.close_end(1);
    program_result result{};
    // If the program starts, exec closes the other end, and nothing is read.
    if (const std::string why = read_all(start_errors.ends[0]); why.size() == sizeof result.start_error)
        std::memcpy(&result.start_error, why.data(), why.size());
    std::optional<clock::time_point> end;
    if (options.timeout.count() > 0) end = clock::now() + options.timeout;
    result.printed = read_all(output.ends[0], end);
    // A program may close its output before it ends.
    result.timed_out = end && !ends_before(child, *end);
    // On SIGTERM the keeper kills the program and all its descendants.
    if (result.timed_out) kill(child, options.has_keeper ? SIGTERM : SIGKILL);
    while (waitpid(child, &result.status, 0) < 0 && errno == EINTR) continue;
    return result;
}

/// Runs a program and returns its exit status, 0 or 1 (a failed check), and the lines that it prints.
/// @param log file for its standard error
/// @throws aabb::input_error on any other status, or if the program cannot be started
ended_process run_to_end(const std::filesystem::path& program, const std::vector<std::string>& arguments,
                         const std::filesystem::path& log) {
    flush_output();
    const program_result ended = run_child(program.string(), arguments, {.errors = log});
    if (ended.start_error != 0)
        throw aabb::input_error(program.string() + " cannot be started: " + std::strerror(ended.start_error));
    const int status = ended.status;
    if (!WIFEXITED(status) || WEXITSTATUS(status) > 1)
        throw aabb::input_error(program.filename().string() +
                                (WIFEXITED(status) ? " ended with status " + std::to_string(WEXITSTATUS(status))
                                                   : " was ended by signal " + std::to_string(WTERMSIG(status))) +
                                (log.empty() ? "" : ", see " + log.string()) +
                                "; what is finished is kept, and the same command continues");
    ended_process result{WEXITSTATUS(status), {}};
    std::istringstream printed(ended.printed);
    for (std::string line; std::getline(printed, line);) result.lines.push_back(line);
    return result;
}

/// Runs this program with other arguments in a new process and returns what it prints: one failure per line.
/// @throws aabb::input_error if it fails without saying why
std::vector<std::string> lines_of_own_process(const std::vector<std::string>& arguments) {
    // This link leads to the running program, even if its file has been replaced by another build.
    ended_process ended = run_to_end("/proc/self/exe", arguments, {});
    if (ended.status != 0 && ended.lines.empty())
        throw aabb::input_error("a process of " + arguments[1] +
                                " failed; what is finished is kept, and the same command continues");
    return std::move(ended.lines);
}

std::filesystem::path own_folder() {
    return std::filesystem::read_symlink("/proc/self/exe").parent_path();
}

std::filesystem::path make_temporary_folder(std::string_view need) {
    std::error_code error;
    std::string name = (std::filesystem::temp_directory_path(error) / ("aabblab-" + std::string(6, 'X'))).string();
    if (error || !mkdtemp(name.data()))
        throw aabb::input_error(std::string(need) + ": there is no folder for temporary files (TMPDIR)");
    return name;
}

/// Forks a guard process that removes the folder as soon as a pipe from this process closes, which the kernel does
/// however this process ends. `held_` is the end of the pipe that keeps it open.
folder_guard::folder_guard(std::filesystem::path folder) : folder_(std::move(folder)) {
    pipe_ends life;
    if (!life.open()) return;
    guard_ = fork();
    if (guard_ < 0) return;
    if (guard_ == 0) exec_guard(life.ends[0], folder_.c_str());
    held_ = std::exchange(life.ends[1], -1);
}

folder_guard::~folder_guard() {
    if (held_ >= 0) close(held_);
    while (guard_ > 0 && waitpid(guard_, nullptr, 0) < 0 && errno == EINTR) continue;
    std::error_code ignored;
    std::filesystem::remove_all(folder_, ignored);
}

}  // namespace aabblab
