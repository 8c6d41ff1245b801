module;
#include <unistd.h>

#include <cstdio>

/// Shows the progress of long runs on a terminal.
export module aabblab.progress;

import aabb.std;

namespace aabblab {

std::string duration_text(double seconds) {
    if (seconds < 90) return std::to_string(std::lround(std::ceil(seconds))) + " s";
    if (seconds < 90 * 60) return std::to_string(std::lround(seconds / 60)) + " min";
    const long minutes = std::lround(seconds / 60);
    return std::to_string(minutes / 60) + " h " + std::to_string(minutes % 60) + " min";
}

}  // namespace aabblab

export namespace aabblab {

/// "searching: 30 of 120, about 12 s left". The estimate assumes constant speed; it is omitted before the first step is
/// done, and if the total is unknown (0): "searching: 30".
[[nodiscard]] std::string progress_text(std::string_view what, std::size_t done, std::size_t total,
                                        std::chrono::duration<double> elapsed) {
    std::string text = std::string(what) + ": " + std::to_string(done);
    if (total == 0) return text;
    text += " of " + std::to_string(total);
    if (done == 0 || done > total) return text;
    const double left = elapsed.count() * static_cast<double>(total - done) / static_cast<double>(done);
    return text + ", about " + duration_text(left) + " left";
}

/// A progress line on stderr, shown on terminals only, and only after two seconds of work. The destructor clears the
/// line; `hide` clears it for other output until the next `update`.
class progress {
public:
    /// @param what the work, as in "searching"
    /// @param total the number of steps; 0 if unknown
    progress(std::string what, std::size_t total)
        : what_(std::move(what)), total_(total), on_terminal_(isatty(STDERR_FILENO) == 1) {}
    progress(const progress&) = delete;
    progress& operator=(const progress&) = delete;
    ~progress() { hide(); }

    /// Reports that `done` steps are done. Cheap enough for steps of a millisecond: the line is redrawn at most five
    /// times a second. Work that takes less than two seconds shows none.
    void update(std::size_t done) {
        if (!on_terminal_) return;
        const clock::time_point now = clock::now();
        if (now - start_ < std::chrono::seconds(2) || (visible_ && now - drawn_ < std::chrono::milliseconds(200)))
            return;
        std::fprintf(stderr, "\r\033[K%s", progress_text(what_, done, total_, now - start_).c_str());
        std::fflush(stderr);
        drawn_ = now;
        visible_ = true;
    }
    void hide() {
        if (!visible_) return;
        std::fputs("\r\033[K", stderr);
        std::fflush(stderr);
        visible_ = false;
    }

private:
    using clock = std::chrono::steady_clock;

    std::string what_;
    std::size_t total_;
    clock::time_point start_ = clock::now();
    clock::time_point drawn_ = start_;
    bool on_terminal_;
    bool visible_ = false;
};

}  // namespace aabblab
