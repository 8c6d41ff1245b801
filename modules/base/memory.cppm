export module aabb.base:memory;

import aabb.std;

export namespace aabb {

/// The base of polymorphic interfaces: not copyable, with a virtual destructor.
struct kept_in_place {
    kept_in_place() = default;
    kept_in_place(const kept_in_place&) = delete;
    kept_in_place& operator=(const kept_in_place&) = delete;
    virtual ~kept_in_place() = default;
};

/// Heap bytes of a part; 0 for a part without `bytes()`, which owns no heap memory.
template <class Part>
[[nodiscard]] constexpr std::size_t bytes_of(const Part& part) {
    if constexpr (requires { part.bytes(); })
        return part.bytes();
    else
        return 0;
}

/// Heap bytes of a vector's own array.
template <class T, class Allocator>
[[nodiscard]] constexpr std::size_t bytes_of(const std::vector<T, Allocator>& v) {
    return v.capacity() * sizeof(T);
}

/// The sum over several parts.
template <class T, std::size_t N>
[[nodiscard]] constexpr std::size_t bytes_of(const std::array<T, N>& parts) {
    std::size_t total = 0;
    for (const T& part : parts) total += bytes_of(part);
    return total;
}
template <class... Parts>
    requires(sizeof...(Parts) > 1)
[[nodiscard]] constexpr std::size_t bytes_of(const Parts&... parts) {
    return (bytes_of(parts) + ...);
}

/// Empties a vector and frees its memory.
template <class T, class Allocator>
constexpr void release(std::vector<T, Allocator>& v) {
    std::vector<T, Allocator>().swap(v);
}

}  // namespace aabb
