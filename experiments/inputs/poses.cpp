module;
#include <fmt/format.h>

module aabblab.inputs;

import aabb.base;
import aabblab.files;

namespace aabblab {

namespace {

constexpr std::size_t most_poses = 10'000'000;  // as of a motion, for what a pipe may go on with

aabb::pose parse_pose(const std::vector<std::string>& words) {
    if (words.size() != 12)
        throw aabb::input_error(
            fmt::format("a pose is 12 numbers, the rows of [R t] with commas between, not {}", words.size()));
    aabb::pose pose;
    for (std::size_t i = 0; i < 12; ++i) {
        const auto number = parse_number_of<double>(words, i);
        const std::size_t row = i / 4;
        if (i % 4 == 3)
            pose.translation[static_cast<int>(row)] = number;
        else
            pose.rotation[3 * row + i % 4] = number;
    }
    aabb::require_rigid(pose);
    return pose;
}

}  // namespace

aabb::pose pose_of(const std::optional<std::string>& text, const char* option) {
    if (!text) return {};
    try {
        return parse_pose(split_numbers(*text));
    } catch (const aabb::input_error& error) {
        throw aabb::input_error(fmt::format("{}: {}", option, error.what()));
    }
}

given_poses read_poses(const std::string& file) {
    given_poses read{{}, file, {}};
    for (line_stream lines(file); lines.next();) {
        try {
            const std::vector<std::string> words = split_numbers(without_comment(lines.line()));
            if (words.empty()) continue;
            if (read.poses.size() == most_poses)
                throw aabb::input_error(fmt::format("there are more than {} poses", most_poses));
            read.poses.push_back(parse_pose(words));
            read.lines.push_back(lines.number());
        } catch (const aabb::input_error& error) {
            lines.fail(error.what());
        }
    }
    if (read.poses.empty()) throw aabb::input_error(file + ": has no poses");
    return read;
}

}  // namespace aabblab
