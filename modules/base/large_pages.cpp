module;
#include <oneapi/tbb/scalable_allocator.h>
#include <cstddef>
#include <cstdlib>
#include <new>
#if defined(__linux__)
#include <sys/mman.h>
#endif

module aabb.base;

namespace aabb::detail {

namespace {

constexpr std::size_t page = std::size_t{2} << 20;
constexpr std::size_t cache_line = 64;

#if __has_feature(address_sanitizer)
// It watches the bounds of what malloc gives.
void* take(std::size_t bytes, std::size_t alignment) {
    return std::aligned_alloc(alignment, (bytes + alignment - 1) / alignment * alignment);
}
void give(void* memory) noexcept {
    std::free(memory);
}
#else
void* take(std::size_t bytes, std::size_t alignment) {
    return scalable_aligned_malloc(bytes, alignment);
}
void give(void* memory) noexcept {
    scalable_aligned_free(memory);
}
#endif

}  // namespace

void* take_large(std::size_t bytes) {
    const bool in_large_pages = bytes >= 2 * page;
    void* const memory = take(bytes, in_large_pages ? page : cache_line);
    if (memory == nullptr) throw std::bad_alloc();
#if defined(__linux__)
    // Only asked for: where it is refused, pages are small and nothing else differs.
    if (in_large_pages) static_cast<void>(madvise(memory, bytes, MADV_HUGEPAGE));
#endif
    return memory;
}

void give_large(void* memory) noexcept {
    give(memory);
}

}  // namespace aabb::detail
