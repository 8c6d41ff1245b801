#pragma once

// toml++, made safe for text that nobody has checked: it asserts what malformed text can break, which aborts the
// program, or is undefined where NDEBUG is defined. Here a failed assertion throws.
#undef NDEBUG

namespace aabblab {

struct failed_toml_assertion {};

inline void require_toml(bool holds) {
    if (!holds) throw failed_toml_assertion();
}

}  // namespace aabblab

#define TOML_ASSERT(expression) ::aabblab::require_toml(static_cast<bool>(expression))
// Tables and lists in each other; a config needs three.
#define TOML_MAX_NESTED_VALUES 16

#include <toml++/toml.h>
