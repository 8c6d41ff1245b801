module;
#include <cstddef>
#include <new>
#if defined(__linux__)
#include <sys/mman.h>
#endif

module aabb.base;

namespace aabb::detail {

namespace {

constexpr std::align_val_t page{std::size_t{2} << 20};

}  // namespace

void* take_large_pages(std::size_t bytes) {
    void* const memory = ::operator new(bytes, page);
#if defined(__linux__)
    // Only asked for: where it is refused, pages are small and nothing else differs.
    static_cast<void>(madvise(memory, bytes, MADV_HUGEPAGE));
#endif
    return memory;
}

void give_large_pages(void* memory, std::size_t bytes) noexcept {
    ::operator delete(memory, bytes, page);
}

}  // namespace aabb::detail
