#pragma once

namespace CLI {
class App;
}

/// What stands below `validate`.
namespace aabblab {

void add_validate_stiff(CLI::App& validate, int& status);

}  // namespace aabblab
