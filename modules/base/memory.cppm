export module aabb.base:memory;

import aabb.std;

export namespace aabb {

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

/// Empties a vector and gives its memory back.
template <class T, class Allocator>
constexpr void release(std::vector<T, Allocator>& v) {
    std::vector<T, Allocator>().swap(v);
}

}  // namespace aabb
