#include "process.hpp"

#include <fcntl.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include "output.hpp"

import aabb;

namespace aabblab {

namespace {

[[noreturn]] void become(const char* program, const std::vector<char*>& arguments, int output, const char* log,
                         pid_t parent) {
    // Between fork and exec only what a signal handler may call.
    prctl(PR_SET_PDEATHSIG, SIGKILL);
    if (getppid() != parent || dup2(output, STDOUT_FILENO) < 0) _exit(127);
    if (*log != 0) {
        const int file = open(log, O_WRONLY | O_CREAT | O_APPEND | O_CLOEXEC, 0666);
        if (file < 0 || dup2(file, STDERR_FILENO) < 0) _exit(127);
    }
    std::signal(SIGINT, SIG_DFL);
    std::signal(SIGPIPE, SIG_DFL);
    execv(program, arguments.data());
    _exit(127);
}

std::string all_of(int input) {
    std::string text;
    std::array<char, 4096> part{};
    for (ssize_t got = 0; (got = read(input, part.data(), part.size())) != 0;) {
        if (got > 0)
            text.append(part.data(), static_cast<std::size_t>(got));
        else if (errno != EINTR)
            break;
    }
    return text;
}

int status_of(pid_t child) {
    int status = 0;
    while (waitpid(child, &status, 0) < 0 && errno == EINTR) {
    }
    return status;
}

}  // namespace

ended_process run_to_end(const std::filesystem::path& program, const std::vector<std::string>& arguments,
                         const std::filesystem::path& log) {
    std::string path = program.string();
    std::vector<std::string> texts{path};
    texts.insert(texts.end(), arguments.begin(), arguments.end());
    std::vector<char*> pointers;
    for (std::string& text : texts) pointers.push_back(text.data());
    pointers.push_back(nullptr);
    std::array<int, 2> ends{};
    if (pipe2(ends.data(), O_CLOEXEC) != 0)
        throw aabb::input_error(path + " cannot be started: " + std::strerror(errno));
    flush_output();
    const pid_t parent = getpid();
    const pid_t child = fork();
    if (child == 0) become(path.c_str(), pointers, ends[1], log.c_str(), parent);
    close(ends[1]);
    if (child < 0) throw aabb::input_error(path + " cannot be started: " + std::strerror(errno));
    std::istringstream printed(all_of(ends[0]));
    close(ends[0]);
    const int status = status_of(child);
    if (!WIFEXITED(status) || WEXITSTATUS(status) > 1)
        throw aabb::input_error(program.filename().string() +
                                (WIFEXITED(status) ? " ended with status " + std::to_string(WEXITSTATUS(status))
                                                   : " was ended by signal " + std::to_string(WTERMSIG(status))) +
                                (log.empty() ? "" : ", see " + log.string()) +
                                "; what is finished is kept, and the same command continues");
    ended_process result{WEXITSTATUS(status), {}};
    for (std::string line; std::getline(printed, line);) result.lines.push_back(line);
    return result;
}

std::vector<std::string> lines_of_own_process(const std::vector<std::string>& arguments) {
    // Not by its name, which may be another build's by now.
    ended_process ended = run_to_end("/proc/self/exe", arguments, {});
    if (ended.status != 0 && ended.lines.empty())
        throw aabb::input_error("a process of " + arguments[1] +
                                " failed; what is finished is kept, and the same command continues");
    return std::move(ended.lines);
}

std::filesystem::path own_folder() {
    return std::filesystem::read_symlink("/proc/self/exe").parent_path();
}

}  // namespace aabblab
