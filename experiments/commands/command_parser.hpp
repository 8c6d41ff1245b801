#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace CLI {
class App;
class Option;
}  // namespace CLI

namespace aabblab {

/// An option, a flag or an argument of a command, of which help and refusals tell.
class parsed_option {
public:
    explicit parsed_option(CLI::Option& option) : option_(&option) {}

    parsed_option required() const;
    /// What stands for its value in the help; empty for an argument, whose name does.
    parsed_option type_name(const std::string& name) const;
    /// What stands behind a flag in the help.
    parsed_option option_text(const std::string& text) const;
    parsed_option excludes(parsed_option other) const;
    /// Takes one value each time that it is given.
    parsed_option one_value_at_a_time() const;
    /// Left out of the help.
    parsed_option hidden() const;

private:
    CLI::Option* option_;
};

/// A command, or the program, whose options, arguments and commands are told to the parser. The parser is a header
/// that takes longer to compile than most commands do, so that they see no more of it than this.
class command_parser {
public:
    explicit command_parser(CLI::App& command) : command_(&command) {}

    command_parser add_command(const std::string& name, const std::string& help) const;
    parsed_option add_option(const std::string& names, std::string& value, const std::string& help) const;
    parsed_option add_option(const std::string& names, std::optional<std::string>& value,
                             const std::string& help) const;
    parsed_option add_option(const std::string& names, std::optional<std::size_t>& value,
                             const std::string& help) const;
    parsed_option add_option(const std::string& names, std::vector<std::string>& values, const std::string& help) const;
    parsed_option add_option(const std::string& names, const std::function<void(const std::string&)>& take,
                             const std::string& help) const;
    parsed_option add_flag(const std::string& names, bool& given, const std::string& help) const;
    /// A flag that may have a value, and "true" where it has none.
    parsed_option add_flag(const std::string& names, std::string& value, const std::string& help) const;
    void footer(const std::string& text) const;
    /// Made when help is asked for.
    void footer(const std::function<std::string()>& text) const;
    /// What is done once the whole command line has been read.
    void callback(const std::function<void()>& act) const;
    /// One of its commands, which have all been added, may follow in place of all else that it takes: nothing is to be
    /// lost in silence.
    void allow_one_command() const;
    [[nodiscard]] bool any_command_given() const;

private:
    CLI::App* command_;
};

}  // namespace aabblab
