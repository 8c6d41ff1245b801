#pragma once

#include <optional>
#include <string>
#include <vector>

namespace CLI {
class App;
}

import aabb;
import aabb.registry;

namespace aabblab {

/// Options of a command that compose a global search.
struct global_options {
    std::optional<std::string> sort, partition, sweep, split_large;

    void add_to(CLI::App& command);
    [[nodiscard]] bool any() const { return sort || partition || sweep || split_large; }
    /// @throws aabb::input_error on what is not a strategy with its parameters.
    [[nodiscard]] aabb::global_composition composition() const;
};

/// Options of a command that compose a local detection.
struct local_options {
    std::optional<std::string> tree, triangle;

    void add_to(CLI::App& command);
    [[nodiscard]] bool any() const { return tree || triangle; }
    /// @throws aabb::input_error on what is not a strategy with its parameters.
    [[nodiscard]] aabb::local_composition composition() const;
};

/// Meshes by the names that the user gave them; what was fanned, dropped or rounded is said.
[[nodiscard]] std::vector<aabb::mesh> read_meshes(const std::vector<std::string>& names);

/// Refuses to write over a mesh that the same command reads, here or in the data folder.
/// @throws aabb::input_error where `out` is one of them, by whatever path.
void require_no_mesh(const std::string& out, const std::vector<std::string>& meshes);

}  // namespace aabblab
