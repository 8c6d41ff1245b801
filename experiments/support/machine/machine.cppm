/// Describes the machine that runs the benchmark, from information of Linux.
export module aabblab.machine;

import aabb.std;

export namespace aabblab {

struct machine {
    std::string processor = "unknown";            ///< the model
    std::map<std::string, std::uint64_t> caches;  ///< bytes per cache of the first core: "L1d", "L1i", "L2", …
    std::size_t processors = 0;                   ///< the number of logical processors
    std::string kernel;                           ///< "Linux 6.1.0-18-amd64 x86_64"
    std::string libc;                             ///< "glibc 2.36"
    std::optional<std::string> governor;          ///< of the first core's frequency; guests often lack it
    std::optional<bool> hypervisor;               ///< true if the processor reports virtualisation
};

/// @param root the folder of proc/ and sys/
[[nodiscard]] machine this_machine(const std::filesystem::path& root = "/");

}  // namespace aabblab
