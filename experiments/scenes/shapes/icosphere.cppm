module;
#include <Eigen/Core>

module aabblab.scenes:icosphere;

import aabblab.vectors;
import :shape;

namespace aabblab {

/// The unit sphere as an icosahedron with each face subdivided into n² triangles.
struct icosphere {
    static constexpr std::string_view name = "icosphere";
    static constexpr std::string_view summary = "a sphere of nearly equal triangles";

    /// The number of triangles is the nearest 20 n².
    using config = shape_size<5000>;
    static constexpr auto parameters = config::parameters(20, "about how many triangles");

    /// Cuts each edge of the icosahedron into `cuts` parts, and so each face into cuts² triangles. Their number,
    /// 20 cuts², is the nearest to the wanted one, which is at most the mean of it and the next.
    [[nodiscard]] static aabb::mesh make(const config& c) {
        builder b;
        b.cuts = 1;
        while (20 * (std::uint64_t{b.cuts} * b.cuts + (b.cuts + 1ULL) * (b.cuts + 1)) < 2ULL * c.triangles) ++b.cuts;
        for (const auto& corner : corners()) b.mesh.vertices.push_back(on_sphere(corner));
        for (const auto& [p, q, r] : faces) b.cut_face(p, q, r);
        return std::move(b.mesh);
    }

private:
    // Cyclic permutations of (0, ±1, ±golden ratio).
    [[nodiscard]] static std::array<Eigen::Vector3d, 12> corners() {
        const double g = (1 + std::sqrt(5.0)) / 2;
        using point = Eigen::Vector3d;
        return {point(-1, g, 0), point(1, g, 0), point(-1, -g, 0), point(1, -g, 0),
                point(0, -1, g), point(0, 1, g), point(0, -1, -g), point(0, 1, -g),
                point(g, 0, -1), point(g, 0, 1), point(-g, 0, -1), point(-g, 0, 1)};
    }
    static constexpr std::array<std::array<std::uint32_t, 3>, 20> faces = {
        {{0, 11, 5},  {0, 5, 1},  {0, 1, 7},  {0, 7, 10}, {0, 10, 11}, {1, 5, 9}, {5, 11, 4},
         {11, 10, 2}, {10, 7, 6}, {7, 1, 8},  {3, 9, 4},  {3, 4, 2},   {3, 2, 6}, {3, 6, 8},
         {3, 8, 9},   {4, 9, 5},  {2, 4, 11}, {6, 2, 10}, {8, 6, 7},   {9, 8, 1}}};

    [[nodiscard]] static aabb::vec3f on_sphere(const Eigen::Vector3d& p) { return in_float(p / length_of(p)); }

    struct builder {
        aabb::mesh mesh;
        std::uint32_t cuts = 1;
        std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> edges;  // the first inner vertex of each edge

        /// The index of the vertex after i of `cuts` parts of the edge from p to q. The first of the two faces at an
        /// edge adds its inner vertices, in the direction from the lesser corner; the second finds them in `edges`.
        [[nodiscard]] std::uint32_t on_edge(std::uint32_t p, std::uint32_t q, std::uint32_t i) {
            if (i == 0) return p;
            if (i == cuts) return q;
            if (p > q) return on_edge(q, p, cuts - i);
            const auto [edge, is_new] = edges.try_emplace({p, q}, static_cast<std::uint32_t>(mesh.vertices.size()));
            if (is_new)
                for (std::uint32_t j = 1; j < cuts; ++j)
                    mesh.vertices.push_back(between(corners()[p], corners()[q], corners()[p], j, 0));
            return edge->second + i - 1;
        }

        /// p, plus i steps towards q and j towards r.
        [[nodiscard]] aabb::vec3f between(const Eigen::Vector3d& p, const Eigen::Vector3d& q, const Eigen::Vector3d& r,
                                          std::uint32_t i, std::uint32_t j) const {
            return on_sphere(p * (cuts - i - j) + q * i + r * j);
        }

        /// Cuts a face into triangles between rows parallel to p-q; row j, from p-r to q-r, has cuts - j + 1 vertices.
        void cut_face(std::uint32_t p, std::uint32_t q, std::uint32_t r) {
            std::vector<std::uint32_t> below;
            for (std::uint32_t j = 0; j <= cuts; ++j) {
                std::vector<std::uint32_t> row;
                for (std::uint32_t i = 0; i <= cuts - j; ++i) {
                    if (j == 0)
                        row.push_back(on_edge(p, q, i));
                    else if (i == 0)
                        row.push_back(on_edge(p, r, j));
                    else if (i == cuts - j)
                        row.push_back(on_edge(q, r, j));
                    else {
                        row.push_back(static_cast<std::uint32_t>(mesh.vertices.size()));
                        mesh.vertices.push_back(between(corners()[p], corners()[q], corners()[r], i, j));
                    }
                }
                for (std::size_t i = 0; i + 1 < below.size(); ++i) {
                    mesh.triangles.push_back({below[i], below[i + 1], row[i]});
                    if (i + 1 < row.size()) mesh.triangles.push_back({below[i + 1], row[i + 1], row[i]});
                }
                below = std::move(row);
            }
        }
    };
};

}  // namespace aabblab
