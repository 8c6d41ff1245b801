module;
#include <oneapi/tbb/scalable_allocator.h>
#if defined(__linux__)
#include <sys/mman.h>
#endif

module aabb.base;

namespace aabb::detail {

namespace {

constexpr std::size_t huge_page = std::size_t{2} << 20;

#if __has_feature(address_sanitizer) || __has_feature(memory_sanitizer) || __has_feature(thread_sanitizer)
// Sanitizers only check memory from malloc.
void* allocate_aligned(std::size_t bytes, std::size_t alignment) {
    void* memory = nullptr;
    return posix_memalign(&memory, alignment, bytes) == 0 ? memory : nullptr;
}
void free_aligned(void* memory) noexcept {
    std::free(memory);
}
#else
void* allocate_aligned(std::size_t bytes, std::size_t alignment) {
    return scalable_aligned_malloc(bytes, alignment);
}
void free_aligned(void* memory) noexcept {
    scalable_aligned_free(memory);
}
#endif

}  // namespace

/// Memory for a long array, in huge pages of 2 MiB if it fills two of them, so that scattered writes cause fewer TLB
/// misses. Aligned to a page of that size, or else to a cache line.
/// @throws std::bad_alloc
void* allocate_large(std::size_t bytes) {
    const bool in_huge_pages = bytes >= 2 * huge_page;
    void* const memory = allocate_aligned(bytes, in_huge_pages ? huge_page : large_alignment);
    if (memory == nullptr) throw std::bad_alloc();
#if defined(__linux__)
    // Only a hint: if it fails, pages are small and nothing else changes.
    if (in_huge_pages) static_cast<void>(madvise(memory, bytes, MADV_HUGEPAGE));
#endif
    return memory;
}

void free_large(void* memory) noexcept {
    free_aligned(memory);
}

}  // namespace aabb::detail
