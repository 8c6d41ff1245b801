export module aabb.base:memory;

import aabb.std;

export namespace aabb {

/// Base of what is used by its address: it is not copied, and goes whole by whichever base it is held.
struct kept_in_place {
    kept_in_place() = default;
    kept_in_place(const kept_in_place&) = delete;
    kept_in_place& operator=(const kept_in_place&) = delete;
    virtual ~kept_in_place() = default;
};

/// Heap bytes a part holds; 0 for one that holds none and so need not say.
template <class Part>
[[nodiscard]] constexpr std::size_t bytes_of(const Part& part) {
    if constexpr (requires { part.bytes(); })
        return part.bytes();
    else
        return 0;
}

/// Heap bytes behind a vector.
template <class T, class Allocator>
[[nodiscard]] constexpr std::size_t bytes_of(const std::vector<T, Allocator>& v) {
    return v.capacity() * sizeof(T);
}

/// Of several such parts.
template <class T, std::size_t N>
[[nodiscard]] constexpr std::size_t bytes_of(const std::array<T, N>& parts) {
    std::size_t all = 0;
    for (const T& part : parts) all += bytes_of(part);
    return all;
}
template <class... Parts>
    requires(sizeof...(Parts) > 1)
[[nodiscard]] constexpr std::size_t bytes_of(const Parts&... parts) {
    return (bytes_of(parts) + ...);
}

/// Empties a vector and gives its memory back.
template <class T, class Allocator>
constexpr void release(std::vector<T, Allocator>& v) {
    std::vector<T, Allocator>().swap(v);
}

}  // namespace aabb
