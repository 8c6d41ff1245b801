/// Files of a folder as one: tar, compressed by xz, so that any system can open it without us.
export module aabblab.archive;

import aabb.std;
import aabblab.processes;

export namespace aabblab {

/// Writes files of a folder into an archive, in which they stand below the folder `top`. The same files give the same
/// bytes: who packed them, where and when is not in it.
/// @param files as the folder has them, such as "c1/results.csv"
/// @throws aabb::input_error where a file cannot be read or written.
void write_archive(const std::filesystem::path& archive, const std::string& top, const std::filesystem::path& folder,
                   std::span<const std::filesystem::path> files);

/// How much an archive may hold, so that a small one cannot fill the disk, nor take hours.
struct archive_limits {
    std::size_t files = 10'000;  ///< and as many folders, each of which holds one at least
    std::uint64_t bytes = std::uint64_t{4} << 30U;
};

/// The files of an archive in a folder that is gone with this, and with this process, by whatever signal it ends.
class unpacked_archive {
public:
    /// @throws aabb::input_error where it is no such archive, cut off, larger than that, or has anything but files
    /// below `top`, each once: no links, no way out of the folder.
    unpacked_archive(const std::filesystem::path& archive, const std::string& top, const archive_limits& limits = {});

    [[nodiscard]] const std::filesystem::path& folder() const { return guard_.folder(); }

private:
    folder_guard guard_;
};

}  // namespace aabblab
