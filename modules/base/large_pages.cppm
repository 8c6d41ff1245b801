module;
#include <new>

export module aabb.base:large_pages;

import aabb.std;

namespace aabb::detail {

inline constexpr std::size_t large_alignment = 64;

[[nodiscard]] void* allocate_large(std::size_t bytes);
void free_large(void* memory) noexcept;

}  // namespace aabb::detail

export namespace aabb {

/// An allocator that takes arrays from 128 KiB on from TBB, and smaller ones from the standard allocator. TBB caches
/// freed blocks of up to 64 MiB, since the system clears each new page and serializes concurrent requests;
/// `scalable_allocation_command` empties that cache. Arrays from 4 MiB on use huge pages of 2 MiB where the system
/// offers them on request, as Linux does, so that scattered writes over many megabytes cause fewer TLB misses.
template <class T>
struct large_pages {
    using value_type = T;
    static_assert(alignof(T) <= detail::large_alignment);

    constexpr large_pages() noexcept = default;
    template <class U>
    constexpr large_pages(const large_pages<U>&) noexcept {}

    [[nodiscard]] static constexpr T* allocate(std::size_t n) {
        if (is_large(n)) return static_cast<T*>(detail::allocate_large(n * sizeof(T)));
        return std::allocator<T>().allocate(n);
    }
    static constexpr void deallocate(T* memory, std::size_t n) noexcept {
        if (is_large(n)) return detail::free_large(memory);
        std::allocator<T>().deallocate(memory, n);
    }

    /// Default-initializes elements without writing them, since the code after a `resize` fills them anyway.
    template <class U>
    static constexpr void construct(U* at) noexcept {
        static_assert(std::is_trivially_default_constructible_v<U>);
        ::new (static_cast<void*>(at)) U;
    }
    template <class U, class... From>
    static constexpr void construct(U* at, From&&... from) {
        std::construct_at(at, std::forward<From>(from)...);
    }

    friend constexpr bool operator==(const large_pages&, const large_pages&) noexcept { return true; }

private:
    /// No overflow in `allocate`, since a vector never requests more than its `max_size`.
    static constexpr bool is_large(std::size_t n) noexcept { return n >= (std::size_t{128} << 10) / sizeof(T); }
};

/// A vector with this allocator. `resize`, and the constructor from a size, leave elements uninitialized.
template <class T>
using large_vector = std::vector<T, large_pages<T>>;

}  // namespace aabb
