#pragma once

#include <string>

namespace CLI {
class App;
class ParseError;
}  // namespace CLI

namespace aabblab {

/// The help of the program, and of the commands that are added to it later, fits the terminal.
void wrap_help(CLI::App& program);

/// The sentence for a command line that was refused, with the nearest command or option for an unknown one.
[[nodiscard]] std::string refusal_of(const CLI::App& program, const CLI::ParseError& error);

/// @throws aabb::input_error when the command line, accepted otherwise, names no command.
void require_command(const CLI::App& program);

}  // namespace aabblab
