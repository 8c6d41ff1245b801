export module aabb.geometry:contact;

import aabb.std;

export namespace aabb {

/// Two triangles of two objects that intersect; a < b are objects.
struct contact {
    std::uint32_t a;
    std::uint32_t b;
    std::uint32_t triangle_a;
    std::uint32_t triangle_b;

    friend constexpr auto operator<=>(const contact&, const contact&) = default;
};

}  // namespace aabb
