module;
#include <fcntl.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cctype>
#include <cerrno>
#include <cstddef>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <span>
#include <string>
#include <system_error>
#include <utility>

module aabblab.figures;

import aabb;
import aabblab.files;

namespace aabblab {

namespace {

struct outcome {
    bool started = false;
    int status = 0;  ///< of waitpid, or errno where it could not be started
    std::string said;
};

/// Both ends are closed in every child, except where they are given to it.
struct pipe_ends {
    std::array<int, 2> ends{-1, -1};

    pipe_ends() {
        if (pipe2(ends.data(), O_CLOEXEC) != 0)
            throw aabb::input_error("gnuplot cannot be run: " + std::generic_category().message(errno));
    }
    pipe_ends(const pipe_ends&) = delete;
    pipe_ends& operator=(const pipe_ends&) = delete;
    ~pipe_ends() {
        close_end(0);
        close_end(1);
    }
    void close_end(std::size_t which) {
        if (const int end = std::exchange(ends[which], -1); end >= 0) close(end);
    }
};

[[nodiscard]] std::string read_all(int descriptor) {
    std::string all;
    std::array<char, 4096> part{};
    for (;;) {
        const ssize_t got = read(descriptor, part.data(), part.size());
        if (got > 0)
            all.append(part.data(), static_cast<std::size_t>(got));
        else if (got == 0 || errno != EINTR)
            return all;
    }
}

/// In the script's folder, without whatever its user has made gnuplot begin with.
[[nodiscard]] outcome run(const std::filesystem::path& folder, std::string script) {
    pipe_ends output;
    posix_spawn_file_actions_t actions;
    posix_spawn_file_actions_init(&actions);
    posix_spawn_file_actions_addopen(&actions, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
    posix_spawn_file_actions_adddup2(&actions, output.ends[1], STDOUT_FILENO);
    posix_spawn_file_actions_adddup2(&actions, output.ends[1], STDERR_FILENO);
    posix_spawn_file_actions_addchdir_np(&actions, folder.c_str());
    std::string program = "gnuplot";
    std::string defaults = "--default-settings";
    std::array<char*, 4> arguments{program.data(), defaults.data(), script.data(), nullptr};
    pid_t child = 0;
    outcome result;
    const int refused = posix_spawnp(&child, program.c_str(), &actions, nullptr, arguments.data(), environ);
    posix_spawn_file_actions_destroy(&actions);
    output.close_end(1);
    if (refused != 0) {
        result.status = refused;
        return result;
    }
    result.started = true;
    result.said = read_all(output.ends[0]);
    while (waitpid(child, &result.status, 0) < 0 && errno == EINTR) continue;
    return result;
}

[[nodiscard]] std::string last_line(std::string text) {
    while (!text.empty() && std::isspace(static_cast<unsigned char>(text.back())) != 0) text.pop_back();
    return text.substr(text.find_last_of('\n') + 1);  // npos + 1 is 0
}

/// The date in a PDF is the only thing that changes when nothing else has. Blanks take its place, because a PDF says
/// where in the file its parts begin.
void remove_date(const std::filesystem::path& pdf) {
    std::ifstream in(pdf, std::ios::binary);
    std::string bytes{std::istreambuf_iterator<char>(in), {}};
    in.close();
    const std::size_t begin = bytes.find("/CreationDate (");
    const std::size_t end = bytes.find(')', begin);
    if (begin == std::string::npos || end == std::string::npos) return;
    bytes.replace(begin, end + 1 - begin, end + 1 - begin, ' ');
    write_file(pdf, bytes);
}

/// It has written both pictures when this returns.
void run_gnuplot(const std::filesystem::path& folder, const std::string& name) {
    const outcome result = run(folder, name + ".gp");
    if (!result.started && result.status == ENOENT)
        throw aabb::input_error("figures are drawn by gnuplot, which is not there: the package gnuplot-nox has it");
    const std::string script = (folder / (name + ".gp")).string();
    if (!result.started)
        throw aabb::input_error(script + ": gnuplot cannot be run: " + std::generic_category().message(result.status));
    if (WIFEXITED(result.status) && WEXITSTATUS(result.status) == 0) return remove_date(folder / (name + ".pdf"));
    // Half a picture is none.
    std::error_code ignored;
    for (const char* const ending : {".svg", ".pdf"}) std::filesystem::remove(folder / (name + ending), ignored);
    if (WIFSIGNALED(result.status))
        throw aabb::input_error(script + ": gnuplot was ended by signal " + std::to_string(WTERMSIG(result.status)));
    throw aabb::input_error(script + ": gnuplot fails: " + last_line(result.said));
}

}  // namespace

void draw(const std::filesystem::path& folder, std::span<const figure> figures) {
    std::error_code error;
    std::filesystem::create_directories(folder, error);
    if (error) throw aabb::input_error(folder.string() + ": cannot be made: " + error.message());
    for (const figure& f : figures) {
        write_file(folder / (f.name + ".csv"), csv_of(f));
        write_file(folder / (f.name + ".gp"), script_of(f));
    }
    for (const figure& f : figures) run_gnuplot(folder, f.name);
}

}  // namespace aabblab
