module;
#include <poll.h>
#include <signal.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>
#include <array>
#include <cerrno>
#include <chrono>
#include <cstddef>
#include <functional>
#include <optional>
#include <string>

module aabblab.race;

import :apart;

namespace aabblab {

namespace {

[[noreturn]] void answer(int to, const std::function<std::string()>& work) {
    int status = 1;
    try {
        const std::string text = work();
        std::size_t written = 0;
        while (written < text.size()) {
            const ssize_t n = write(to, text.data() + written, text.size() - written);
            if (n <= 0) break;
            written += static_cast<std::size_t>(n);
        }
        if (written == text.size()) status = 0;
    } catch (...) {
        status = 2;
    }
    _exit(status);
}

/// What is read until the other end closes; nothing where that takes too long.
std::optional<std::string> read_within(int from, double seconds) {
    const auto end = std::chrono::steady_clock::now() + std::chrono::duration<double>(seconds);
    std::string text;
    for (;;) {
        const auto left =
            std::chrono::duration_cast<std::chrono::milliseconds>(end - std::chrono::steady_clock::now()).count();
        if (left <= 0) return std::nullopt;
        pollfd one{from, POLLIN, 0};
        const int ready = poll(&one, 1, static_cast<int>(left));
        if (ready < 0 && errno == EINTR) continue;
        if (ready <= 0) return std::nullopt;
        std::array<char, 4096> some{};
        const ssize_t n = read(from, some.data(), some.size());
        if (n < 0) return std::nullopt;
        if (n == 0) return text;
        text.append(some.data(), static_cast<std::size_t>(n));
    }
}

}  // namespace

std::optional<std::string> done_apart(const std::function<std::string()>& work, double seconds) {
    std::array<int, 2> ends{};
    if (pipe(ends.data()) != 0) return std::nullopt;
    const pid_t child = fork();
    if (child < 0) {
        close(ends[0]);
        close(ends[1]);
        return std::nullopt;
    }
    if (child == 0) {
        // It does not outlive this process, however that ends.
        prctl(PR_SET_PDEATHSIG, SIGKILL);
        close(ends[0]);
        answer(ends[1], work);
    }
    close(ends[1]);
    std::optional<std::string> text = read_within(ends[0], seconds);
    close(ends[0]);
    if (!text) kill(child, SIGKILL);
    int status = 0;
    while (waitpid(child, &status, 0) < 0 && errno == EINTR) {
    }
    if (!WIFEXITED(status) || WEXITSTATUS(status) != 0) return std::nullopt;
    return text;
}

}  // namespace aabblab
