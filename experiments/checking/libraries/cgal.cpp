// Pairs by CGAL: box_self_intersection_d with its defaults, and an AABB tree of one mesh that is asked for each
// triangle of the other.
#include <CGAL/AABB_traits.h>
#include <CGAL/AABB_tree.h>
#include <CGAL/AABB_triangle_primitive.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/box_intersection_d.h>
#include <CGAL/version.h>

#include "exchange.hpp"

namespace {

void find_boxes(const std::vector<std::vector<lists::box>>& frames, lists::pair_file& out) {
    using handle = std::vector<lists::box>::const_iterator;
    using box = CGAL::Box_intersection_d::Box_with_handle_d<double, 3, handle>;
    for (std::size_t frame = 0; frame < frames.size(); ++frame) {
        const std::vector<lists::box>& given = frames[frame];
        std::vector<box> boxes;
        for (auto b = given.begin(); b != given.end(); ++b)
            boxes.emplace_back(CGAL::Bbox_3(b->min[0], b->min[1], b->min[2], b->max[0], b->max[1], b->max[2]), b);
        CGAL::box_self_intersection_d(boxes.begin(), boxes.end(), [&](const box& a, const box& b) {
            out.add(frame, static_cast<std::size_t>(a.handle() - given.begin()),
                    static_cast<std::size_t>(b.handle() - given.begin()));
        });
    }
}

using kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using triangles = std::vector<kernel::Triangle_3>;
using primitive = CGAL::AABB_triangle_primitive<kernel, triangles::const_iterator>;
using tree = CGAL::AABB_tree<CGAL::AABB_traits<kernel, primitive>>;

triangles triangles_of(const lists::mesh& m) {
    const auto point = [&](int corner) {
        const auto& v = m.vertices[static_cast<std::size_t>(corner)];
        return kernel::Point_3(v[0], v[1], v[2]);
    };
    triangles result;
    for (const auto& t : m.triangles) result.emplace_back(point(t[0]), point(t[1]), point(t[2]));
    return result;
}

void find_triangles(const lists::mesh& a, const lists::mesh& b, lists::pair_file& out) {
    const triangles of_a = triangles_of(a), of_b = triangles_of(b);
    const tree tree_of_a(of_a.begin(), of_a.end());
    for (std::size_t t = 0; t < of_b.size(); ++t) {
        std::vector<triangles::const_iterator> hits;
        tree_of_a.all_intersected_primitives(of_b[t], std::back_inserter(hits));
        for (const auto hit : hits) out.add(hit - of_a.begin(), static_cast<std::int64_t>(t));
    }
}

}  // namespace

int main(int count, char** values) {
    return lists::run(count, values, "CGAL " CGAL_STRINGIZE(CGAL_VERSION), find_boxes, find_triangles);
}
