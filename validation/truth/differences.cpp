module aabb.truth;

import aabb.geometry;

namespace aabb {

// Defined in difference_class.cpp.
difference_class class_of_difference(const triangle3f& s, const pose& pose_s, const triangle3f& t, const pose& pose_t,
                                     const triangle3f& t_seen_from_s, bool engine_says);

differences& differences::operator+=(const differences& other) {
    for (std::size_t c = 0; c < missing.size(); ++c) {
        missing[c] += other.missing[c];
        invented[c] += other.invented[c];
    }
    return *this;
}

differences compare_triangle_pairs(std::span<const index_pair> exact, std::span<const index_pair> found, const mesh& a,
                                   const pose& pose_a, const mesh& b, const pose& pose_b) {
    const relative_pose to_a(pose_a, pose_b, bounds_of(b));
    differences all;
    const auto count = [&](index_pair pair, bool engine_says) {
        const triangle3f s = a.triangle(pair.a);
        const triangle3f t = b.triangle(pair.b);
        auto& classes = engine_says ? all.invented : all.missing;
        ++classes[static_cast<std::size_t>(class_of_difference(s, pose_a, t, pose_b, to_a(t), engine_says))];
    };
    auto next_exact = exact.begin();
    auto next_found = found.begin();
    while (next_exact != exact.end() || next_found != found.end()) {
        if (next_found == found.end() || (next_exact != exact.end() && *next_exact < *next_found))
            count(*next_exact++, false);
        else if (next_exact == exact.end() || *next_found < *next_exact)
            count(*next_found++, true);
        else {
            ++next_exact;
            ++next_found;
        }
    }
    return all;
}

}  // namespace aabb
