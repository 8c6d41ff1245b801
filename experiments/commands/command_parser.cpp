#include <CLI/CLI.hpp>

// This header has imports, so it comes last.
#include "command_parser.hpp"

import aabb.policy;
import aabb.registry;

namespace aabblab {

namespace {

/// Rejects options of the outer command, which would be ignored silently.
void reject_outer_options(const CLI::App& command, const CLI::App& subcommand) {
    for (const CLI::Option* option : command.get_options())
        if (option->count() > 0)
            throw aabb::input_error(command.get_name() + ": " + option->get_name() + " does not apply to '" +
                                    subcommand.get_name() + "', whose own options follow its name");
}

/// Splits "--out FILE" into the names of the option and the placeholder of its value.
std::pair<std::string, std::string> split_value_name(const std::string& names) {
    const std::size_t blank = names.find(' ');
    return {names.substr(0, blank), blank == std::string::npos ? "" : names.substr(blank + 1)};
}

/// Formats the help like the parser, but wrapped to the width of the output, with descriptions in a second column.
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
    /// Wraps each line of the footer and keeps its indent.
    std::string make_footer(const CLI::App* command) const override {
        std::istringstream lines(Formatter::make_footer(command));
        std::string text;
        for (std::string line; std::getline(lines, line);) {
            std::size_t indent = std::min(line.find_first_not_of(' '), line.size());
            // An indented line has a name, two blanks or more, and its text: further lines begin below the text.
            if (indent > 0) indent = std::min(line.find_first_not_of(' ', line.find("  ", indent)), line.size());
            text += hanging(line.substr(0, indent), line.substr(indent)) + "\n";
        }
        return text;
    }
};

std::vector<std::string> option_names(const CLI::App& command) {
    std::vector<std::string> names;
    for (const CLI::Option* option : command.get_options())
        for (const std::string& name : option->get_lnames()) names.push_back("--" + name);
    return names;
}

/// The form "--partition axial_cut:axes=…", for a strategy's parameter that is written as an option of its own.
/// @param options those of the command, in which each kind of strategy has one
/// @returns empty if no strategy that the command accepts has a parameter of this name
std::string option_of_parameter(const std::string& parameter, const std::vector<std::string>& options) {
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

/// The command with its parents: "aabblab validate extreme".
std::string full_name(const CLI::App& command) {
    const CLI::App* const parent = command.get_parent();
    return (parent == nullptr ? "" : full_name(*parent) + " ") + command.get_name();
}

std::string hint_at_help_of(const CLI::App& command) {
    return "; see " + full_name(command) + " --help";
}

/// The message on an unknown name; it refers to the help if no known name is similar enough to be suggested.
std::string unknown_name(const std::string& what, const std::string& name, const std::vector<std::string>& known,
                         const CLI::App& command) {
    const std::string sentence = aabb::unknown_name(what, name, known);
    return sentence == aabb::unknown_name(what, name, {}) ? sentence + hint_at_help_of(command) : sentence;
}

/// The message on an unknown option, which may be the name of a strategy or of one of its parameters.
std::string rejection_of_option(const CLI::App& command, const std::string& argument) {
    std::string name = argument.substr(0, argument.find('='));
    name.erase(0, name.find_first_not_of('-'));
    std::ranges::replace(name, '-', '_');
    for (const aabb::strategy_kind kind : aabb::strategy_kinds)
        if (const auto names = aabb::strategy_names(kind); std::ranges::find(names, name) != names.end())
            return "'" + name + "' is a strategy; write --" + std::string(name_of(kind)) + " " + name;
    const std::vector<std::string> options = option_names(command);
    if (const std::string option = option_of_parameter(name, options); !option.empty())
        return "'" + name + "' is a parameter of a strategy, as in " + option;
    return unknown_name("option", argument.substr(0, argument.find('=')), options, command);
}

/// The message on an argument that the parser could not assign to any option, argument or command.
std::string rejection_of_argument(const CLI::App& program, const CLI::App& command, const std::string& argument) {
    if (argument.size() > 1 && argument[0] == '-') return rejection_of_option(command, argument);
    if (&command != &program) return "unexpected argument '" + argument + "'" + hint_at_help_of(command);
    const std::vector<std::string> script_commands = {"test", "data", "benchmark", "paper"};
    if (std::ranges::find(script_commands, argument) != script_commands.end())
        return "'" + argument + "' is a command of the script aabblab at the root of the source tree";
    std::vector<std::string> names;
    for (const CLI::App* known : program.get_subcommands([](const CLI::App*) { return true; }))
        names.push_back(known->get_name());
    names.insert(names.end(), script_commands.begin(), script_commands.end());
    return unknown_name("command", argument, names, program);
}

}  // namespace

parsed_option parsed_option::required() const {
    option_->required();
    return *this;
}

parsed_option parsed_option::excludes(parsed_option other) const {
    option_->excludes(other.option_);
    return *this;
}

parsed_option parsed_option::one_value_at_a_time() const {
    option_->allow_extra_args(false);
    return *this;
}

parsed_option parsed_option::hidden() const {
    option_->group("");
    return *this;
}

/// Adds a command, or one subcommand at most, as in `validate extreme`. Options between the two names are rejected, as
/// the subcommand would ignore them.
command_parser command_parser::add_command(const std::string& name, const std::string& help) const {
    CLI::App* const subcommand = command_->add_subcommand(name, help);
    if (command_->get_parent() != nullptr) {
        command_->require_subcommand(0, 1);
        subcommand->preparse_callback(
            [parent = command_, subcommand](std::size_t) { reject_outer_options(*parent, *subcommand); });
    }
    return {*subcommand, *action_};
}

command_parser command_parser::command(const std::string& name) const {
    return {*command_->get_subcommand(name), *action_};
}

/// Adds an option, "--out FILE", or argument, "FILE", whose value is stored in a variable or passed to a function.
parsed_option command_parser::option(const std::string& names, const option_value& value,
                                     const std::string& help) const {
    const std::pair<std::string, std::string> parts = split_value_name(names);
    const auto add = [&]<class Value>(const Value& to) {
        if constexpr (std::is_pointer_v<Value>)
            return command_->add_option(parts.first, *to, help);
        else
            return command_->add_option_function<std::string>(parts.first, to, help);
    };
    // The placeholder is empty for arguments, whose name represents the value.
    return parsed_option(*std::visit(add, value)->type_name(parts.second));
}

parsed_option command_parser::flag(const std::string& name, std::variant<bool*, std::string*> value,
                                   const std::string& help) const {
    const std::pair<std::string, std::string> parts = split_value_name(name);
    CLI::Option* const option = std::visit([&](auto* to) { return command_->add_flag(parts.first, *to, help); }, value);
    return parsed_option(parts.second.empty() ? *option : *option->option_text(parts.second));
}

void command_parser::footer(const std::variant<std::string, std::function<std::string()>>& text) const {
    std::visit([&](const auto& given) { command_->footer(given); }, text);
}

void command_parser::callback(const std::function<int()>& act) const {
    // If a subcommand is given, only that runs.
    const auto set_own_action = [command = command_, action = action_, act] {
        if (command->get_subcommands().empty()) *action = act;
    };
    command_->callback(set_own_action);
}

void wrap_help(CLI::App& program) {
    program.formatter(std::make_shared<wrapped_help>());
}

/// The message of the innermost command: on an argument that nothing accepts, otherwise the parser's own.
std::string rejection_of(const CLI::App& program, const CLI::ParseError& error) {
    const CLI::App* innermost = &program;
    std::string prefix;
    while (!innermost->get_subcommands().empty()) {
        innermost = innermost->get_subcommands().front();
        prefix += (prefix.empty() ? "" : " ") + innermost->get_name();
    }
    if (!prefix.empty()) prefix += ": ";
    const CLI::App& command = *innermost;
    // Unknown arguments are reported first, as a typing error often causes the parser's own error.
    if (const auto rest = command.remaining(); !rest.empty())
        return prefix + rejection_of_argument(program, command, rest.front());
    if (const auto rest = program.remaining(); !rest.empty())
        return rejection_of_argument(program, program, rest.front());
    const std::string message = error.what();
    // On a repeated option, the parser's message has a count of values, and no name if the option is hidden.
    if (dynamic_cast<const CLI::ArgumentMismatch*>(&error) != nullptr) {
        std::string name = message.substr(0, message.find(':'));
        for (const CLI::Option* option : command.get_options())
            if (name.empty() && option->count() > 1) name = "--" + option->get_lnames().front();
        return prefix + name + " takes one value";
    }
    return prefix + message;
}

void require_command(const CLI::App& program) {
    if (!program.get_subcommands().empty()) return;
    throw aabb::input_error("expected a command" + hint_at_help_of(program));
}

}  // namespace aabblab
