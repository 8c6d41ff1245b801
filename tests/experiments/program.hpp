#pragma once

#include <spawn.h>
#include <sys/wait.h>

#include <cerrno>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <sstream>
#include <system_error>

#include "temporary_folder.hpp"

import aabb;

/// The exit status and output of a run of the program.
struct program_result {
    int status;  ///< the exit status; 128 plus the signal if one ended the program
    std::string out;
    std::string err;
};

namespace program_detail {

struct file_closer {
    void operator()(std::FILE* file) const { std::fclose(file); }
};
using temporary_file = std::unique_ptr<std::FILE, file_closer>;

[[nodiscard]] inline temporary_file make_file(const std::string& content) {
    temporary_file file(std::tmpfile());
    if (file == nullptr) throw std::system_error(errno, std::generic_category(), "no temporary file");
    std::fwrite(content.data(), 1, content.size(), file.get());
    std::rewind(file.get());
    return file;
}

[[nodiscard]] inline std::string content_of(std::FILE* file) {
    std::string content;
    std::rewind(file);
    for (int c = std::fgetc(file); c != EOF; c = std::fgetc(file)) content += static_cast<char>(c);
    return content;
}

}  // namespace program_detail

/// The program reads costs from the user's configuration; tests have none unless they name a folder of their own.
inline const bool is_without_kept_costs = setenv("XDG_CONFIG_HOME", "/nonexistent", 1) == 0;

/// Starts a command without waiting for it.
[[nodiscard]] inline pid_t started(std::vector<std::string> arguments, posix_spawn_file_actions_t* files = nullptr) {
    std::vector<char*> argv;
    for (std::string& argument : arguments) argv.push_back(argument.data());
    argv.push_back(nullptr);
    pid_t child = 0;
    const int failed = posix_spawnp(&child, argv[0], files, nullptr, argv.data(), environ);
    if (failed != 0) throw std::system_error(failed, std::generic_category(), arguments[0]);
    return child;
}

inline constexpr int closed_output = -2;

/// Runs a command to its end, its name first; one without a slash is searched for in PATH.
/// @param input the content of standard input
/// @param output the descriptor to use as standard output, whose content is not returned; or closed_output
[[nodiscard]] inline program_result run_command(std::vector<std::string> arguments, const std::string& input = {},
                                                int output = -1) {
    const auto in = program_detail::make_file(input);
    const auto out = program_detail::make_file({});
    const auto err = program_detail::make_file({});
    posix_spawn_file_actions_t files;
    posix_spawn_file_actions_init(&files);
    posix_spawn_file_actions_adddup2(&files, fileno(in.get()), STDIN_FILENO);
    if (output == closed_output)
        posix_spawn_file_actions_addclose(&files, STDOUT_FILENO);
    else
        posix_spawn_file_actions_adddup2(&files, output < 0 ? fileno(out.get()) : output, STDOUT_FILENO);
    posix_spawn_file_actions_adddup2(&files, fileno(err.get()), STDERR_FILENO);
    const pid_t child = started(std::move(arguments), &files);
    posix_spawn_file_actions_destroy(&files);
    int status = 0;
    waitpid(child, &status, 0);
    return {WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status), program_detail::content_of(out.get()),
            program_detail::content_of(err.get())};
}

/// Whether the condition becomes true within half a minute.
[[nodiscard]] inline bool comes_true(const std::function<bool()>& condition) {
    for (int attempt = 0; attempt < 3000; ++attempt) {
        if (condition()) return true;
        usleep(10'000);
    }
    return false;
}

/// Runs the program under test in the same way.
[[nodiscard]] inline program_result run_program(std::vector<std::string> arguments, const std::string& input = {},
                                                int output = -1) {
    arguments.insert(arguments.begin(), AABBLAB_UNDER_TEST);
    return run_command(std::move(arguments), input, output);
}

/// Runs the program under test, which must succeed.
inline program_result run_well(std::vector<std::string> arguments, const std::string& input = {}) {
    program_result result = run_program(std::move(arguments), input);
    INFO(result.out << result.err);
    REQUIRE(result.status == 0);
    return result;
}

/// Appends more arguments.
[[nodiscard]] inline std::vector<std::string> joined(std::vector<std::string> arguments,
                                                     const std::vector<std::string>& more) {
    arguments.insert(arguments.end(), more.begin(), more.end());
    return arguments;
}

/// Whether the text is one line that begins with the program's name.
[[nodiscard]] inline bool is_one_sentence(const std::string& text) {
    return text.starts_with("aabblab: ") && text.find('\n') == text.size() - 1;
}

/// Requires that the result is a rejection, with status 2 and one sentence, and returns it.
inline program_result as_refused(program_result result) {
    INFO(result.out << result.err);
    REQUIRE(result.status == 2);
    REQUIRE(is_one_sentence(result.err));
    return result;
}

/// Runs the program under test, which must reject its arguments.
inline program_result run_refused(std::vector<std::string> arguments, const std::string& input = {}) {
    return as_refused(run_program(std::move(arguments), input));
}

/// Command lines, each with a part of the message with which it must be rejected.
using refusals = std::vector<std::pair<std::vector<std::string>, std::string>>;

/// Checks that each is rejected with such a message and prints nothing else.
/// @param before the arguments that precede the rest of each
inline void check_refused(const std::vector<std::string>& before, const refusals& rejections) {
    for (const auto& [rest, message] : rejections) {
        const std::vector<std::string> arguments = joined(before, rest);
        CAPTURE(arguments);
        const program_result result = run_refused(arguments);
        CHECK(result.out.empty());
        CHECK_THAT(result.err, Catch::Matchers::ContainsSubstring(message));
    }
}

[[nodiscard]] inline std::vector<std::string> lines_of(const std::string& text) {
    std::vector<std::string> lines;
    std::istringstream in(text);
    for (std::string line; std::getline(in, line);) lines.push_back(line);
    return lines;
}

/// `what`, repeated, with `between` as separator.
[[nodiscard]] inline std::string repeated(const std::string& what, std::size_t times, const std::string& between = {}) {
    std::string text;
    for (std::size_t i = 0; i < times; ++i) text += (i == 0 ? "" : between) + what;
    return text;
}

/// A unit cube with this minimum corner.
[[nodiscard]] inline aabb::box cube(float x, float y, float z) {
    return {{x, y, z}, {x + 1, y + 1, z + 1}};
}

/// Checks that no line is longer than 80 bytes.
inline void check_narrow(const std::string& text) {
    for (const std::string& line : lines_of(text)) {
        INFO(line);
        CHECK(line.size() <= 80);
    }
}
