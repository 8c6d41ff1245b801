#pragma once

#include <cstddef>

/// All allocations of the process, as counted by this program's operators new.
struct allocation_log {
    std::size_t made = 0;
    std::size_t alive = 0;
    std::size_t fails_in = 0;  ///< the n-th from now on throws std::bad_alloc, once; 0 for none
};
inline allocation_log allocations;
