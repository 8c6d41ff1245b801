#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

import aabblab.configs;
import aabblab.results;

// Imports modules, so it is included after every other header.

/// What the commands on experiments share.
namespace aabblab {

/// Reads a config and says on standard error what stands in for meshes that are not there.
[[nodiscard]] experiment open_experiment(const std::string& config, bool quick);

/// What is printed while an experiment is played: a table a scene, and one over all scenes at the end; with or without
/// the work of each composition; or nothing.
enum class printed { tables, tables_and_counts, nothing };

/// Plays an experiment into a folder, which it keeps others from writing into, in as many fresh processes as it asks
/// for, and says on standard error what is wrong. At the end a summary.csv stands beside the results. Interrupted
/// (Ctrl-C), it says that `resume_with` continues it.
/// @returns a sentence for each composition that is wrong
[[nodiscard]] std::vector<std::string> play_experiment(const experiment& e, const std::filesystem::path& folder,
                                                       existing_results existing, const std::string& resume_with,
                                                       printed shown);

/// One of these processes: plays its share of the repeats into results that are there. What is wrong goes to standard
/// output, a line each.
/// @returns whether nothing is
[[nodiscard]] bool play_share(const experiment& e, const std::filesystem::path& folder, std::size_t process);

}  // namespace aabblab
