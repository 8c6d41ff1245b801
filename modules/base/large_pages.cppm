module;
#include <new>

export module aabb.base:large_pages;

import aabb.std;

namespace aabb::detail {

inline constexpr std::size_t large_alignment = 64;

[[nodiscard]] void* take_large(std::size_t bytes);
void give_large(void* memory) noexcept;

}  // namespace aabb::detail

export namespace aabb {

/// Memory of TBB for arrays from 128 KiB on. Of up to 64 MiB it keeps what is given back for whoever asks next: the
/// system clears each page before it gives it, and threads that ask at once wait for each other. TBB's
/// `scalable_allocation_command` gives back what it keeps. Arrays from 4 MiB on stand in pages of 2 MiB where the
/// system gives them to those who ask, as Linux does: what is written here and there over many megabytes misses the
/// processor's table of pages less often. Smaller arrays get ordinary memory.
template <class T>
struct large_pages {
    using value_type = T;
    static_assert(alignof(T) <= detail::large_alignment);

    constexpr large_pages() noexcept = default;
    template <class U>
    constexpr large_pages(const large_pages<U>&) noexcept {}

    [[nodiscard]] static constexpr T* allocate(std::size_t n) {
        if (is_large(n)) return static_cast<T*>(detail::take_large(n * sizeof(T)));
        return std::allocator<T>().allocate(n);
    }
    static constexpr void deallocate(T* memory, std::size_t n) noexcept {
        if (is_large(n)) return detail::give_large(memory);
        std::allocator<T>().deallocate(memory, n);
    }

    /// Where nothing is said, nothing is written: what follows a `resize` fills it anyway.
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
    /// A vector never asks for more than its `max_size`, so the product holds.
    static constexpr bool is_large(std::size_t n) noexcept { return n >= (std::size_t{128} << 10) / sizeof(T); }
};

/// A vector in such memory. `resize`, and a constructor that is told a size alone, leave its elements unwritten.
template <class T>
using large_vector = std::vector<T, large_pages<T>>;

}  // namespace aabb
