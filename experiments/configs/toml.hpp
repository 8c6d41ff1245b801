#pragma once

// Makes toml++ safe for untrusted text: malformed text can fail its assertions, which aborts the program, or causes
// undefined behaviour if NDEBUG is defined. Here a failed assertion throws.
#undef NDEBUG

namespace aabblab {

struct failed_toml_assertion {};

inline void require_toml(bool holds) {
    if (!holds) throw failed_toml_assertion();
}

}  // namespace aabblab

#define TOML_ASSERT(expression) ::aabblab::require_toml(static_cast<bool>(expression))
// The maximum nesting of tables and lists; a config needs three levels.
#define TOML_MAX_NESTED_VALUES 16

#include <toml++/toml.h>
