#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>
#include <list>
#include <span>
#include <string>
#include <vector>

import aabblab.archive;

// Imports modules, so it is included after every other header.

/// Results of `reproduce` on their way from machine to machine.
namespace aabblab {

struct results_source {
    std::string name;  ///< as the user gave it
    std::filesystem::path folder;
};

/// Results to be judged, each in a folder; those of archives in temporary ones, gone with this.
class source_list {
public:
    /// @param names of folders and archives
    /// @throws aabb::input_error where one is not there, or is no such archive.
    explicit source_list(std::span<const std::string> names);
    void add(const std::filesystem::path& folder);

    [[nodiscard]] const std::vector<results_source>& all() const { return all_; }
    /// Does the work; where it refuses a file of an archive, the sentence has the archive's name.
    [[nodiscard]] int with_names_of_user(const std::function<int()>& work) const;

private:
    std::list<unpacked_archive> unpacked_;
    std::vector<results_source> all_;
};

/// Of results of `reproduce` that were finished: whatever is read of them is as the run left it.
/// @returns false where they are not sealed, so that nothing shows that
/// @throws aabb::input_error where it is not so.
bool verify_source(const std::filesystem::path& folder);

/// Packs what a judgement reads, and says how large it is and what its checksum is.
void archive_reproduction(const std::filesystem::path& folder, const std::filesystem::path& file);

}  // namespace aabblab
