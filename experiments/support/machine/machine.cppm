module;
#include <sys/utsname.h>

#if defined(__GLIBC__)
#include <gnu/libc-version.h>
#endif

/// Describes the machine that runs the benchmark, from information of Linux.
export module aabblab.machine;

import aabb.std;

namespace aabblab {

export struct machine {
    std::string processor = "unknown";            ///< the model
    std::map<std::string, std::uint64_t> caches;  ///< bytes per cache of the first core: "L1d", "L1i", "L2", …
    std::size_t processors = 0;                   ///< the number of logical processors
    std::string kernel;                           ///< "Linux 6.1.0-18-amd64 x86_64"
    std::string libc;                             ///< "glibc 2.36"
    std::optional<std::string> governor;          ///< of the first core's frequency; guests often lack it
    std::optional<bool> hypervisor;               ///< true if the processor reports virtualisation
};

/// The first line of a file; empty if the file is missing.
std::optional<std::string> line_of(const std::filesystem::path& file) {
    std::ifstream in(file);
    std::string line;
    return std::getline(in, line) ? std::optional(line) : std::nullopt;
}

/// Parses the size of a cache, in bytes: "32K" means 32 KiB; nullopt if it begins with no number.
std::optional<std::uint64_t> bytes_of(const std::string& size) {
    std::uint64_t number = 0;
    const char* end = size.data() + size.size();
    const auto [unit, error] = std::from_chars(size.data(), end, number);
    if (error != std::errc{}) return std::nullopt;
    if (unit == end) return number;
    return *unit == 'K' ? number << 10U : *unit == 'M' ? number << 20U : *unit == 'G' ? number << 30U : number;
}

/// Bytes by cache ("L1d", "L1i", "L2"), from Linux's folders index0, index1, … with files level, size and type.
std::map<std::string, std::uint64_t> caches_in(const std::filesystem::path& folder) {
    std::map<std::string, std::uint64_t> caches;
    for (int i = 0;; ++i) {
        const std::filesystem::path cache = folder / ("index" + std::to_string(i));
        const auto level = line_of(cache / "level");
        const auto size = line_of(cache / "size");
        if (!level || !size) return caches;
        const std::string type = line_of(cache / "type").value_or("");
        if (const auto bytes = bytes_of(*size))
            caches["L" + *level + (type == "Data" ? "d" : type == "Instruction" ? "i" : "")] = *bytes;
    }
}

/// Reads from /proc/cpuinfo the number and model of processors, and whether they report a hypervisor.
void read_cpuinfo(const std::filesystem::path& file, machine& m) {
    std::ifstream in(file);
    for (std::string line; std::getline(in, line);) {
        const std::size_t colon = line.find(':');
        if (colon == std::string::npos) continue;
        const std::string name = line.substr(0, line.find_last_not_of(" \t", colon - 1) + 1);
        const std::string value = colon + 2 <= line.size() ? line.substr(colon + 2) : "";
        if (name == "processor") ++m.processors;
        if (name == "model name") m.processor = value;
        if (name == "flags") m.hypervisor = (" " + value + " ").find(" hypervisor ") != std::string::npos;
    }
}

std::string kernel() {
    utsname names{};
    if (uname(&names) != 0) return "unknown";
    return std::string(names.sysname) + " " + names.release + " " + names.machine;
}

std::string libc() {
#if defined(__GLIBC__)
    return std::string("glibc ") + gnu_get_libc_version();
#else
    return "unknown";
#endif
}

/// Describes the machine.
/// @param root the folder of proc/ and sys/
export [[nodiscard]] machine this_machine(const std::filesystem::path& root = "/") {
    machine m;
    const std::filesystem::path core = root / "sys/devices/system/cpu/cpu0";
    read_cpuinfo(root / "proc/cpuinfo", m);
    m.caches = caches_in(core / "cache");
    m.kernel = kernel();
    m.libc = libc();
    m.governor = line_of(core / "cpufreq/scaling_governor");
    return m;
}

}  // namespace aabblab
