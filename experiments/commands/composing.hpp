#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

import aabb.geometry;
import aabb.registry;

namespace aabblab {

class command_parser;

/// Options of a command that compose a stage, one a kind of strategy.
class stage_options {
public:
    explicit stage_options(aabb::stage stage) : stage_(stage) {}

    void add_to(const command_parser& command);
    [[nodiscard]] bool any() const;
    /// "--sort, --partition and --sweep".
    [[nodiscard]] std::string names() const;
    /// @throws aabb::input_error on what is not a strategy with its parameters.
    void add_to(aabb::named_strategies& named) const;

private:
    [[nodiscard]] std::vector<aabb::strategy_kind> kinds() const;

    aabb::stage stage_;
    aabb::by_kind<std::optional<std::string>> given_;
};

/// "median, mean, …", for help texts.
[[nodiscard]] std::string names_in_line(aabb::strategy_kind kind);

/// Reads those meshes that are files, and says what of each is left out. Names are looked for as scenes do.
void note_left_out(const std::vector<std::string>& names, const std::filesystem::path& folder = {});

/// Meshes by the names that the user gave them; what was done to them is said.
[[nodiscard]] std::vector<aabb::mesh> read_meshes(const std::vector<std::string>& names);

/// Refuses to write over a mesh that the same command reads, here or in the data folder.
/// @throws aabb::input_error where `out` is one of them, by whatever path.
void require_no_mesh(const std::string& out, const std::vector<std::string>& meshes);

}  // namespace aabblab
