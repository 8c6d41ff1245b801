module;
#include <functional>
#include <optional>
#include <string>

/// Work that may take too long or too much memory.
export module aabblab.race:apart;

export namespace aabblab {

/// What the work returns, done in a copy of this process. Nothing where it takes more than so many seconds, throws, or
/// ends the copy.
[[nodiscard]] std::optional<std::string> done_apart(const std::function<std::string()>& work, double seconds);

}  // namespace aabblab
