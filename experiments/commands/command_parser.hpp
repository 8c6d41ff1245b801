#pragma once

#include <memory>

// What every command uses. Headers that are no imports come before this one.
import aabb.base;
import aabb.std;
import aabblab.fmt;
import aabblab.output;

namespace CLI {
class App;
class Option;
class ParseError;
}  // namespace CLI

namespace aabblab {

/// What takes the value of an option or an argument, which the caller keeps; or what is done with it.
using option_value = std::variant<std::string*, std::optional<std::string>*, std::optional<std::size_t>*,
                                  std::vector<std::string>*, std::function<void(const std::string&)>>;

/// An option, a flag or an argument of a command, of which help and refusals tell.
class parsed_option {
public:
    explicit parsed_option(CLI::Option& option) : option_(&option) {}

    parsed_option required() const;
    parsed_option excludes(parsed_option other) const;
    /// Takes one value each time that it is given.
    parsed_option one_value_at_a_time() const;
    parsed_option hidden() const;

private:
    CLI::Option* option_;
};

/// A command, or the program, whose options, arguments and commands are told to the parser. The parser is a header
/// that takes longer to compile than most commands do, so that they see no more of it than this.
class command_parser {
public:
    /// @param status of the program, which a command sets when it has run: 0, or 1 when a check failed
    command_parser(CLI::App& command, int& status) : command_(&command), status_(&status) {}

    command_parser add_command(const std::string& name, const std::string& help) const;
    /// One that was added before. In place of all else that a command takes, one of its own may follow.
    [[nodiscard]] command_parser command(const std::string& name) const;

    /// What the command does: called once the whole command line has been read, with the request that it has filled.
    /// Bad input is thrown as aabb::input_error, which ends the program with status 2.
    template <class Request, class Result>
    Request& calls(Result (*act)(const Request&)) const {
        const auto request = std::make_shared<Request>();
        callback([request, act] {
            if constexpr (std::is_void_v<Result>) {
                act(*request);
                return 0;
            } else {
                return act(*request);
            }
        });
        return *request;
    }

    /// @param name as the help has it: "MESH"
    parsed_option argument(const std::string& name, const option_value& value, const std::string& help) const;
    parsed_option optional_argument(const std::string& name, const option_value& value, const std::string& help) const;
    /// @param names with what stands for the value in the help: "--n,--objects V"
    parsed_option option(const std::string& names, const option_value& value, const std::string& help) const;
    /// @param value a text where the flag may have a value, as in "--self [=apart]": "true" where it has none
    parsed_option flag(const std::string& name, std::variant<bool*, std::string*> value, const std::string& help) const;
    void footer(const std::string& text) const;
    /// Made when help is asked for.
    void footer(const std::function<std::string()>& text) const;

private:
    void callback(const std::function<int()>& act) const;

    CLI::App* command_;
    int* status_;
};

/// Adds every command of the program, in the order of its help.
void add_commands(const command_parser& program);

/// The help of the program, and of the commands that are added to it later, fits the terminal.
void wrap_help(CLI::App& program);

/// The sentence for a command line that was refused, with the nearest command or option for an unknown one.
[[nodiscard]] std::string refusal_of(const CLI::App& program, const CLI::ParseError& error);

/// @throws aabb::input_error when the command line, accepted otherwise, names no command.
void require_command(const CLI::App& program);

}  // namespace aabblab
