#pragma once

import aabb.pipeline;
import aabb.registry;
import aabb.std;
import aabblab.queries;

namespace aabblab {

class command_parser;

/// Options that say who searches: the strategies of some stages, one a kind, and an engine in place of the last stage.
class method_options {
public:
    explicit method_options(std::vector<aabb::stage> stages) : stages_(std::move(stages)) {}

    /// @param in_place of what an engine stands
    void add_to(const command_parser& command, const std::string& in_place);
    /// @param geometry what the triangles of pairs have in common is wanted too
    /// @throws aabb::input_error on what is not a strategy with its parameters, beside an engine on what it stands in
    /// for, and on what makes no sense together, so that all this is refused before anything is read.
    [[nodiscard]] search_choice choice(bool geometry = false) const;

private:
    std::vector<aabb::stage> stages_;
    aabb::by_kind<std::optional<std::string>> given_;
    std::optional<std::string> engine_;
};

/// "median, mean, …", for help texts.
[[nodiscard]] std::string names_in_line(aabb::strategy_kind kind);

}  // namespace aabblab
