module;
#include <list>

/// The files of a reproduction's folder from which its report is made, and the check that they are unaltered.
export module aabblab.record;

import aabb.std;
import aabblab.archive;

export namespace aabblab {

/// The folder of these files in an archive.
inline constexpr const char* archive_folder = "reproduction";
inline constexpr const char* sums_name = "SHA256SUMS";

[[nodiscard]] std::vector<std::string> recorded_experiments(const std::filesystem::path& folder);
/// The names of the studies of error against run time, finished or not, sorted.
[[nodiscard]] std::vector<std::string> recorded_studies(const std::filesystem::path& folder);

/// The files of an archive, relative to the folder: those that a judgement reads, and SHA256SUMS if it exists.
[[nodiscard]] std::vector<std::filesystem::path> archived_files(const std::filesystem::path& folder);

/// Seals a finished run: writes SHA256SUMS, with every file that a judgement reads except the tables of results, whose
/// checksums are in their manifests, since their rows may have any order.
void seal_record(const std::filesystem::path& folder);
/// Unseals a run before it begins.
inline void unseal_record(const std::filesystem::path& folder) {
    std::filesystem::remove(folder / sums_name);
}
[[nodiscard]] inline bool is_sealed_record(const std::filesystem::path& folder) {
    return std::filesystem::exists(folder / sums_name);
}
/// The seal of a sealed run, which identifies it: only copies have the same seal.
[[nodiscard]] std::string seal_of_record(const std::filesystem::path& folder);

/// Checks that a sealed run has exactly the sealed files, unaltered except for line endings.
/// @throws aabb::input_error otherwise.
void verify_record(const std::filesystem::path& folder);

/// The folder of the small atlas, which the report includes.
[[nodiscard]] inline std::filesystem::path folder_of_atlas(const std::filesystem::path& folder) {
    return folder / "atlas";
}

struct results_source {
    std::string name;  ///< as given by the user
    std::filesystem::path folder;
};

/// The folders of results to judge; archives are unpacked to temporary folders, which the destructor removes.
class results_sources {
public:
    /// @param names folders and archives
    /// @throws aabb::input_error if one is missing, or is no such archive.
    explicit results_sources(std::span<const std::string> names);
    void add(const std::filesystem::path& folder);

    [[nodiscard]] const std::vector<results_source>& list() const { return sources_; }
    /// Runs the work; if it rejects a file of an archive, the message has the archive's name.
    [[nodiscard]] int run_with_source_names(const std::function<int()>& work) const;

private:
    std::list<unpacked_archive> unpacked_;
    std::vector<results_source> sources_;
};

/// The claims' file of a run, as it was when the run was measured.
inline constexpr const char* stated_name = "endpoints.toml";

inline constexpr const char* unsealed_note =
    "the results are not sealed: the run was not finished, is of an earlier version, or lost its SHA256SUMS. Missing "
    "or altered rows would not be noticed";

}  // namespace aabblab
