#pragma once

#include <memory>

// Common to all commands. Ordinary headers must be included before this one, as it has imports.
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

/// The destination of an option's or argument's value, which the caller owns, or a function that receives it.
using option_value = std::variant<std::string*, std::optional<std::string>*, std::optional<std::size_t>*,
                                  std::vector<std::string>*, std::function<void(const std::string&)>>;

/// An option, a flag or an argument of a command.
class parsed_option {
public:
    explicit parsed_option(CLI::Option& option) : option_(&option) {}

    parsed_option required() const;
    parsed_option excludes(parsed_option other) const;
    /// Accepts one value per occurrence.
    parsed_option one_value_at_a_time() const;
    parsed_option hidden() const;

private:
    CLI::Option* option_;
};

/// Declares what a command or the program takes. It hides the parser's header, which takes long to compile.
class command_parser {
public:
    /// @param action receives the given command's action, which returns the exit status: 0, or 1 if a check failed
    command_parser(CLI::App& command, std::function<int()>& action) : command_(&command), action_(&action) {}

    command_parser add_command(const std::string& name, const std::string& help) const;
    /// A command that was added before. It can have subcommands, which exclude its own options and arguments.
    [[nodiscard]] command_parser command(const std::string& name) const;

    /// Sets the action of the command, which receives the request. Invalid input throws aabb::input_error, which ends
    /// the program with status 2.
    template <class Request, class Result>
    Request& set_action(Result (*act)(const Request&)) const {
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

    /// @param name as in the help: "MESH"
    parsed_option argument(const std::string& name, const option_value& value, const std::string& help) const {
        return option(name, value, help).required();
    }
    parsed_option optional_argument(const std::string& name, const option_value& value, const std::string& help) const {
        return option(name, value, help);
    }
    /// @param names with the placeholder of the value in the help: "--n,--objects V"
    parsed_option option(const std::string& names, const option_value& value, const std::string& help) const;
    /// @param value a text if the flag has an optional value, as in "--self [=all]"; "true" without a value
    parsed_option flag(const std::string& name, std::variant<bool*, std::string*> value, const std::string& help) const;
    /// @param text a function is called only for the help
    void footer(const std::variant<std::string, std::function<std::string()>>& text) const;

private:
    void callback(const std::function<int()>& act) const;

    CLI::App* command_;
    std::function<int()>* action_;
};

/// Adds every command of the program, in the order of its help.
void add_commands(const command_parser& program);

/// Wraps the help of the program and of all commands that are added later to the width of the terminal.
void wrap_help(CLI::App& program);

/// The message for a rejected command line, with the closest known command or option if one is unknown.
[[nodiscard]] std::string rejection_of(const CLI::App& program, const CLI::ParseError& error);

/// @throws aabb::input_error if an otherwise valid command line has no command.
void require_command(const CLI::App& program);

}  // namespace aabblab
