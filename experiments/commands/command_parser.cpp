#include "command_parser.hpp"

#include <CLI/CLI.hpp>

import aabb.base;
import aabb.std;

namespace aabblab {

namespace {

/// Nothing is to be lost in silence.
void require_alone(const CLI::App& command, const CLI::App& inner) {
    for (const CLI::Option* option : command.get_options())
        if (option->count() > 0)
            throw aabb::input_error(command.get_name() + ": " + option->get_name() + " has no part in '" +
                                    inner.get_name() + "'; what it takes stands behind its name");
}

/// "--out FILE" as names, and what stands for the value.
std::pair<std::string, std::string> without_value(const std::string& names) {
    const std::size_t blank = names.find(' ');
    return {names.substr(0, blank), blank == std::string::npos ? "" : names.substr(blank + 1)};
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

command_parser command_parser::add_command(const std::string& name, const std::string& help) const {
    CLI::App* const inner = command_->add_subcommand(name, help);
    if (command_->get_parent() != nullptr) {
        command_->require_subcommand(0, 1);
        inner->preparse_callback([above = command_, inner](std::size_t) { require_alone(*above, *inner); });
    }
    return {*inner, *status_};
}

command_parser command_parser::command(const std::string& name) const {
    return {*command_->get_subcommand(name), *status_};
}

parsed_option command_parser::argument(const std::string& name, const option_value& value,
                                       const std::string& help) const {
    return option(name, value, help).required();
}

parsed_option command_parser::optional_argument(const std::string& name, const option_value& value,
                                                const std::string& help) const {
    return option(name, value, help);
}

parsed_option command_parser::option(const std::string& names, const option_value& value,
                                     const std::string& help) const {
    const std::pair<std::string, std::string> parts = without_value(names);
    const auto add = [&]<class Value>(const Value& to) {
        if constexpr (std::is_pointer_v<Value>)
            return command_->add_option(parts.first, *to, help);
        else
            return command_->add_option_function<std::string>(parts.first, to, help);
    };
    // An argument's name stands for its value.
    return parsed_option(*std::visit(add, value)->type_name(parts.second));
}

parsed_option command_parser::flag(const std::string& name, std::variant<bool*, std::string*> value,
                                   const std::string& help) const {
    const std::pair<std::string, std::string> parts = without_value(name);
    CLI::Option* const option = std::visit([&](auto* to) { return command_->add_flag(parts.first, *to, help); }, value);
    return parsed_option(parts.second.empty() ? *option : *option->option_text(parts.second));
}

void command_parser::footer(const std::string& text) const {
    command_->footer(text);
}

void command_parser::footer(const std::function<std::string()>& text) const {
    command_->footer(text);
}

void command_parser::callback(const std::function<int()>& act) const {
    command_->callback([command = command_, status = status_, act] {
        if (command->get_subcommands().empty()) *status = act();
    });
}

}  // namespace aabblab
