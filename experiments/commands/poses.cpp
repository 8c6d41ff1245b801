#include "poses.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "number.hpp"

import aabb.base;
import aabb.geometry;
import aabblab.files;

namespace aabblab {

namespace {

aabb::pose parse_pose(std::string_view text) {
    const std::vector<std::string> words = split_numbers(text);
    if (words.size() != 12)
        throw aabb::input_error(
            fmt::format("a pose is 12 numbers, the rows of [R t] with commas between, not {}", words.size()));
    aabb::pose pose;
    for (std::size_t i = 0; i < 12; ++i) {
        try {
            const auto number = parse_number<double>(words[i]);
            const std::size_t row = i / 4;
            if (i % 4 == 3)
                pose.translation[static_cast<int>(row)] = number;
            else
                pose.rotation[3 * row + i % 4] = number;
        } catch (const aabb::input_error& error) {
            throw aabb::input_error(fmt::format("number {} of 12: {}", i + 1, error.what()));
        }
    }
    aabb::require_rigid(pose);
    return pose;
}

}  // namespace

aabb::pose pose_of(const std::optional<std::string>& text, const char* option) {
    if (!text) return {};
    try {
        return parse_pose(*text);
    } catch (const aabb::input_error& error) {
        throw aabb::input_error(fmt::format("{}: {}", option, error.what()));
    }
}

poses_of_file read_poses(const std::string& file) {
    const std::string text = bytes_of_file(file);
    poses_of_file found;
    std::size_t number = 0;
    for (std::string_view rest = text; !rest.empty();) {
        const std::size_t end = std::min(rest.find('\n'), rest.size());
        std::string_view line = rest.substr(0, end);
        rest.remove_prefix(std::min(end + 1, rest.size()));
        ++number;
        line = line.substr(0, line.find('#'));
        if (line.find_first_not_of(" \t\r") == std::string_view::npos) continue;
        try {
            found.poses.push_back(parse_pose(line));
            found.lines.push_back(number);
        } catch (const aabb::input_error& error) {
            throw aabb::input_error(fmt::format("{}:{}: {}", file, number, error.what()));
        }
    }
    if (found.poses.empty()) throw aabb::input_error(file + ": has no poses");
    return found;
}

}  // namespace aabblab
