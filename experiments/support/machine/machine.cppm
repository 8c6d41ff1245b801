/// The machine that measures, as Linux tells it.
export module aabblab.machine;

import aabb.std;

export namespace aabblab {

struct machine {
    std::string processor = "unknown";            ///< its model
    std::map<std::string, std::uint64_t> caches;  ///< bytes of each that its first core has: "L1d", "L1i", "L2", …
    std::size_t processors = 0;                   ///< that the system runs on
    std::string kernel;                           ///< "Linux 6.1.0-18-amd64 x86_64"
    std::string libc;                             ///< "glibc 2.36"
    std::optional<std::string> governor;          ///< of the first core's frequency; a guest often cannot tell
    std::optional<bool> hypervisor;               ///< whether the processor says that it is virtual, where it says so
};

/// @param root where proc/ and sys/ are
[[nodiscard]] machine this_machine(const std::filesystem::path& root = "/");

}  // namespace aabblab
