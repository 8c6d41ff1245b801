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

}  // namespace aabblab
