module;
#include <fmt/format.h>
#include <unistd.h>

module aabblab.files;

import aabb.base;
import :file_text;

namespace aabblab {

namespace {

std::string size_text(double bytes) {
    if (bytes >= 0x1p30) return fmt::format("{:.1f} GiB", bytes * 0x1p-30);
    if (bytes >= 0x1p20) return fmt::format("{:.1f} MiB", bytes * 0x1p-20);
    if (bytes >= 0x1p10) return fmt::format("{:.1f} KiB", bytes * 0x1p-10);
    return fmt::format("{:.0f} bytes", bytes);
}

}  // namespace

std::array<std::string, 2> different_sizes(double a, double b) {
    if (size_text(a) != size_text(b)) return {size_text(a), size_text(b)};
    return {fmt::format("{:.0f} bytes", a), fmt::format("{:.0f} bytes", b)};
}

void require_memory(const std::string& what, double bytes) {
    const double memory = static_cast<double>(sysconf(_SC_PHYS_PAGES)) * static_cast<double>(sysconf(_SC_PAGE_SIZE));
    if (bytes <= memory) return;
    const auto [wanted, there] = different_sizes(bytes, memory);
    throw aabb::input_error(what + " would take " + wanted + " of memory, but this machine has " + there);
}

}  // namespace aabblab
