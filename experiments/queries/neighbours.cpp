module aabblab.queries;

import :neighbours;

namespace aabblab {

namespace {

/// The vertices that triangles use, in the order of their coordinates: any other may be no number.
std::vector<std::uint32_t> used_vertices(const aabb::mesh& m) {
    std::vector<bool> is_used(m.vertices.size());
    for (const auto& corners : m.triangles)
        for (const std::uint32_t vertex : corners) is_used[vertex] = true;
    std::vector<std::uint32_t> used;
    for (std::uint32_t vertex = 0; vertex < is_used.size(); ++vertex)
        if (is_used[vertex]) used.push_back(vertex);
    const auto coordinates = [&](std::uint32_t vertex) {
        const aabb::vec3f& at = m.vertices[vertex];
        return std::array{at[0], at[1], at[2]};
    };
    std::ranges::sort(used, {}, coordinates);
    return used;
}

/// Which triangles share a vertex: have one where another has one, whatever its number.
class mesh_neighbours {
public:
    explicit mesh_neighbours(const aabb::mesh& m) : mesh_(m), place_of_(m.vertices.size()) {
        const std::vector<std::uint32_t> used = used_vertices(m);
        std::uint32_t place = 0;
        for (std::size_t i = 0; i < used.size(); ++i) {
            if (i > 0 && m.vertices[used[i]] != m.vertices[used[i - 1]]) ++place;
            place_of_[used[i]] = place;
        }
        begin_.resize(std::size_t{place} + 2);
        for (const auto& corners : m.triangles)
            for (const std::uint32_t vertex : corners) ++begin_[place_of_[vertex] + 1];
        std::partial_sum(begin_.begin(), begin_.end(), begin_.begin());
        triangles_.resize(begin_.back());
        std::vector<std::size_t> end(begin_.begin(), begin_.end() - 1);
        for (std::uint32_t t = 0; t < m.triangles.size(); ++t)
            for (const std::uint32_t vertex : m.triangles[t]) triangles_[end[place_of_[vertex]]++] = t;
    }

    /// The neighbours with greater numbers, ascending, until the next call.
    [[nodiscard]] std::span<const std::uint32_t> after(std::uint32_t triangle) {
        neighbours_.clear();
        for (const std::uint32_t vertex : mesh_.triangles[triangle]) {
            const std::uint32_t place = place_of_[vertex];
            const auto around = std::span(triangles_).subspan(begin_[place], begin_[place + 1] - begin_[place]);
            merged_.clear();
            std::set_union(neighbours_.begin(), neighbours_.end(), std::ranges::upper_bound(around, triangle),
                           around.end(), std::back_inserter(merged_));
            neighbours_.swap(merged_);
        }
        // A triangle with two corners at one place stands there twice.
        neighbours_.erase(std::ranges::unique(neighbours_).begin(), neighbours_.end());
        return neighbours_;
    }

private:
    const aabb::mesh& mesh_;
    std::vector<std::uint32_t> place_of_;   // by vertex; those at one place have the same
    std::vector<std::size_t> begin_;        // by place, and the end of the last
    std::vector<std::uint32_t> triangles_;  // around the first place, then the next, ascending
    std::vector<std::uint32_t> neighbours_, merged_;
};

}  // namespace

std::uint32_t shared_vertices(const aabb::mesh& m, aabb::index_pair pair) {
    const aabb::triangle3f s = m.triangle(pair.a);
    const aabb::triangle3f t = m.triangle(pair.b);
    std::uint32_t shared = 0;
    for (int i = 0; i < 3; ++i) shared += s[i] == t[0] || s[i] == t[1] || s[i] == t[2];
    return shared;
}

bool share_vertex(const aabb::mesh& m, aabb::index_pair pair) {
    // Mostly by its number.
    for (const std::uint32_t vertex : m.triangles[pair.a])
        if (std::ranges::find(m.triangles[pair.b], vertex) != m.triangles[pair.b].end()) return true;
    return shared_vertices(m, pair) > 0;
}

std::uint64_t for_each_with_neighbours(const aabb::mesh& m, std::span<const aabb::index_pair> others,
                                       const std::function<void(std::span<const aabb::index_pair>)>& take) {
    mesh_neighbours neighbours(m);
    std::uint64_t count = 0;
    std::vector<aabb::index_pair> pairs;  // of one triangle
    for (std::uint32_t a = 0; a < m.triangle_count(); ++a) {
        pairs.clear();
        for (const std::uint32_t b : neighbours.after(a)) pairs.push_back({a, b});
        count += pairs.size();
        const auto first = static_cast<std::ptrdiff_t>(pairs.size());
        for (; !others.empty() && others.front().a == a; others = others.subspan(1)) pairs.push_back(others.front());
        std::ranges::inplace_merge(pairs, pairs.begin() + first);
        take(pairs);
    }
    return count;
}

}  // namespace aabblab
