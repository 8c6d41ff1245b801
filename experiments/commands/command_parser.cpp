#include "command_parser.hpp"

#include <CLI/CLI.hpp>

#include <cstddef>
#include <functional>
#include <optional>
#include <string>
#include <vector>

import aabb.base;

namespace aabblab {

namespace {

void require_alone(const CLI::App& command, const CLI::App& inner) {
    for (const CLI::Option* option : command.get_options())
        if (option->count() > 0)
            throw aabb::input_error(command.get_name() + ": " + option->get_name() + " has no part in '" +
                                    inner.get_name() + "'; what it takes stands behind its name");
}

}  // namespace

parsed_option parsed_option::required() const {
    option_->required();
    return *this;
}

parsed_option parsed_option::type_name(const std::string& name) const {
    option_->type_name(name);
    return *this;
}

parsed_option parsed_option::option_text(const std::string& text) const {
    option_->option_text(text);
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
    return command_parser(*command_->add_subcommand(name, help));
}

parsed_option command_parser::add_option(const std::string& names, std::string& value, const std::string& help) const {
    return parsed_option(*command_->add_option(names, value, help));
}

parsed_option command_parser::add_option(const std::string& names, std::optional<std::string>& value,
                                         const std::string& help) const {
    return parsed_option(*command_->add_option(names, value, help));
}

parsed_option command_parser::add_option(const std::string& names, std::optional<std::size_t>& value,
                                         const std::string& help) const {
    return parsed_option(*command_->add_option(names, value, help));
}

parsed_option command_parser::add_option(const std::string& names, std::vector<std::string>& values,
                                         const std::string& help) const {
    return parsed_option(*command_->add_option(names, values, help));
}

parsed_option command_parser::add_option(const std::string& names, const std::function<void(const std::string&)>& take,
                                         const std::string& help) const {
    return parsed_option(*command_->add_option_function<std::string>(names, take, help));
}

parsed_option command_parser::add_flag(const std::string& names, bool& given, const std::string& help) const {
    return parsed_option(*command_->add_flag(names, given, help));
}

parsed_option command_parser::add_flag(const std::string& names, std::string& value, const std::string& help) const {
    return parsed_option(*command_->add_flag(names, value, help));
}

void command_parser::footer(const std::string& text) const {
    command_->footer(text);
}

void command_parser::footer(const std::function<std::string()>& text) const {
    command_->footer(text);
}

void command_parser::callback(const std::function<void()>& act) const {
    command_->callback(act);
}

void command_parser::allow_one_command() const {
    command_->require_subcommand(0, 1);
    for (CLI::App* inner : command_->get_subcommands([](const CLI::App*) { return true; }))
        inner->preparse_callback([command = command_, inner](std::size_t) { require_alone(*command, *inner); });
}

bool command_parser::any_command_given() const {
    return !command_->get_subcommands().empty();
}

}  // namespace aabblab
