module;
#include <unistd.h>

#include <cstdio>

module aabblab.progress;

namespace aabblab {

namespace {

using namespace std::chrono_literals;

std::string duration_text(double seconds) {
    if (seconds < 90) return std::to_string(std::lround(std::ceil(seconds))) + " s";
    if (seconds < 90 * 60) return std::to_string(std::lround(seconds / 60)) + " min";
    const long minutes = std::lround(seconds / 60);
    return std::to_string(minutes / 60) + " h " + std::to_string(minutes % 60) + " min";
}

}  // namespace

/// "searching: 30 of 120, about 12 s left"; assumes that steps take equally long.
std::string progress_text(std::string_view what, std::size_t done, std::size_t total,
                          std::chrono::duration<double> elapsed) {
    std::string text = std::string(what) + ": " + std::to_string(done);
    if (total == 0) return text;
    text += " of " + std::to_string(total);
    if (done == 0 || done > total) return text;
    const double left = elapsed.count() * static_cast<double>(total - done) / static_cast<double>(done);
    return text + ", about " + duration_text(left) + " left";
}

progress::progress(std::string what, std::size_t total)
    : what_(std::move(what)), total_(total), on_terminal_(isatty(STDERR_FILENO) == 1) {}

/// Redraws the line at most five times a second, and not in the first two seconds: short work shows nothing.
void progress::update(std::size_t done) {
    if (!on_terminal_) return;
    const clock::time_point now = clock::now();
    if (now - start_ < 2s || (visible_ && now - drawn_ < 200ms)) return;
    std::fprintf(stderr, "\r\033[K%s", progress_text(what_, done, total_, now - start_).c_str());
    std::fflush(stderr);
    drawn_ = now;
    visible_ = true;
}

void progress::hide() {
    if (!visible_) return;
    std::fputs("\r\033[K", stderr);
    std::fflush(stderr);
    visible_ = false;
}

}  // namespace aabblab
