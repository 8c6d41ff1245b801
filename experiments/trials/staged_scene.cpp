module;
#include <fcntl.h>
#include <poll.h>
#include <signal.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>

module aabblab.trials;

import aabblab.fmt;

namespace aabblab {

namespace {

using clock = std::chrono::steady_clock;

/// Exit statuses of the child process.
enum : int { is_done = 0, has_failed = 1, is_rejected = 2, has_no_memory = 3 };
/// Precedes the message of an input_error.
constexpr char rejection_mark = 0;

/// Sends text to the parent, in several writes if the pipe is full; ends this process if it reads no more.
void write_all(int pipe, std::string_view text) {
    while (!text.empty()) {
        const ssize_t n = write(pipe, text.data(), text.size());
        if (n < 0 && errno == EINTR) continue;
        if (n <= 0) _exit(has_failed);
        text.remove_prefix(static_cast<std::size_t>(n));
    }
}

/// Makes the kernel kill this process before its parent if memory runs out.
void raise_oom_score() {
    const int file = open("/proc/self/oom_score_adj", O_WRONLY | O_CLOEXEC);
    if (file < 0) return;
    static_cast<void>(!write(file, "1000", 4));
    close(file);
}

/// Does the work in the child; output, and an input_error after `rejection_mark`, go to the pipe.
[[noreturn]] void work_and_exit(int pipe, const std::function<void(const output_sender&)>& work) {
    raise_oom_score();
    int status = has_failed;
    try {
        work([pipe](std::string_view text) { write_all(pipe, text); });
        status = is_done;
    } catch (const aabb::input_error& error) {
        write_all(pipe, std::string(1, rejection_mark) + error.what());
        status = is_rejected;
    } catch (const std::bad_alloc&) {
        status = has_no_memory;
    } catch (const std::length_error&) {
        status = has_no_memory;
    } catch (...) {  // NOLINT(bugprone-empty-catch)
        // The exit status reports it.
    }
    _exit(status);
}

/// Returns at least 1, for `poll`, since less than a millisecond may remain, which 0 would turn into a busy loop.
int milliseconds_until(clock::time_point end) {
    const double remaining = std::chrono::duration<double, std::milli>(end - clock::now()).count();
    return static_cast<int>(std::clamp(std::ceil(remaining), 1.0, double{std::numeric_limits<int>::max()}));
}

/// Appends what the child writes until it closes its end of the pipe.
/// @returns whether that was before `end`, the time limit
bool read_until(int pipe, clock::time_point end, std::string& text) {
    std::array<char, 4096> part{};
    while (clock::now() < end) {
        pollfd readable{pipe, POLLIN, 0};
        const int ready = poll(&readable, 1, milliseconds_until(end));
        if (ready < 0 && errno != EINTR) return false;
        if (ready <= 0) continue;
        const ssize_t n = read(pipe, part.data(), part.size());
        if (n < 0) return false;
        if (n == 0) return true;
        text.append(part.data(), static_cast<std::size_t>(n));
    }
    return false;
}

/// How the child ended, from the status of waitpid. A SIGKILL from outside is likely the kernel's, out of memory.
ending ending_of(int status) {
    if (WIFSIGNALED(status)) return WTERMSIG(status) == SIGKILL ? ending::out_of_memory : ending::failed;
    switch (WEXITSTATUS(status)) {
        case is_done: return ending::done;
        case is_rejected: return ending::rejected;
        case has_no_memory: return ending::out_of_memory;
        default: return ending::failed;
    }
}

// The protocol between child and parent. The first letter is the type of the line; omissions are sent without reasons.
//   f seconds build frames digest  update search detect (frame 0)  update search detect (later frames)
//   l bytes omission...
constexpr char frame_line = 'f', last_line = 'l';

/// The line that reports the times so far to the parent, to describe a run that was killed: time of building, number of
/// frames, digest, times of frame 0 and of all later frames, seconds since the run began.
std::string line_of(const observation& seen, double seconds) {
    std::ostringstream text;
    text.precision(17);
    text << frame_line << ' ' << seconds << ' ' << seen.build.wall_ms << ' ' << seen.frames << ' ' << seen.digest;
    for (const phases* const took : {&seen.first, &seen.rest})
        text << ' ' << took->update.wall_ms << ' ' << took->search.wall_ms << ' ' << took->detect.wall_ms;
    text << '\n';
    return text.str();
}

/// Parses the lines of `send_run`: one per frame, with the times of all frames so far, and a last one. A killed child
/// may have written only a part of its last line, which is ignored.
attempt attempt_from(const child_result& work) {
    attempt result{.end = work.end, .seen = {}, .reason = work.reason, .seconds = work.seconds};
    observation& seen = result.seen;
    std::istringstream lines(work.reported.substr(0, work.reported.rfind('\n') + 1));
    for (std::string line; std::getline(lines, line);) {
        std::istringstream text(line.substr(1));
        if (line[0] == frame_line) {
            text >> result.seconds_of_frames >> seen.build.wall_ms >> seen.frames >> seen.digest;
            for (phases* const took : {&seen.first, &seen.rest})
                text >> took->update.wall_ms >> took->search.wall_ms >> took->detect.wall_ms;
            seen.digests.push_back(seen.digest);
        } else {
            text >> seen.bytes;
            // What the composition leaves out, as numbers of `absence`.
            for (int part = 0; text >> part;) seen.left_out.push_back({static_cast<aabb::absence>(part)});
        }
    }
    return result;
}

/// Runs a candidate in the child process and sends a line per frame, so that a killed run still has results. A last
/// line has what is known only at the end: bytes and omissions.
void send_run(scene_frames& scene, const candidate& tested, std::size_t frames, const output_sender& send) {
    const auto begin = clock::now();
    const auto on_frame = [&](const observation& seen) {
        send(line_of(seen, std::chrono::duration<double>(clock::now() - begin).count()));
    };
    const observation whole = observe(scene, tested, {.frames = frames, .on_frame = on_frame});
    std::string last = fmt::format("{} {}", last_line, whole.bytes);
    for (const aabb::omission& absent : whole.left_out) last += fmt::format(" {}", static_cast<int>(absent.feature));
    send(last + "\n");
}

}  // namespace

/// Does the work in a forked process, killed after `seconds` or out of memory; returns how it ended, and output.
child_result run_in_child(const std::function<void(const output_sender&)>& work, double seconds) {
    child_result result;
    if (!(seconds > 0)) return result;
    result.end = ending::failed;  // unless it ends otherwise
    std::array<int, 2> ends{};
    if (pipe2(ends.data(), O_CLOEXEC) != 0) return result;
    const auto begin = clock::now();
    // A longer limit would overflow the clock.
    const auto end =
        begin + std::chrono::duration_cast<clock::duration>(std::chrono::duration<double>(std::min(seconds, 1e7)));
    const pid_t child = fork();
    if (child == 0) {
        // The child must not outlive its parent, even if that is killed.
        prctl(PR_SET_PDEATHSIG, SIGKILL);
        close(ends[0]);
        work_and_exit(ends[1], work);
    }
    close(ends[1]);
    const bool is_in_time = child > 0 && read_until(ends[0], end, result.reported);
    close(ends[0]);
    if (child < 0) return result;
    if (!is_in_time) kill(child, SIGKILL);
    int status = 0;
    while (waitpid(child, &status, 0) < 0 && errno == EINTR) continue;
    result.end = is_in_time ? ending_of(status) : ending::stopped;
    result.seconds = std::chrono::duration<double>(clock::now() - begin).count();
    if (const std::size_t mark = result.reported.find(rejection_mark); mark != std::string::npos) {
        result.reason = result.reported.substr(mark + 1);
        result.reported.resize(mark);
    }
    return result;
}

/// Does work on the scene in a child process, killed after `seconds`, which inherits the meshes as read.
child_result staged_scene::in_child(const std::function<void(scene_frames&, const output_sender&)>& work,
                                    double seconds) {
    return run_in_child(
        [&](const output_sender& send) {
            if (scene_.meshes()) return work(scene_, send);
            // Children share the offset of an open file: each would read on where the previous one stopped.
            scene_frames own(choice_);
            work(own, send);
        },
        seconds);
}

attempt staged_scene::run(const candidate& tested, std::size_t frames, double seconds, double remaining) {
    attempt result = attempt_from(
        in_child([&](scene_frames& scene, const output_sender& send) { send_run(scene, tested, frames, send); },
                 std::min(seconds, remaining)));
    result.is_out_of_time = result.end == ending::stopped && remaining <= seconds;
    return result;
}

/// How a run ended: "stopped after 2.1 s, in frame 3"
std::string text_of(const attempt& run) {
    const std::string where = run.seen.frames > 0 ? fmt::format(", in frame {}", run.seen.frames) : "";
    const std::string after = fmt::format("after {:.2g} s{}", run.seconds, where);
    switch (run.end) {
        case ending::done: return "ran to the end";
        case ending::stopped: return run.seconds > 0 ? "stopped " + after : "not run: no time was left";
        case ending::out_of_memory: return "out of memory " + after;
        case ending::rejected: return "rejected " + after + ": " + run.reason;
        case ending::failed: break;
    }
    return "failed " + after;
}

}  // namespace aabblab
