module;
#include <sys/wait.h>

module aabblab.processes;

import aabb.base;
import aabblab.output;

namespace aabblab {

ended_process run_to_end(const std::filesystem::path& program, const std::vector<std::string>& arguments,
                         const std::filesystem::path& log) {
    flush_output();
    const child_result ended = run_child(program.string(), arguments, {.folder = {}, .input = {}, .errors = log});
    if (ended.refused != 0)
        throw aabb::input_error(program.string() + " cannot be started: " + std::strerror(ended.refused));
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
