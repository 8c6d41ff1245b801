#include "command_line.hpp"

#include <CLI/CLI.hpp>

import aabb.base;
import aabb.policy;
import aabb.registry;
import aabb.std;
import aabblab.output;

namespace aabblab {

namespace {

class wrapped_help final : public CLI::Formatter {
public:
    std::string make_option(const CLI::Option* option, bool is_positional) const override {
        return entry("  " + make_option_name(option, is_positional) + make_option_opts(option),
                     make_option_desc(option));
    }
    std::string make_subcommand(const CLI::App* command) const override {
        return entry("  " + command->get_display_name(true), command->get_description());
    }
    std::string make_description(const CLI::App* command) const override {
        return wrapped(command->get_description(), output_width()) + "\n";
    }
    std::string make_footer(const CLI::App* command) const override {
        std::istringstream lines(Formatter::make_footer(command));
        std::string text;
        for (std::string line; std::getline(lines, line);) {
            const std::size_t indent = std::min(line.find_first_not_of(' '), line.size());
            text += hanging(line.substr(0, indent), line.substr(indent)) + "\n";
        }
        return text;
    }
};

std::vector<std::string> command_names(const CLI::App& program) {
    std::vector<std::string> names;
    for (const CLI::App* command : program.get_subcommands([](const CLI::App*) { return true; }))
        names.push_back(command->get_name());
    return names;
}

std::vector<std::string> option_names(const CLI::App& command) {
    std::vector<std::string> names;
    for (const CLI::Option* option : command.get_options())
        for (const std::string& name : option->get_lnames()) names.push_back("--" + name);
    return names;
}

/// How a parameter of a strategy that the command takes is given; empty where none has one of this name.
std::string option_with(const std::string& parameter, const std::vector<std::string>& options) {
    for (const aabb::strategy_kind kind : aabb::strategy_kinds) {
        const std::string option = "--" + std::string(name_of(kind));
        if (std::ranges::find(options, option) == options.end()) continue;
        for (const aabb::strategy_info& strategy : aabb::strategies(kind))
            if (std::ranges::find(strategy.parameters, parameter, &aabb::parameter_info::name) !=
                strategy.parameters.end())
                return option + " " + strategy.name + ":" + parameter + "=…";
    }
    return {};
}

/// "aabblab validate extreme"
std::string full_name(const CLI::App& command) {
    const CLI::App* const above = command.get_parent();
    return (above == nullptr ? "" : full_name(*above) + " ") + command.get_name();
}

std::string see_help_of(const CLI::App& command) {
    return "; see " + full_name(command) + " --help";
}

/// Where a message names neither the nearest name nor all of them, it refers to the help.
std::string unknown_name(const std::string& what, const std::string& name, const std::vector<std::string>& known,
                         const CLI::App& command) {
    const std::string sentence = aabb::unknown_name(what, name, known);
    return sentence == aabb::unknown_name(what, name, {}) ? sentence + see_help_of(command) : sentence;
}

std::string unknown_option(const CLI::App& command, const std::string& argument) {
    std::string name = argument.substr(0, argument.find('='));
    name.erase(0, name.find_first_not_of('-'));
    std::ranges::replace(name, '-', '_');
    for (const aabb::strategy_kind kind : aabb::strategy_kinds)
        if (const auto names = aabb::strategy_names(kind); std::ranges::find(names, name) != names.end())
            return "'" + name + "' is a strategy; write --" + std::string(name_of(kind)) + " " + name;
    const std::vector<std::string> options = option_names(command);
    if (const std::string option = option_with(name, options); !option.empty())
        return "'" + name + "' is a parameter of a strategy, as in " + option;
    return unknown_name("option", argument.substr(0, argument.find('=')), options, command);
}

std::string unexpected(const CLI::App& program, const CLI::App& command, const std::string& argument) {
    if (argument.size() > 1 && argument[0] == '-') return unknown_option(command, argument);
    if (&command != &program) return "unexpected argument '" + argument + "'" + see_help_of(command);
    std::vector<std::string> names = command_names(program);
    const std::vector<std::string> of_script = {"test", "data", "benchmark", "paper"};
    if (std::ranges::find(of_script, argument) != of_script.end())
        return "'" + argument + "' is a command of the script aabblab at the root of the source tree";
    names.insert(names.end(), of_script.begin(), of_script.end());
    return unknown_name("command", argument, names, program);
}

}  // namespace

void wrap_help(CLI::App& program) {
    program.formatter(std::make_shared<wrapped_help>());
}

std::string refusal_of(const CLI::App& program, const CLI::ParseError& error) {
    const CLI::App* innermost = &program;
    std::string prefix;
    while (!innermost->get_subcommands().empty()) {
        innermost = innermost->get_subcommands().front();
        prefix += (prefix.empty() ? "" : " ") + innermost->get_name();
    }
    if (!prefix.empty()) prefix += ": ";
    const CLI::App& command = *innermost;
    // A typing error makes the parser miss what was meant, so it comes before what the parser says.
    if (const auto rest = command.remaining(); !rest.empty())
        return prefix + unexpected(program, command, rest.front());
    if (const auto rest = program.remaining(); !rest.empty()) return unexpected(program, program, rest.front());
    const std::string said = error.what();
    // The parser counts values; every option of ours that takes a value takes one.
    if (dynamic_cast<const CLI::ArgumentMismatch*>(&error) != nullptr)
        return prefix + said.substr(0, said.find(':')) + " takes one value";
    return prefix + said;
}

void require_command(const CLI::App& program) {
    if (!program.get_subcommands().empty()) return;
    throw aabb::input_error("expected a command" + see_help_of(program));
}

}  // namespace aabblab
