/// Packs the files of a folder into a tar archive compressed by xz, which standard tools can open.
export module aabblab.archive;

import aabb.std;
import aabblab.processes;

export namespace aabblab {

/// Packs files of a folder into an archive, below the folder `top`. The same files give the same bytes.
/// @param files relative to the folder, such as "c1/results.csv"
/// @param texts further files, by name, with their content
/// @throws aabb::input_error if a file cannot be read or written.
void write_archive(const std::filesystem::path& archive, const std::string& top, const std::filesystem::path& folder,
                   std::span<const std::filesystem::path> files, const std::map<std::string, std::string>& texts = {});

/// Limits on the unpacked contents, so that a small archive cannot fill the disk or take hours.
struct archive_limits {
    std::size_t files = 10'000;  ///< the limit for folders too, as each holds at least one file
    std::uint64_t bytes = std::uint64_t{4} << 30U;
};

/// An archive unpacked into a temporary folder, which is removed on destruction or when a signal ends the process.
class unpacked_archive {
public:
    /// @throws aabb::input_error if the archive is malformed, truncated or beyond the limits, or has anything but
    /// distinct files below `top`: links and paths that leave the folder are rejected.
    unpacked_archive(const std::filesystem::path& archive, const std::string& top, const archive_limits& limits = {});

    [[nodiscard]] const std::filesystem::path& folder() const { return guard_.folder(); }

private:
    folder_guard guard_;
};

}  // namespace aabblab
