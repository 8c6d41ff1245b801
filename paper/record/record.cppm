module;
#include <list>

/// What of a reproduction's folder its report is made from, and whether it is as the run left it.
export module aabblab.record;

import aabb.std;
import aabblab.archive;

export namespace aabblab {

/// The folder that they stand in in an archive.
inline constexpr const char* record_top = "reproduction";

/// The experiments that a folder has, by name.
[[nodiscard]] std::vector<std::string> recorded_experiments(const std::filesystem::path& folder);

/// The files that a judgement reads, relative to the folder, in order.
[[nodiscard]] std::vector<std::filesystem::path> recorded_files(const std::filesystem::path& folder);

/// The same, and SHA256SUMS where there is one: what an archive holds.
[[nodiscard]] std::vector<std::filesystem::path> archived_files(const std::filesystem::path& folder);

/// Of a run that is finished: writes SHA256SUMS, which names every file that a judgement reads but the tables of
/// results, whose checksums stand in their manifests, since their rows may stand in any order.
void seal_record(const std::filesystem::path& folder);
/// Of a run that begins: takes it away.
void unseal_record(const std::filesystem::path& folder);
[[nodiscard]] bool is_sealed_record(const std::filesystem::path& folder);
/// Of a sealed one: the same for copies, and for nothing else.
[[nodiscard]] std::string seal_of_record(const std::filesystem::path& folder);

/// Where it is sealed, every file is there and as it was, whatever the ends of its lines, and no other.
/// @throws aabb::input_error where that is not so.
void verify_record(const std::filesystem::path& folder);

/// The small atlas that stands in the report.
[[nodiscard]] inline std::filesystem::path folder_of_atlas(const std::filesystem::path& folder) {
    return folder / "atlas";
}

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

/// What a report says of results that are not sealed.
inline constexpr const char* unsealed_note =
    "the results are not sealed: the run was not finished, is of an earlier version, or lost its SHA256SUMS, and "
    "nothing shows whether rows are missing or were altered";

/// SHA256SUMS and nothing else has this name.
inline constexpr const char* sums_name = "SHA256SUMS";

}  // namespace aabblab
