#include "counted_new.hpp"

import aabb.std;

namespace {

// Stages may use threads. Not std::atomic: <atomic> cannot be included again after a module that has it.

/// Counts memory from malloc, or throws in its place if this allocation is to fail.
void* counted(void* memory) {
    if (allocations.fails_in > 0 && __atomic_sub_fetch(&allocations.fails_in, 1, __ATOMIC_RELAXED) == 0) {
        std::free(memory);  // NOLINT(cppcoreguidelines-no-malloc)
        memory = nullptr;
    }
    if (memory == nullptr) throw std::bad_alloc();
    __atomic_add_fetch(&allocations.made, 1, __ATOMIC_RELAXED);
    __atomic_add_fetch(&allocations.alive, 1, __ATOMIC_RELAXED);
    return memory;
}

void counted_free(void* memory) noexcept {
    if (memory != nullptr) __atomic_sub_fetch(&allocations.alive, 1, __ATOMIC_RELAXED);
    std::free(memory);  // NOLINT(cppcoreguidelines-no-malloc)
}

}  // namespace

// NOLINTBEGIN(cppcoreguidelines-no-malloc)
void* operator new(std::size_t bytes) {
    return counted(std::malloc(bytes ? bytes : 1));
}
void* operator new(std::size_t bytes, std::align_val_t alignment) {
    const auto multiple = static_cast<std::size_t>(alignment);
    return counted(std::aligned_alloc(multiple, (bytes + multiple) / multiple * multiple));
}
// NOLINTEND(cppcoreguidelines-no-malloc)
// The sanitizers' own would not match our delete; std::stable_sort calls it.
void* operator new(std::size_t bytes, const std::nothrow_t&) noexcept {
    try {
        return operator new(bytes);
    } catch (const std::bad_alloc&) {
        return nullptr;
    }
}
void operator delete(void* memory) noexcept {
    counted_free(memory);
}
void operator delete(void* memory, const std::nothrow_t&) noexcept {
    counted_free(memory);
}
void operator delete(void* memory, std::align_val_t) noexcept {
    counted_free(memory);
}
void operator delete(void* memory, std::size_t, std::align_val_t) noexcept {
    counted_free(memory);
}
void operator delete(void* memory, std::size_t) noexcept {
    counted_free(memory);
}
