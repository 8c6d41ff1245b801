module;
#include <unistd.h>

#include <array>
#include <cstdio>
#include <string>

module aabblab.files;

import aabb;

namespace aabblab {

void require_memory(const std::string& what, double bytes) {
    const double memory = static_cast<double>(sysconf(_SC_PHYS_PAGES)) * static_cast<double>(sysconf(_SC_PAGE_SIZE));
    if (bytes <= memory) return;
    std::array<char, 96> sizes{};
    std::snprintf(sizes.data(), sizes.size(), " would take %.1f GiB of memory, but this machine has %.1f",
                  bytes * 0x1p-30, memory * 0x1p-30);
    throw aabb::input_error(what + sizes.data());
}

}  // namespace aabblab
