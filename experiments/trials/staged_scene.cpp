module;
#include <fmt/format.h>

module aabblab.trials;

import aabb.pipeline;

namespace aabblab {

namespace {

// What is told of a play: a line after each frame, with what it took up to there, then its bytes and what its stages
// left out. The first letter says which.
constexpr char frame_line = 'f';
constexpr char bytes_line = 'b';
constexpr char omission_line = 'o';

/// @param seconds since the play began
std::string line_of(const observation& seen, double seconds) {
    std::ostringstream text;
    text.precision(17);
    text << frame_line << ' ' << seconds << ' ' << seen.build.wall_ms << ' ' << seen.frames << ' ' << seen.digest;
    for (const phases* const took : {&seen.first, &seen.rest})
        text << ' ' << took->update.wall_ms << ' ' << took->search.wall_ms << ' ' << took->detect.wall_ms;
    text << '\n';
    return text.str();
}

/// A last line that was cut off is none.
attempt attempt_from(const work_apart& played) {
    attempt one{.end = played.end, .seen = {}, .reason = played.reason, .seconds = played.seconds};
    observation& seen = one.seen;
    std::istringstream lines(played.told.substr(0, played.told.rfind('\n') + 1));
    for (std::string line; std::getline(lines, line);) {
        std::istringstream text(line.substr(1));
        if (line[0] == frame_line) {
            text >> one.seconds_of_frames >> seen.build.wall_ms >> seen.frames >> seen.digest;
            for (phases* const took : {&seen.first, &seen.rest})
                text >> took->update.wall_ms >> took->search.wall_ms >> took->detect.wall_ms;
            seen.digests.push_back(seen.digest);
        } else if (line[0] == bytes_line) {
            text >> seen.bytes;
        } else {
            const std::size_t between = line.find('\t');
            seen.left_out.push_back({line.substr(1, between - 1), line.substr(between + 1)});
        }
    }
    return one;
}

void tell_play(scene_play& scene, const contender& who, std::size_t frames, const telling& tell) {
    const auto begin = std::chrono::steady_clock::now();
    const auto each = [&](const observation& so_far) {
        tell(line_of(so_far, std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count()));
    };
    const observation seen = observe(scene, who, {.frames = frames, .each = each});
    tell(fmt::format("{} {}\n", bytes_line, seen.bytes));
    for (const aabb::omission& one : seen.left_out) tell(omission_line + one.what + "\t" + one.why + "\n");
}

}  // namespace

work_apart staged_scene::apart(const std::function<void(scene_play&, const telling&)>& work, double seconds) {
    return done_apart(
        [&](const telling& tell) {
            if (scene_.meshes()) return work(scene_, tell);
            // Of a file that is open in this process too, copies of it would read on where the last one stopped.
            scene_play own(choice_);
            work(own, tell);
        },
        seconds);
}

attempt staged_scene::play(const contender& who, std::size_t frames, double seconds) {
    return attempt_from(
        apart([&](scene_play& scene, const telling& tell) { tell_play(scene, who, frames, tell); }, seconds));
}

std::string text_of(const attempt& one) {
    const std::string where = one.seen.frames > 0 ? fmt::format(", in frame {}", one.seen.frames) : "";
    const std::string after = fmt::format("after {:.2g} s{}", one.seconds, where);
    switch (one.end) {
        case ending::done: return "played to its end";
        case ending::stopped: return one.seconds > 0 ? "stopped " + after : "not played: no time was left";
        case ending::out_of_memory: return "out of memory " + after;
        case ending::refused: return "refused " + after + ": " + one.reason;
        case ending::failed: break;
    }
    return "failed " + after;
}

}  // namespace aabblab
