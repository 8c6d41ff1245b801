module;
#include <cassert>

export module aabb.base:append_whole;

import aabb.std;

export namespace aabb {

/// Calls `append`, which appends to a list; when it throws, what it had appended is taken back.
template <class T, class Allocator, class Append>
void append_whole(std::vector<T, Allocator>& list, Append append) {
    const std::size_t before = list.size();
    try {
        append();
    } catch (...) {
        list.resize(before);
        throw;
    }
    assert(list.size() >= before);
}

}  // namespace aabb
