#pragma once

#include "../boxes.hpp"
#include "../compositions.hpp"

/// Inserts objects 0 to n - 1: the first half one by one, the others in one call if there is one.
template <class Search>
void insert_all(Search& search, std::size_t n) {
    std::vector<std::uint32_t> others;
    for (std::uint32_t id = 0; id < n; ++id) id < n / 2 ? search.insert(id) : others.push_back(id);
    if constexpr (requires { search.insert_all(others); })
        search.insert_all(others);
    else
        for (const std::uint32_t id : others) search.insert(id);
}

inline std::unique_ptr<aabb::global_stage> search_of(const aabb::composition& c, std::size_t objects) {
    auto search = global_of(c, aabb::instrumentation::counters);
    insert_all(*search, objects);
    return search;
}

/// Whether the search reports that it leaves this out.
template <class Search>
bool leaves_out(const Search& search, aabb::absence what) {
    const std::vector<aabb::omission> omissions = search.left_out();
    return std::ranges::find(omissions, what, &aabb::omission::feature) != omissions.end();
}

inline std::size_t bytes_of_part(const std::vector<aabb::part_bytes>& parts, const std::string& name) {
    return std::ranges::find(parts, name, &aabb::part_bytes::part)->bytes;
}

inline aabb::box cube(float at, float edge) {
    return {{at, at, at}, {at + edge, at + edge, at + edge}};
}

inline aabb::box moved(const aabb::box& b, const aabb::vec3f& by) {
    return {b.min + by, b.max + by};
}

/// Scattered over a world of about 100, the same in every run.
inline std::vector<aabb::box> scattered(std::uint32_t n, float edge) {
    std::vector<aabb::box> boxes;
    for (std::uint32_t i = 0; i < n; ++i) {
        const aabb::vec3f at{static_cast<float>(i * 37 % 101), static_cast<float>(i * 53 % 97),
                             static_cast<float>(i * 29 % 89)};
        boxes.push_back({at, at + aabb::vec3f{edge, edge, edge}});
    }
    return boxes;
}

/// Unit cubes whose lower corners lie anywhere in a box of these widths.
inline std::vector<aabb::box> cubes(std::size_t n, const aabb::vec3f& widths, std::uint32_t seed = 1) {
    std::mt19937 random(seed);
    std::vector<aabb::box> boxes(n);
    for (aabb::box& b : boxes)
        for (int k = 0; k < 3; ++k) {
            b.min[k] = widths[k] * static_cast<float>(random() % 65536) / 65536;
            b.max[k] = b.min[k] + 1;
        }
    return boxes;
}
