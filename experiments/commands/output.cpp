#include "output.hpp"

#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <charconv>
#include <cstddef>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <system_error>

import aabb;

namespace aabblab {

namespace {

[[noreturn]] void refuse_output(int error) {
    if (error == EPIPE) throw output_closed();
    throw aabb::input_error("cannot write to standard output: " + std::generic_category().message(error));
}

}  // namespace

void print(std::string_view text) {
    if (std::fwrite(text.data(), 1, text.size(), stdout) != text.size()) refuse_output(errno);
}

void flush_output() {
    if (std::fflush(stdout) != 0) refuse_output(errno);
}

std::size_t output_width() {
    constexpr std::size_t least = 40;
    std::size_t width = 80;
    if (const char* columns = std::getenv("COLUMNS")) std::from_chars(columns, columns + std::strlen(columns), width);
    winsize window{};
    if (ioctl(STDOUT_FILENO, TIOCGWINSZ, &window) == 0 && window.ws_col > 0) width = window.ws_col;
    return std::max(width, least);
}

void note(std::string_view text) {
    std::fprintf(stderr, "aabblab: %.*s\n", static_cast<int>(text.size()), text.data());
}

void require_other_file(const std::string& out, std::span<const std::string> inputs) {
    std::error_code ignored;  // a file that is not there is no other's
    for (const std::string& input : inputs)
        if (std::filesystem::equivalent(out, input, ignored))
            throw aabb::input_error(out + " would write over " + input + ", which this command reads");
}

}  // namespace aabblab
