module;
#include <fmt/ranges.h>

/// The library {fmt} as a module.
export module aabblab.fmt;

export namespace fmt {
using fmt::format, fmt::format_to, fmt::join, fmt::runtime;
}
