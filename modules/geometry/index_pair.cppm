export module aabb.geometry:index_pair;

import aabb.std;

export namespace aabb {

/// A pair of objects or triangles. Pairs of objects of one scene have a < b.
struct index_pair {
    std::uint32_t a;
    std::uint32_t b;

    friend constexpr auto operator<=>(const index_pair&, const index_pair&) = default;
};

[[nodiscard]] constexpr index_pair ordered_pair(std::uint32_t a, std::uint32_t b) noexcept {
    return a < b ? index_pair{a, b} : index_pair{b, a};
}

/// Two intersecting triangles of the objects a < b.
struct contact {
    std::uint32_t a;
    std::uint32_t b;
    std::uint32_t triangle_a;
    std::uint32_t triangle_b;

    friend constexpr auto operator<=>(const contact&, const contact&) = default;
};

}  // namespace aabb
