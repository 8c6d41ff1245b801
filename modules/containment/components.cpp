module aabb.containment;

#pragma clang fp contract(off) reassociate(off) reciprocal(off)  // see aabb.base:floating_point

namespace aabb {

namespace {

/// Disjoint sets of vertices (Tarjan, "Efficiency of a good but not linear set union algorithm", 1975), with paths
/// halved.
class vertex_sets {
public:
    explicit vertex_sets(std::size_t vertices) : parent_(vertices) { std::iota(parent_.begin(), parent_.end(), 0U); }

    [[nodiscard]] std::uint32_t set_of(std::uint32_t v) {
        while (parent_[v] != v) v = parent_[v] = parent_[parent_[v]];
        return v;
    }
    void join(std::uint32_t p, std::uint32_t q) {
        const auto [low, high] = std::minmax({set_of(p), set_of(q)});
        parent_[high] = low;
    }

private:
    std::vector<std::uint32_t> parent_;
};

/// The sign of the volume that triangles enclose: of the sum of det(p, q, r) over triangles pqr, six times the volume
/// of the tetrahedron that pqr spans with the origin.
///
/// In double, a term is rounded twice, a difference of two once, and each of the 3 n sums once: the error is below
/// (3 n + 4) u of the terms' magnitudes; twice that covers the rounding of this bound. If the first product of a term
/// underflows, by less than 2^-1074, the error is that times the third factor. After an overflow, the bound is infinite
/// or NaN.
int enclosed_volume_sign(const mesh& m, std::span<const std::uint32_t> triangles) {
    double volume = 0, magnitude = 0, greatest = 1;
    for (const std::uint32_t t : triangles) {
        const triangle3d p = m.given_triangle(t);
        for (int i = 0; i < 3; ++i) {
            greatest = std::max(greatest, std::abs(p[2][i]));
            const int j = (i + 1) % 3, k = (i + 2) % 3;
            const double plus = p[0][i] * p[1][j] * p[2][k], minus = p[0][i] * p[1][k] * p[2][j];
            volume += plus - minus;
            magnitude += std::abs(plus) + std::abs(minus);
        }
    }
    constexpr double unit = std::numeric_limits<double>::epsilon() / 2;
    const auto count = static_cast<double>(triangles.size());
    const double error = 2 * (3 * count + 4) * unit * magnitude + 12 * count * 0x1p-1074 * greatest;
    if (volume > error) return 1;
    if (volume < -error) return -1;
    product_sum sum;
    constexpr std::size_t most_triangles_added = product_sum::most_products / 6;
    for (std::size_t i = 0; i < triangles.size(); ++i) {
        const triangle3d p = m.given_triangle(triangles[i]);
        sum.add_determinant(p[0], p[1], p[2]);
        if (i % most_triangles_added == 0) sum.carry();
    }
    return sum.sign();
}

/// Counts the edges of each component that belong to an odd number of triangles, and sets whether it is oriented.
/// @param first by vertex, the vertex that stands for its position
/// @param part_of by vertex that stands for a position, its component
void count_open_edges(const mesh& m, std::span<const std::uint32_t> first, std::span<const std::uint32_t> part_of,
                      std::vector<surface_component>& parts) {
    // The edges of each lower end, by counting: the higher end, and whether the triangle passes the edge towards it.
    std::vector<std::size_t> begins(m.vertices.size() + 2);
    const auto for_each_edge = [&](const auto& take) {
        for (const auto& corners : m.triangles)
            for (std::size_t i = 0; i < 3; ++i) {
                const std::uint32_t from = first[corners[i]], to = first[corners[(i + 1) % 3]];
                if (from != to)
                    take(std::min(from, to), std::uint64_t{std::max(from, to)} << 1U | (from < to ? 1U : 0U));
            }
    };
    for_each_edge([&](std::uint32_t low, std::uint64_t) { ++begins[low + 2U]; });
    for (std::size_t v = 2; v < begins.size(); ++v) begins[v] += begins[v - 1];
    std::vector<std::uint64_t> edges(begins.back());
    for_each_edge([&](std::uint32_t low, std::uint64_t edge) { edges[begins[low + 1U]++] = edge; });
    for (surface_component& part : parts) part.is_oriented = true;
    for (std::uint32_t low = 0; low < m.vertices.size(); ++low) {
        const std::span<std::uint64_t> at_low = std::span(edges).subspan(begins[low], begins[low + 1U] - begins[low]);
        std::ranges::sort(at_low);
        for (std::size_t i = 0; i < at_low.size();) {
            std::size_t up = 0, down = 0;
            for (const std::uint64_t high = at_low[i] >> 1U; i < at_low.size() && at_low[i] >> 1U == high; ++i)
                ++((at_low[i] & 1U) != 0 ? up : down);
            parts[part_of[low]].open_edges += (up + down) % 2;
            parts[part_of[low]].is_oriented &= up == down;
        }
    }
}

/// For each vertex that a triangle uses, the least vertex at the same position.
std::vector<std::uint32_t> first_at_position(const mesh& m) {
    std::vector<std::uint32_t> first(m.vertices.size());
    std::vector<bool> is_used(m.vertices.size());
    for (const auto& corners : m.triangles)
        for (const std::uint32_t v : corners) is_used[v] = true;
    struct placed_vertex {
        vec3d at;
        std::uint32_t number;
    };
    std::vector<placed_vertex> by_position;
    for (std::uint32_t v = 0; v < m.vertices.size(); ++v)
        if (is_used[v]) by_position.push_back({m.given_vertex(v), v});
    std::ranges::sort(by_position, [](const placed_vertex& p, const placed_vertex& q) {
        for (int k = 0; k < 3; ++k)
            if (p.at[k] != q.at[k]) return p.at[k] < q.at[k];
        return p.number < q.number;
    });
    for (std::size_t i = 0; i < by_position.size(); ++i) {
        const auto& [at, number] = by_position[i];
        const bool is_new = i == 0 || at != by_position[i - 1].at;
        first[number] = is_new ? number : first[by_position[i - 1].number];
    }
    return first;
}

}  // namespace

surface_components components_of(const mesh& m) {
    surface_components components;
    components.positions = first_at_position(m);
    const std::vector<std::uint32_t>& first = components.positions;
    vertex_sets sets(m.vertices.size());
    for (const auto& corners : m.triangles) {
        sets.join(first[corners[0]], first[corners[1]]);
        sets.join(first[corners[0]], first[corners[2]]);
    }
    constexpr std::uint32_t unseen = 0xffffffff;
    std::vector<std::uint32_t> part_of(m.vertices.size(), unseen);
    for (std::uint32_t t = 0; t < m.triangle_count(); ++t) {
        const std::uint32_t set = sets.set_of(first[m.triangles[t][0]]);
        if (part_of[set] == unseen) {
            part_of[set] = static_cast<std::uint32_t>(components.parts.size());
            components.parts.push_back({.first_triangle = t});
        }
        for (const std::uint32_t v : m.triangles[t]) part_of[first[v]] = part_of[set];
        surface_component& part = components.parts[part_of[set]];
        ++part.triangles;
        part.bounds = merged(part.bounds, bounds_of(m.triangle(t)));
        components.of_triangles.push_back(part_of[set]);
    }
    count_open_edges(m, first, part_of, components.parts);
    std::vector<std::uint32_t> next;  // by component, the place of its next triangle
    std::uint32_t begin = 0;
    for (surface_component& part : components.parts) {
        part.first_grouped = begin;
        next.push_back(begin);
        begin += part.triangles;
    }
    components.grouped.resize(m.triangles.size());
    for (std::uint32_t t = 0; t < m.triangle_count(); ++t) components.grouped[next[components.of_triangles[t]]++] = t;
    for (std::uint32_t c = 0; c < components.parts.size(); ++c)
        if (surface_component& part = components.parts[c]; part.is_oriented)
            part.volume_sign = enclosed_volume_sign(m, components.triangles_of(c));
    return components;
}

}  // namespace aabb
