#include "temporary_folder.hpp"

import aabblab.machine;

TEST_CASE("A machine is described from /proc and /sys: processor, caches, governor and hypervisor") {
    const temporary_folder root;
    root.write("proc/cpuinfo",
               "processor\t: 0\nmodel name\t: A Processor @ 2.40GHz\nflags\t\t: fpu hypervisor sse\n\n"
               "processor\t: 1\nmodel name\t: A Processor @ 2.40GHz\nflags\t\t: fpu hypervisor sse\n");
    const std::string core = "sys/devices/system/cpu/cpu0/";
    const auto write_cache = [&](const std::string& index, const char* level, const char* type, const char* size) {
        root.write(core + "cache/index" + index + "/level", std::string(level) + "\n");
        root.write(core + "cache/index" + index + "/type", std::string(type) + "\n");
        root.write(core + "cache/index" + index + "/size", std::string(size) + "\n");
    };
    write_cache("0", "1", "Data", "48K");
    write_cache("1", "1", "Instruction", "32K");
    write_cache("2", "2", "Unified", "2M");
    root.write(core + "cpufreq/scaling_governor", "performance\n");
    const aabblab::machine m = aabblab::this_machine(root.path());
    CHECK(m.processor == "A Processor @ 2.40GHz");
    CHECK(m.processors == 2);
    CHECK(m.caches.size() == 3);
    CHECK(m.caches.at("L1d") == 48 * 1024);
    CHECK(m.caches.at("L1i") == 32 * 1024);
    CHECK(m.caches.at("L2") == 2 * 1024 * 1024);
    CHECK(m.governor == "performance");
    CHECK(m.hypervisor == true);
}

TEST_CASE("Machine properties that the system does not report stay unknown") {
    const temporary_folder empty_root;
    const aabblab::machine m = aabblab::this_machine(empty_root.path());
    CHECK(m.processor == "unknown");
    CHECK(m.caches.empty());
    CHECK(!m.governor);
    CHECK(!m.hypervisor);
    CHECK(m.kernel.starts_with("Linux "));
    CHECK(!m.libc.empty());
}
