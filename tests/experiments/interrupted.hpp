#pragma once

#include "program_json.hpp"

/// Removes the seal of a finished run, as if it had been interrupted.
inline void unseal(const std::filesystem::path& results) {
    auto manifest = nlohmann::ordered_json::parse(bytes_of_file(results / "manifest.json"));
    manifest.erase("seal");
    std::ofstream(results / "manifest.json") << manifest.dump(2) << "\n";
}
