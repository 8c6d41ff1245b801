#include <rapidcheck.h>

#include <cstdlib>
#include <filesystem>

#include "../compositions.hpp"
#include "../random_poses.hpp"
#include "side_of_mesh.hpp"
#include "support.hpp"

import aabb.composed;
import aabb.extreme;
import aabb.strategies;
import aabb.touching;
import aabblab.files;

// What lies inside what is compared with CGAL's Side_of_triangle_mesh over its kernel of exact constructions.

namespace {

using aabb::contact_relation;
using aabb::index_pair;
using aabb::mesh;
using aabb::pose;
using aabb::ray_crossing;
using aabb::solid_relation;
using aabb::surface_component;
using aabb::vec3d;
using aabb::vec3f;
using solid = aabb::enclosure<aabb::canonical_tree>;

solid solid_of(const mesh& m) {
    return {m, aabb::median_build{}};
}

/// Appends a copy of a mesh.
void append(mesh& m, const mesh& other, float scale, const vec3f& shift) {
    const auto first = static_cast<std::uint32_t>(m.vertices.size());
    for (const vec3f& v : other.vertices)
        m.vertices.push_back({scale * v[0] + shift[0], scale * v[1] + shift[1], scale * v[2] + shift[2]});
    for (const auto& [p, q, r] : other.triangles) m.triangles.push_back({first + p, first + q, first + r});
}
mesh scaled(const mesh& other, float scale, const vec3f& shift = {0, 0, 0}) {
    mesh m;
    append(m, other, scale, shift);
    return m;
}

mesh flipped(mesh m) {
    for (auto& [p, q, r] : m.triangles) std::swap(p, q);
    return m;
}

/// The same triangles, each with vertices of its own.
mesh unwelded(const mesh& m) {
    mesh soup;
    for (std::uint32_t t = 0; t < m.triangle_count(); ++t)
        add_triangle(soup, m.triangle(t)[0], m.triangle(t)[1], m.triangle(t)[2]);
    return soup;
}

/// The cube from 0 to n, each face of n × n squares, so that lines through lattice points meet edges and vertices.
mesh cut_cube(std::uint32_t n) {
    mesh m;
    const auto size = static_cast<float>(n);
    for (int axis = 0; axis < 3; ++axis)
        for (const float height : {0.0F, size})
            for (std::uint32_t i = 0; i < n; ++i)
                for (std::uint32_t j = 0; j < n; ++j) {
                    const auto corner = [&](std::uint32_t u, std::uint32_t v) {
                        vec3f p{};
                        p[axis] = height;
                        p[(axis + 1) % 3] = static_cast<float>(u);
                        p[(axis + 2) % 3] = static_cast<float>(v);
                        return p;
                    };
                    const std::array square{corner(i, j), corner(i + 1, j), corner(i + 1, j + 1), corner(i, j + 1)};
                    const bool is_up = height > 0;
                    add_triangle(m, square[0], square[is_up ? 1 : 2], square[is_up ? 2 : 1]);
                    add_triangle(m, square[0], square[is_up ? 2 : 3], square[is_up ? 3 : 2]);
                }
    return m;
}

/// A torus around the z-axis, of radii 2 and 1/2.
mesh torus(std::uint32_t around, std::uint32_t across) {
    mesh m;
    for (std::uint32_t i = 0; i < around; ++i)
        for (std::uint32_t j = 0; j < across; ++j) {
            const double turn = 2 * std::numbers::pi * i / around, tilt = 2 * std::numbers::pi * j / across;
            const double radius = 2 + std::cos(tilt) / 2;
            m.vertices.push_back({static_cast<float>(radius * std::cos(turn)),
                                  static_cast<float>(radius * std::sin(turn)), static_cast<float>(std::sin(tilt) / 2)});
        }
    for (std::uint32_t i = 0; i < around; ++i)
        for (std::uint32_t j = 0; j < across; ++j) {
            const auto at = [&](std::uint32_t u, std::uint32_t v) { return u % around * across + v % across; };
            m.triangles.push_back({at(i, j), at(i + 1, j), at(i + 1, j + 1)});
            m.triangles.push_back({at(i, j), at(i + 1, j + 1), at(i, j + 1)});
        }
    return m;
}

mesh in_doubles(const mesh& m, const std::function<vec3d(const vec3d&)>& map) {
    mesh result;
    result.triangles = m.triangles;
    std::vector<vec3d> vertices;
    for (std::size_t v = 0; v < m.vertices.size(); ++v) vertices.push_back(map(m.given_vertex(v)));
    set_vertices(result, vertices);
    return result;
}

mesh without_triangle(mesh m, std::ptrdiff_t t) {
    m.triangles.erase(m.triangles.begin() + t);
    return m;
}

std::vector<index_pair> hits_of(const mesh& a, const pose& pose_a, const mesh& b, const pose& pose_b) {
    const auto stage = aabb::compose_local_detection({}, aabb::instrumentation::none);
    return aabb::pairs_of(*stage, a, pose_a, b, pose_b);
}

/// The pairs of components that share a point, ascending.
std::vector<index_pair> meeting_components(const solid& a, const solid& b, std::span<const index_pair> hits) {
    std::vector<index_pair> components;
    for (const index_pair p : hits)
        components.push_back({a.components().of_triangles[p.a], b.components().of_triangles[p.b]});
    std::ranges::sort(components);
    components.erase(std::ranges::unique(components).begin(), components.end());
    return components;
}

cgal_surface::point for_cgal(const vec3d& p) {
    return {p[0], p[1], p[2]};
}
cgal_surface::pose for_cgal(const pose& p) {
    return {p.rotation, for_cgal(p.translation)};
}
cgal_surface for_cgal(const mesh& m, std::span<const std::uint32_t> triangles, const pose& at) {
    std::vector<std::array<cgal_surface::point, 3>> corners;
    for (const std::uint32_t t : triangles) {
        const aabb::triangle3d given = m.given_triangle(t);
        corners.push_back({for_cgal(given[0]), for_cgal(given[1]), for_cgal(given[2])});
    }
    return {corners, for_cgal(at)};
}

/// Pairs of components that CGAL has judged.
struct judgement {
    std::size_t inside = 0, outside = 0, rejected = 0, wrong = 0;
    std::vector<index_pair> pairs;  ///< those inside
};

/// Compares `enclosed_components` with CGAL for all pairs of components that do not meet and that CGAL accepts.
judgement judge(const solid& inner, const pose& pose_of_inner, const solid& outer, const pose& pose_of_outer,
                std::span<const index_pair> meeting) {
    judgement verdict;
    const std::vector<index_pair> ours = enclosed_components(inner, pose_of_inner, outer, pose_of_outer, meeting);
    for (std::uint32_t j = 0; j < outer.parts().size(); ++j) {
        const cgal_surface surface = for_cgal(outer.triangles(), outer.components().triangles_of(j), pose_of_outer);
        const bool is_closed = outer.parts()[j].is_closed();
        if (surface.is_accepted() && !is_closed) ++verdict.wrong;
        for (std::uint32_t i = 0; i < inner.parts().size(); ++i) {
            if (std::ranges::binary_search(meeting, index_pair{i, j})) continue;
            const bool says_inside = std::ranges::binary_search(ours, index_pair{i, j});
            if (!surface.is_accepted()) {
                verdict.wrong += says_inside && !is_closed;
                ++verdict.rejected;
                continue;
            }
            // Another vertex than the one that we ask for, where there is one.
            const std::uint32_t vertex = inner.triangles().triangles[inner.components().triangles_of(i).back()][2];
            const cgal_surface::side side =
                surface.side_of(for_cgal(inner.triangles().given_vertex(vertex)), for_cgal(pose_of_inner));
            const bool is_inside = side == cgal_surface::side::inside;
            ++(is_inside ? verdict.inside : verdict.outside);
            if (is_inside) verdict.pairs.push_back({i, j});
            verdict.wrong += is_inside != says_inside || side == cgal_surface::side::on_surface;
        }
    }
    return verdict;
}

/// The sides of a surface on which vertices of a component lie, by CGAL.
struct vertex_sides {
    bool inside = false, outside = false;
};
vertex_sides sides_of(const solid& s, std::uint32_t component, const pose& at, const cgal_surface& surface) {
    constexpr std::size_t most = 40;
    vertex_sides sides;
    const std::span<const std::uint32_t> triangles = s.components().triangles_of(component);
    for (std::size_t i = 0; i < triangles.size(); i += (triangles.size() + most - 1) / most) {
        const std::uint32_t vertex = s.triangles().triangles[triangles[i]][i % 3];
        const cgal_surface::side side = surface.side_of(for_cgal(s.triangles().given_vertex(vertex)), for_cgal(at));
        sides.inside |= side == cgal_surface::side::inside;
        sides.outside |= side == cgal_surface::side::outside;
    }
    return sides;
}

/// Pairs of components that share a point, by how they lie, and those of which CGAL says otherwise.
struct contact_judgement {
    std::map<contact_relation, std::size_t> counts;
    std::size_t rejected = 0, wrong = 0;
    std::size_t unexplained = 0;  ///< undecided, although vertices lie off the other surface and none intersects itself

    /// Those of which one lies inside the other and touches it.
    [[nodiscard]] std::size_t touching_from_inside() {
        return counts[contact_relation::a_inside_b] + counts[contact_relation::b_inside_a];
    }
};

/// Compares `contacts_of` with the sides on which CGAL finds the vertices of each surface.
void judge_contacts(const solid& a, const pose& pose_a, const solid& b, const pose& pose_b,
                    std::span<const index_pair> hits, contact_judgement& verdict) {
    aabb::contact_surface<aabb::canonical_tree> surface_a(a), surface_b(b);
    for (const auto& [i, j, relation] : contacts_of(surface_a, pose_a, surface_b, pose_b, hits)) {
        ++verdict.counts[relation];
        const cgal_surface of_a = for_cgal(a.triangles(), a.components().triangles_of(i), pose_a);
        const cgal_surface of_b = for_cgal(b.triangles(), b.components().triangles_of(j), pose_b);
        if (!of_a.is_accepted() || !of_b.is_accepted()) {
            ++verdict.rejected;
            const bool is_decided = relation != contact_relation::undecided && relation != contact_relation::crossing;
            verdict.wrong += is_decided && !(a.parts()[i].is_closed() && b.parts()[j].is_closed());
            continue;
        }
        const vertex_sides a_in_b = sides_of(a, i, pose_a, of_b), b_in_a = sides_of(b, j, pose_b, of_a);
        // Where vertices lie on both sides, surfaces pass through each other; so do two that enter each other.
        const bool must_cross =
            (a_in_b.inside && a_in_b.outside) || (b_in_a.inside && b_in_a.outside) || (a_in_b.inside && b_in_a.inside);
        switch (relation) {
            case contact_relation::touching: verdict.wrong += must_cross || a_in_b.inside || b_in_a.inside; break;
            case contact_relation::a_inside_b: verdict.wrong += must_cross || a_in_b.outside || b_in_a.inside; break;
            case contact_relation::b_inside_a: verdict.wrong += must_cross || b_in_a.outside || a_in_b.inside; break;
            case contact_relation::equal:
                verdict.wrong += must_cross || a_in_b.inside || a_in_b.outside || b_in_a.inside || b_in_a.outside;
                break;
            case contact_relation::crossing: break;
            case contact_relation::undecided:
                verdict.unexplained += (a_in_b.inside || a_in_b.outside) && (b_in_a.inside || b_in_a.outside) &&
                                       !surface_a.intersects_itself(i) && !surface_b.intersects_itself(j);
                break;
        }
    }
}

/// What components of two meshes enclose of each other, apart from those that meet, and how these lie.
struct found_relations {
    std::vector<index_pair> a_in_b, b_in_a;
    std::vector<aabb::component_contact> contacts;

    friend bool operator==(const found_relations&, const found_relations&) = default;
};

/// Two meshes at poses, with the pairs of their triangles that intersect.
struct posed_meshes {
    const mesh &a, &b;
    pose pose_a, pose_b;
    std::vector<index_pair> hits = hits_of(a, pose_a, b, pose_b);

    template <class Tree, class Build>
    [[nodiscard]] found_relations relations(const Tree& tree, const Build& build) const {
        const aabb::enclosure<Tree> of_a(a, build, tree), of_b(b, build, tree);
        aabb::contact_surface<Tree> surface_a(of_a), surface_b(of_b);
        found_relations found;
        found.contacts = contacts_of(surface_a, pose_a, surface_b, pose_b, hits);
        std::vector<index_pair> meeting, meeting_b;
        for (const auto& contact : found.contacts) {
            meeting.push_back({contact.a, contact.b});
            meeting_b.push_back({contact.b, contact.a});
        }
        std::ranges::sort(meeting_b);
        found.a_in_b = enclosed_components(of_a, pose_a, of_b, pose_b, meeting);
        found.b_in_a = enclosed_components(of_b, pose_b, of_a, pose_a, meeting_b);
        return found;
    }
    [[nodiscard]] found_relations relations(const aabb::composition& c) const {
        using aabb::strategy_kind;
        const auto build = aabb::composed::make_named<aabb::tree_builder>(
            aabb::builds{}, c[strategy_kind::build], [](const auto& chosen) { return as_tree_builder(chosen); });
        return aabb::composed::make_named<found_relations>(aabb::trees{}, c[strategy_kind::tree],
                                                           [&](const auto& tree) { return relations(tree, build); });
    }
};

/// Whether a file holds triangles, and not points alone.
bool is_surface(const std::filesystem::path& file) {
    return refusal_in<aabb::input_error>([&] { static_cast<void>(aabblab::read_mesh(file)); }) == "accepted";
}

solid_relation relation(const mesh& a, const mesh& b, const pose& pose_a = {}, const pose& pose_b = {}) {
    const solid solid_a = solid_of(a), solid_b = solid_of(b);
    const solid_relation result = relation_of(solid_a, pose_a, solid_b, pose_b).relation;
    // Swapping the meshes swaps the relation.
    const solid_relation swapped = relation_of(solid_b, pose_b, solid_a, pose_a).relation;
    const auto expected = result == solid_relation::a_inside_b   ? solid_relation::b_inside_a
                          : result == solid_relation::b_inside_a ? solid_relation::a_inside_b
                                                                 : result;
    CHECK(swapped == expected);
    return result;
}

}  // namespace

TEST_CASE("components are connected by vertices at equal positions, in the order of their triangles") {
    mesh m = unwelded(aabb::unit_cube());
    append(m, aabb::unit_cube(), 1, {5, 0, 0});
    append(m, aabb::unit_cube(), 1, {1, 1, 1});  // shares a corner with the first
    add_triangle(m, {9, 9, 9}, {9, 9, 8}, {9, 8, 9});
    m.vertices.push_back({std::numeric_limits<float>::max(), 0, 0});
    const aabb::surface_components components = components_of(m);
    REQUIRE(components.parts.size() == 3);
    CHECK(components.parts[0].triangles == 24);
    CHECK(components.parts[1].triangles == 12);
    CHECK(components.parts[1].first_triangle == 12);
    CHECK(components.parts[2].triangles == 1);
    CHECK(components.of_triangles[0] == 0);
    CHECK(components.of_triangles[12] == 1);
    CHECK(components.of_triangles[24] == 0);
    CHECK(components.of_triangles[36] == 2);
    CHECK(components.parts[0].bounds == aabb::box{{0, 0, 0}, {2, 2, 2}});
    // −0 is 0.
    mesh signed_zeros{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {-0.0F, -0.0F, 0}, {0, 0, 1}, {0, 1, 1}},
                      {{0, 1, 2}, {3, 4, 5}}};
    CHECK(components_of(signed_zeros).parts.size() == 1);
    signed_zeros.vertices[3][0] = -std::numeric_limits<float>::denorm_min();
    CHECK(components_of(signed_zeros).parts.size() == 2);
}

TEST_CASE("a component is closed if each edge belongs to an even number of triangles") {
    const auto only_part = [](const mesh& m) {
        const aabb::surface_components components = components_of(m);
        REQUIRE(components.parts.size() == 1);
        return components.parts[0];
    };
    for (const mesh& m : {aabb::unit_cube(), unwelded(aabb::unit_cube()), aabb::sphere(5), torus(7, 5), cut_cube(3)}) {
        const surface_component part = only_part(m);
        CHECK(part.is_closed());
        CHECK(part.is_oriented);
        CHECK(part.volume_sign != 0);
        CHECK(only_part(flipped(m)).volume_sign == -part.volume_sign);
        CHECK(only_part(without_triangle(m, 1)).open_edges == 3);
        CHECK(!only_part(without_triangle(m, 1)).is_closed());
    }
    CHECK(!only_part(aabb::unit_cube()).faces_inward());
    CHECK(only_part(flipped(aabb::unit_cube())).faces_inward());
    // One triangle turned over: still closed, but not oriented.
    mesh turned = aabb::unit_cube();
    std::swap(turned.triangles[4][0], turned.triangles[4][1]);
    CHECK(only_part(turned).is_closed());
    CHECK(!only_part(turned).is_oriented);
    CHECK(only_part(turned).volume_sign == 0);
    // A vertex on an edge, of the triangles on one side of it only; a triangle without area closes the gap.
    mesh split = tetrahedron(4);
    split.vertices.push_back({2, 0, 0});
    split.triangles[0] = {0, 2, 4};
    split.triangles.push_back({4, 2, 1});
    CHECK(only_part(split).open_edges == 3);
    split.triangles.push_back({0, 4, 1});
    CHECK(only_part(split).is_closed());
    // Cubes that share an edge, of four triangles.
    mesh chess = aabb::unit_cube();
    append(chess, aabb::unit_cube(), 1, {1, 1, 0});
    CHECK(only_part(chess).is_closed());
    CHECK(only_part(chess).is_oriented);
    // Two faces back to back are closed and enclose nothing.
    mesh coin;
    add_triangle(coin, {0, 0, 0}, {1, 0, 0}, {0, 1, 0});
    add_triangle(coin, {0, 0, 0}, {0, 1, 0}, {1, 0, 0});
    CHECK(only_part(coin).is_closed());
    CHECK(only_part(coin).volume_sign == 0);
}

TEST_CASE("the sign of an enclosed volume is exact") {
    const auto volume_sign = [](const mesh& m) { return components_of(m).parts.at(0).volume_sign; };
    const mesh cube = aabb::unit_cube();
    // Far from the origin, volumes of tetrahedra cancel; products of small or large numbers leave the range of double.
    for (const double scale : {0x1p-1070, 1e-250, 1e-110, 1.0, 1e110, 1e250, 0x1p1020})
        for (const double shift : {0.0, 1.0, 0x1p30, 0x1p51}) {
            const mesh m = in_doubles(cube, [&](const vec3d& v) -> vec3d {
                return {scale * (v[0] + shift), scale * (v[1] - shift), scale * (v[2] + shift)};
            });
            if (!std::isfinite(scale * (shift + 1))) continue;
            CAPTURE(scale, shift);
            CHECK(volume_sign(m) == 1);
            CHECK(volume_sign(flipped(m)) == -1);
        }
    std::size_t flat = 0, solids = 0;
    REQUIRE(rc::check([&] {
        const auto coordinate = [&] {
            switch (*rc::gen::inRange(0, 4)) {
                case 0: return static_cast<double>(*rc::gen::inRange(-2, 3));
                case 1: return uniform(-1, 1) * std::ldexp(1, *rc::gen::inRange(-1070, 1023));
                case 2: return std::nextafter(static_cast<double>(*rc::gen::inRange(-2, 3)), 9);
                default: return 0x1p40 + *rc::gen::inRange(0, 3);
            }
        };
        mesh m = tetrahedron(1);
        std::vector<vec3d> corners(4);
        for (vec3d& corner : corners) corner = {coordinate(), coordinate(), coordinate()};
        set_vertices(m, corners);
        const int expected = aabb::exact_side(corners[0], corners[1], corners[2], corners[3]);
        flat += expected == 0;
        RC_ASSERT(components_of(m).parts.at(0).volume_sign == expected);
        solids += expected != 0;
    }));
    CHECK(flat > 5);
    CHECK(solids > 20);
}

TEST_CASE("a ray crosses a triangle in its inside, or is unclear at an edge") {
    const mesh cube = aabb::unit_cube();
    const auto count = [&](const vec3d& start, const vec3d& target, bool with_image, const pose& at) {
        aabb::parity_ray ray(cube, at, bounds_of(cube), start, at);
        if (with_image)
            ray.set_image({static_cast<float>(start[0]), static_cast<float>(start[1]), static_cast<float>(start[2])},
                          {0, 0, 0});
        ray.aim_at(target);
        std::map<ray_crossing, int> counts;
        for (std::uint32_t t = 0; t < cube.triangle_count(); ++t) {
            const ray_crossing crossing = ray.crossing(t);
            if (crossing != ray_crossing::none) CHECK(overlaps(ray.reach(), bounds_of(cube.triangle(t))));
            ++counts[crossing];
        }
        return counts;
    };
    const vec3d centre{0.5, 0.5, 0.5};
    const pose turned = aabb::turned({1, 2, 3}, 0.7, {0.9, 0.3, -0.2});
    const pose mirrored{{-1, 0, 0, 0, 1, 0.25, 0, 0, 1}, {3, 2, 1}};
    for (const bool with_image : {false, true})
        for (const pose& at : {pose{}, turned, mirrored}) {
            const auto check = [&](const vec3d& start, const vec3d& target, std::array<int, 4> expected) {
                CAPTURE(start[0], start[1], start[2], target[0], target[1], target[2], with_image);
                auto counts = count(start, target, with_image, at);
                CHECK(std::array{counts[ray_crossing::leaves], counts[ray_crossing::enters],
                                 counts[ray_crossing::unclear], counts[ray_crossing::starts_on]} == expected);
            };
            check(centre, {0.75, 0.5625, 9}, {1, 0, 0, 0});
            check(centre, {0.75, 0.5625, -9}, {1, 0, 0, 0});
            check(centre, {0.5, 0.5, 9}, {0, 0, 2, 0});  // through the diagonal of a face
            check(centre, {9, 9, 0.5}, {0, 0, 2, 0});    // through an edge
            check({-1, 0.375, 0.25}, {9, 0.375, 0.25}, {1, 1, 0, 0});
            check({-1, 0.375, 0.25}, {-9, 0.375, 0.25}, {0, 0, 0, 0});  // away from the cube
            check({-1, 0.375, 0}, {9, 0.375, 0.125}, {1, 1, 0, 0});     // from the plane of a face into the cube
            check({-1, 0.375, 0}, {-0.5, 0.375, 9}, {0, 0, 0, 0});      // from the plane of a face past the cube
            const auto counts = [&](const vec3d& start, const vec3d& target) {
                return count(start, target, with_image, at);
            };
            CHECK(counts({-1, 0.375, 0}, {9, 0.375, 0})[ray_crossing::unclear] > 0);  // along a face
            CHECK(counts({-1, 0, 0}, {9, 0, 0})[ray_crossing::unclear] > 0);          // along an edge
            CHECK(counts({-1, -1, -1}, {9, 9, 9})[ray_crossing::unclear] > 0);        // through corners
            check({0, 0.375, 0.25}, {9, 0.5, 0.5}, {1, 0, 0, 1});
            CHECK(counts({0, 0, 0.5}, {9, 0.5, 0.25})[ray_crossing::starts_on] > 0);
            CHECK(counts({1, 1, 1}, {9, 8, 7})[ray_crossing::starts_on] > 0);
        }
    // One unit in the last place beside an edge.
    const double beside = std::nextafter(0.5, 1.0);
    CHECK(count(centre, {beside, 0.5, 9}, true, {})[ray_crossing::leaves] == 1);
    CHECK(count(centre, {beside, 0.5, 9}, true, turned)[ray_crossing::leaves] == 1);
}

TEST_CASE("a ray's box overlaps what it crosses though its start and the surface's floats are off by their error") {
    constexpr double error = 0x1p-12;
    mesh m;
    add_triangle(m, {0, 0, 0}, {0, 0, 1}, {0, 1, 0});
    // In y from 0 to 1; no float is equal to x.
    set_vertices(m, std::vector<vec3d>{{0.25 + 0x1p-40, 0, -1}, {0.25 + 0x1p-40, 0, 1}, {0.25 + 0x1p-40, 1, 0}});
    for (vec3f& v : m.vertices) v[1] += static_cast<float>(error / m.frame.scale);
    // The ray begins above 0 and ends below it; the image of its start is as far down as the floats are up.
    aabb::parity_ray ray(m, {}, bounds_of(m), {0, error / 2, 0}, {});
    const auto in_frame = [&](double x, int k) { return (x - m.frame.origin[k]) / m.frame.scale; };
    const auto allowed = static_cast<float>(in_frame(error, 1) - in_frame(0, 1));
    ray.set_image({static_cast<float>(in_frame(0, 0)), static_cast<float>(in_frame(-error / 2, 1)),
                   static_cast<float>(in_frame(0, 2))},
                  {allowed, allowed, allowed});
    ray.aim_at({2, -error / 2, 0});
    const ray_crossing crossing = ray.crossing(0);
    CHECK((crossing == ray_crossing::leaves || crossing == ray_crossing::enters));
    CHECK(overlaps(ray.reach(), bounds_of(m.triangle(0))));
    // Away from the surface by more than both errors it does not.
    ray.set_image({static_cast<float>(in_frame(0, 0)), static_cast<float>(in_frame(-4 * error, 1)),
                   static_cast<float>(in_frame(0, 2))},
                  {allowed, allowed, allowed});
    ray.aim_at({2, -4 * error, 0});
    CHECK_FALSE(overlaps(ray.reach(), bounds_of(m.triangle(0))));
}

TEST_CASE("a ray through a triangle without area crosses nothing") {
    mesh m;
    add_triangle(m, {0, 0, 0}, {1, 0, 0}, {3, 0, 0});
    add_triangle(m, {0, 0, 0}, {0, 0, 0}, {3, 0, 0});
    add_triangle(m, {1, 0, 0}, {1, 0, 0}, {1, 0, 0});
    for (const vec3d& start : {vec3d{1, 0, -1}, vec3d{-1, 0, 0}, vec3d{2, 0, 0}, vec3d{1, 0, 0}})
        for (const vec3d& target : {vec3d{1, 0, 9}, vec3d{9, 0, 0}, vec3d{7, 8, 9}}) {
            aabb::parity_ray ray(m, {}, bounds_of(m), start, {});
            ray.aim_at(target);
            for (std::uint32_t t = 0; t < 3; ++t) CHECK(ray.crossing(t) == ray_crossing::none);
        }
}

TEST_CASE("a ray whose start is known by floats decides as one without them, near edges too") {
    std::map<ray_crossing, std::size_t> counts;
    REQUIRE(rc::check([&] {
        // A start and two triangles, flat or not, near the origin or far off, with coordinates that are no floats.
        const double offset = *rc::gen::element(0.0, 0.1, 1e3, 1e7);
        const bool on_lattice = *rc::gen::arbitrary<bool>();
        const auto coordinate = [&] {
            return offset + (on_lattice ? *rc::gen::inRange(-2, 3) / 8.0 : uniform(-0.2, 0.2));
        };
        const auto any_point = [&] { return vec3d{coordinate(), coordinate(), coordinate()}; };
        mesh m{{}, {{0, 1, 2}, {3, 4, 5}}};
        std::vector<vec3d> corners(6);
        for (vec3d& corner : corners) corner = any_point();
        set_vertices(m, corners);
        mesh other{{}, {{0, 0, 0}}};
        const vec3d start = any_point();
        set_vertices(other, {start});
        pose at = *rc::gen::arbitrary<bool>() ? pose{} : any_turned(any_vector(10));
        if (*rc::gen::arbitrary<bool>())
            for (const std::size_t k : {0U, 3U, 6U}) at.rotation[k] = -at.rotation[k];  // a mirror
        // The target lies beyond a point of an edge, beside which it may be by a little.
        const double along = *rc::gen::inRange(0, 5) / 4.0, beyond = *rc::gen::element(1.0, 2.0, 1000.0);
        const double little = *rc::gen::element(0.0, 1e-17, 1e-14, 1e-9, 1e-4);
        vec3d target{};
        double distance = 0;
        for (int k = 0; k < 3; ++k) {
            const double on_edge = corners[0][k] + along * (corners[1][k] - corners[0][k]);
            distance = std::max(distance, std::abs(on_edge - start[k]));
            target[k] = start[k] + beyond * (on_edge - start[k]) + uniform(-1, 1) * little;
        }
        if (target == start) return;
        aabb::parity_ray exact(m, at, bounds_of(m), start, at), filtered = exact;
        const aabb::relative_pose to_m(at, at, bounds_of(other), m.frame, other.frame);
        filtered.set_image(to_m(other.vertices[0]), to_m.image_error());
        exact.aim_at(target);
        filtered.aim_at(target);
        for (const std::uint32_t t : {0U, 1U}) {
            const ray_crossing crossing = exact.crossing(t);
            ++counts[crossing];
            RC_ASSERT(filtered.crossing(t) == crossing);
            // Boxes count up to the target only, which here is farther away than any triangle.
            if (beyond > 2 && distance > 0.01 && (crossing == ray_crossing::leaves || crossing == ray_crossing::enters))
                RC_ASSERT(overlaps(filtered.reach(), bounds_of(m.triangle(t))));
        }
    }));
    CHECK(counts[ray_crossing::none] > 20);
    CHECK(counts[ray_crossing::leaves] > 2);
    CHECK(counts[ray_crossing::enters] > 2);
    CHECK(counts[ray_crossing::unclear] > 5);
}

TEST_CASE("a ray from the plane of a huge face is aimed out of that plane") {
    // Half as wide as the greatest numbers, so that nothing is known by floats.
    const mesh cube =
        in_doubles(aabb::unit_cube(), [](const vec3d& v) -> vec3d { return {0x1p1001 * v[0] - 0x1p1000, v[1], v[2]}; });
    for (const double x : {0x1p1000, -0x1p1000}) {
        aabb::parity_ray ray(cube, {}, bounds_of(cube), {x, 5, 6}, {});
        int clear = 0;
        for (std::uint64_t attempt = 0; attempt < 9; ++attempt) {
            ray.aim(attempt);
            bool is_clear = true;
            for (std::uint32_t t = 0; t < cube.triangle_count(); ++t)
                is_clear &= ray.crossing(t) != ray_crossing::unclear;
            clear += static_cast<int>(is_clear);
        }
        CHECK(clear >= 8);
    }
}

TEST_CASE("meshes are disjoint, one inside the other, in a hollow, or partly inside") {
    const mesh cube = scaled(aabb::unit_cube(), 4, {-2, -2, -2}), ball = aabb::sphere(8);
    CHECK(relation(ball, cube) == solid_relation::a_inside_b);
    CHECK(relation(ball, flipped(cube)) == solid_relation::a_inside_b);
    CHECK(relation(scaled(ball, 1, {9, 0, 0}), cube) == solid_relation::disjoint);
    // Inside the box of a torus, but not in it.
    CHECK(relation(scaled(ball, 0.25F), torus(9, 7)) == solid_relation::disjoint);
    CHECK(relation(scaled(ball, 0.25F, {2, 0, 0}), torus(9, 7)) == solid_relation::a_inside_b);
    // A cube with a hollow, in which the ball lies, or which lies in the ball.
    mesh hollow = cube;
    append(hollow, flipped(aabb::unit_cube()), 3, {-1.5F, -1.5F, -1.5F});
    CHECK(relation(ball, hollow) == solid_relation::disjoint);
    CHECK(relation(scaled(ball, 0.125F, {1.75F, 0, 0}), hollow) == solid_relation::a_inside_b);
    CHECK(relation(scaled(ball, 9), hollow) == solid_relation::b_inside_a);
    const solid of_ball = solid_of(ball), of_hollow = solid_of(hollow);
    CHECK(relation_of(of_ball, {}, of_hollow, {}).a_inside_b == std::vector<index_pair>{{0, 0}, {0, 1}});
    CHECK(relation_of(of_hollow, {}, of_ball, {}).b_inside_a == std::vector<index_pair>{{0, 0}, {1, 0}});
    // Some components inside.
    mesh two = ball;
    append(two, ball, 1, {9, 0, 0});
    CHECK(relation(two, cube) == solid_relation::partly_inside);
    mesh ring = cube;
    append(ring, ball, 0.25F, {0, 0, 0});
    CHECK(relation(ball, ring) == solid_relation::partly_inside);
    mesh wrong_way = ball;
    append(wrong_way, scaled(aabb::unit_cube(), 20, {-10, -10, -10}), 1, {0, 0, 0});
    CHECK(relation(cube, wrong_way) == solid_relation::partly_inside);
}

TEST_CASE("what lies in components that face the same way is decided if parity and winding number agree") {
    const mesh cube = scaled(aabb::unit_cube(), 4, {-2, -2, -2}), ball = scaled(aabb::sphere(8), 0.5F);
    const auto with = [](mesh m, const mesh& other) {
        append(m, other, 1, {0, 0, 0});
        return m;
    };
    const mesh large = scaled(cube, 2), huge = scaled(cube, 4);
    CHECK(relation(ball, with(cube, flipped(large))) == solid_relation::disjoint);
    CHECK(relation(ball, with(cube, large)) == solid_relation::undecided);
    CHECK(relation(ball, with(flipped(cube), flipped(large))) == solid_relation::undecided);
    // Three nested ones wind around it three times, or once.
    CHECK(relation(ball, with(with(cube, large), huge)) == solid_relation::a_inside_b);
    CHECK(relation(ball, with(with(cube, flipped(large)), huge)) == solid_relation::a_inside_b);
    // In one of two nested components, beside the other.
    const mesh beside = scaled(ball, 1, {3, 0, 0});
    CHECK(relation(beside, with(cube, large)) == solid_relation::a_inside_b);
    // Where two overlap.
    const mesh overlapping = with(cube, scaled(cube, 1, {1, 1, 1}));
    CHECK(relation(ball, overlapping) == solid_relation::undecided);
    CHECK(relation(scaled(ball, 0.5F, {-1.5F, 0, 0}), overlapping) == solid_relation::a_inside_b);
    // A mirror turns both components over.
    const pose mirrored{{-1, 0, 0, 0, 1, 0.25, 0, 0, 1}, {0, 0, 0}};
    CHECK(relation(ball, with(cube, large), {}, mirrored) == solid_relation::undecided);
    CHECK(relation(ball, with(cube, flipped(large)), {}, mirrored) == solid_relation::disjoint);
    // Where a component is not oriented, parity decides alone.
    mesh turned = cube;
    std::swap(turned.triangles[4][0], turned.triangles[4][1]);
    CHECK(relation(ball, with(turned, large)) == solid_relation::disjoint);
    // Of two components, one lies where both are around it.
    CHECK(relation(with(ball, beside), with(cube, large)) == solid_relation::undecided);
    // A surface around which one component winds twice: a prism over a star that is drawn in one stroke.
    mesh star;
    for (const float z : {-1.0F, 1.0F})
        for (int i = 0; i < 5; ++i) {
            const double turn = 4 * std::numbers::pi * i / 5;
            star.vertices.push_back(
                {static_cast<float>(4 * std::cos(turn)), static_cast<float>(4 * std::sin(turn)), z});
        }
    star.vertices.push_back({0, 0, -1});
    star.vertices.push_back({0, 0, 1});
    for (std::uint32_t i = 0; i < 5; ++i) {
        const std::uint32_t next = (i + 1) % 5;
        star.triangles.insert(star.triangles.end(),
                              {{10, next, i}, {11, i + 5, next + 5}, {i, next, next + 5}, {i, next + 5, i + 5}});
    }
    const solid of_star = solid_of(star), of_ball = solid_of(ball);
    REQUIRE(of_star.parts().size() == 1);
    REQUIRE(of_star.parts()[0].volume_sign == 1);
    CHECK(relation(scaled(ball, 0.5F, {0.25F, 0.125F, 0}), star) == solid_relation::undecided);
    CHECK(relation(scaled(ball, 0.25F, {2.5F, 0, 0}), star) == solid_relation::a_inside_b);
}

TEST_CASE("meshes that are not closed can lie inside, and leave open what lies in them") {
    const mesh cube = scaled(aabb::unit_cube(), 4, {-2, -2, -2}), ball = aabb::sphere(8);
    CHECK(relation(without_triangle(ball, 5), cube) == solid_relation::a_inside_b);
    CHECK(relation(ball, without_triangle(cube, 0)) == solid_relation::not_closed);
    CHECK(relation(without_triangle(ball, 5), without_triangle(cube, 0)) == solid_relation::not_closed);
    CHECK(relation(scaled(without_triangle(ball, 5), 1, {0, 0, 0.5F}), scaled(torus(9, 7), 2)) ==
          solid_relation::not_closed);
    // Whatever closed it, it could not contain what lies beyond its box.
    CHECK(relation(scaled(without_triangle(ball, 5), 1, {9, 0, 0}), cube) == solid_relation::disjoint);
    // An open component that is far away is of no importance.
    mesh and_far = cube;
    append(and_far, without_triangle(ball, 5), 1, {9, 0, 0});
    CHECK(relation(ball, and_far) == solid_relation::a_inside_b);
    mesh and_near = cube;
    append(and_near, without_triangle(ball, 5), 0.5F, {0, 0, 0});
    CHECK(relation(ball, and_near) == solid_relation::not_closed);
}

TEST_CASE("rays that meet edges and vertices are replaced") {
    // From a lattice point, a line along an axis meets vertices of the cut cube.
    const mesh cut = cut_cube(4);
    for (float x = 0.5F; x < 4; x += 0.5F)
        for (float y = 0.5F; y < 4; y += 0.5F)
            for (float z = 0.5F; z < 4; z += 0.5F)
                CHECK(relation(scaled(aabb::unit_cube(), 0.125F, {x, y, z}), cut) == solid_relation::a_inside_b);
    // Beside the torus, in the planes of its edges.
    for (float x = -1.25F; x <= 1.25F; x += 0.25F)
        CHECK(relation(scaled(aabb::unit_cube(), 0.0625F, {x, 0, 0}), torus(8, 8)) == solid_relation::disjoint);
    // In the planes of faces of two cubes that share a corner, outside both.
    mesh corners = cut_cube(2);
    append(corners, cut_cube(2), 1, {2, 2, 2});
    for (const vec3f& at : {vec3f{1, 1, 3}, vec3f{3, 1, 1}, vec3f{1, 3, 3}, vec3f{2.5F, 1.5F, 1.5F}})
        CHECK(relation(scaled(aabb::unit_cube(), 0.125F, at), corners) == solid_relation::disjoint);
}

TEST_CASE("a vertex on the other surface is rejected") {
    const mesh cube = scaled(aabb::unit_cube(), 4);
    const solid of_cube = solid_of(cube);
    for (const vec3f& at : {vec3f{0, 1, 2}, vec3f{0, 0, 1}, vec3f{4, 4, 4}}) {
        const mesh small = scaled(aabb::unit_cube(), 0.25F, at);
        const solid of_small = solid_of(small);
        CHECK_THROWS_AS(relation_of(of_small, {}, of_cube, {}), aabb::input_error);
        // Unless the components are known to meet.
        CHECK(enclosed_components(of_small, {}, of_cube, {}, std::vector<index_pair>{{0, 0}}).empty());
    }
}

TEST_CASE("inside and outside are decided where floats and boxes cannot") {
    const mesh cube = scaled(aabb::unit_cube(), 2, {-1, -1, -1});
    // Meshes of any size, far away together, and one unit in the last place within a face.
    for (const double scale : {0x1p-1060, 1e-200, 1.0, 1e200, 0x1p1020})
        for (const double shift : {0.0, 1e6}) {
            if (!std::isfinite(scale * (shift + 2))) continue;
            CAPTURE(scale, shift);
            const auto placed = [&](const mesh& m, double size) {
                return in_doubles(m, [&](const vec3d& v) -> vec3d {
                    return {scale * (size * v[0] + shift), scale * (size * v[1] + shift),
                            scale * (size * v[2] + shift)};
                });
            };
            CHECK(relation(placed(cube, 0.5), placed(cube, 1)) == solid_relation::a_inside_b);
            CHECK(relation(placed(cube, 1), placed(cube, 1 - 0x1p-13)) == solid_relation::b_inside_a);
        }
    pose inner;
    for (const std::size_t k : {0U, 4U, 8U}) inner.rotation[k] = 1 - 0x1p-53;
    CHECK(relation(cube, cube, inner, {}) == solid_relation::a_inside_b);
    pose beyond;
    for (const std::size_t k : {0U, 4U, 8U}) beyond.rotation[k] = 1 + 0x1p-52;
    CHECK(relation(cube, cube, beyond, {}) == solid_relation::b_inside_a);
    // A mesh beyond the range of float in the other's frame.
    pose huge;
    for (const std::size_t k : {0U, 4U, 8U}) huge.rotation[k] = 0x1p400;
    CHECK(relation(cube, cube, huge, {}) == solid_relation::b_inside_a);
    // Shears and mirrors, the same for both.
    const pose sheared{{2, 1, 0, 0, -1, 0.5, 0, 0.25, 1}, {5, 6, 7}};
    CHECK(relation(scaled(cube, 0.5F), cube, sheared, sheared) == solid_relation::a_inside_b);
}

TEST_CASE("all trees agree on what a mesh encloses") {
    mesh outer = cut_cube(4);
    append(outer, torus(9, 7), 1, {2, 2, 9});
    mesh inner;
    for (int i = 0; i < 40; ++i)
        append(inner, aabb::unit_cube(), 0.01F,
               {static_cast<float>(i % 5) + 0.5F, static_cast<float>(i / 5 % 3) + 0.5F,
                static_cast<float>(i % 11) + 0.3F});
    const pose at = aabb::turned({1, 2, 3}, 0.7, {0.9, 0.3, -0.2});
    const posed_meshes turned{inner, outer, at, at}, unposed{inner, outer, {}, {}};
    const found_relations expected = turned.relations(aabb::canonical_tree{}, aabb::median_build{});
    CHECK(expected.a_in_b.size() > 10);
    CHECK(expected.a_in_b.size() < 40);
    for (const aabb::composition& c : compositions_of_every_tree()) {
        INFO(text_of_local(c));
        CHECK(turned.relations(c) == expected);
        CHECK(unposed.relations(c) == expected);
    }
}

TEST_CASE("what lies inside is what CGAL finds, on every extreme scene and through every tree") {
    contact_judgement contacts;
    std::size_t scenes = 0, inside = 0, outside = 0;
    for (const aabb::extreme_scene& scene : aabb::extreme_scenes(aabb::extreme_size::small)) {
        if (!scene.make_meshes || !scene.rejection.empty() || scene.query != aabb::extreme_query::all_pairs) continue;
        INFO(scene.name);
        ++scenes;
        const std::unique_ptr<aabb::mesh_scene> frames = scene.make_meshes();
        std::vector<pose> poses;
        while (frames->next(poses)) {
            const posed_meshes both{frames->meshes[frames->mesh_of[0]], frames->meshes[frames->mesh_of[1]], poses[0],
                                    poses[1]};
            const solid of_a = solid_of(both.a), of_b = solid_of(both.b);
            const std::vector<index_pair> meeting = meeting_components(of_a, of_b, both.hits);
            const judgement verdict = judge(of_a, both.pose_a, of_b, both.pose_b, meeting);
            CHECK(verdict.wrong == 0);
            inside += verdict.inside;
            outside += verdict.outside;
            judge_contacts(of_a, both.pose_a, of_b, both.pose_b, both.hits, contacts);
            CHECK(contacts.wrong == 0);
            const found_relations expected = both.relations(aabb::canonical_tree{}, aabb::median_build{});
            for (const aabb::composition& c : compositions_of_every_tree()) {
                INFO(text_of_local(c));
                CHECK(both.relations(c) == expected);
            }
        }
    }
    CHECK(scenes > 20);
    CHECK(inside + outside > 0);
}

/// A component that has a vertex in common with a shape: the shape shrunk, but for this vertex, so that a convex one
/// touches it from inside in a point; shrunk towards the vertex, or mirrored at it; or the shape itself.
mesh touching_copy(const mesh& shape, int way) {
    // The copy beyond an extreme vertex touches any shape there, and nowhere else.
    const vec3f fixed =
        way == 2 ? *std::ranges::max_element(shape.vertices, {}, [](const vec3f& v) { return v[0] + v[1] / 8; })
                 : shape.vertices[*rc::gen::inRange<std::size_t>(0, shape.vertices.size())];
    vec3f centre{};
    for (const vec3f& v : shape.vertices)
        for (int k = 0; k < 3; ++k) centre[k] += v[k] / static_cast<float>(shape.vertices.size());
    mesh copy = shape;
    for (vec3f& v : copy.vertices)
        for (int k = 0; k < 3; ++k) {
            if (way == 0 && v != fixed) v[k] = centre[k] + 0.5F * (v[k] - centre[k]);
            if (way == 1) v[k] = fixed[k] + 0.5F * (v[k] - fixed[k]);
            if (way == 2) v[k] = fixed[k] - 0.5F * (v[k] - fixed[k]);
        }
    return copy;
}

// With RC_PARAMS=max_success=10000 in the environment, 10,000 pairs of meshes; -s prints the numbers.
TEST_CASE("what lies inside is what CGAL finds, for made meshes at any poses") {
    const std::array<mesh, 7> shapes{aabb::unit_cube(), aabb::sphere(6),  flipped(torus(9, 6)), tetrahedron(1),
                                     cut_cube(3),       aabb::sphere(12), unwelded(torus(6, 5))};
    const std::vector<aabb::composition> compositions = compositions_of_every_tree();
    std::size_t pairs = 0, inside = 0, outside = 0, rejected = 0, several = 0, open = 0;
    contact_judgement contacts;
    const auto property = [&] {
        // Components of sizes from 1/8 to 8 around each other, on a lattice or not; some are not closed.
        const auto make = [&](int most_exponent, std::vector<mesh>& parts) {
            const int components = *rc::gen::inRange(1, 5);
            for (int i = 0; i < components; ++i) {
                const mesh& shape = shapes[*rc::gen::inRange<std::size_t>(0, shapes.size())];
                const float size = std::ldexp(1.0F, *rc::gen::inRange(most_exponent - 3, most_exponent + 1));
                const bool on_lattice = *rc::gen::arbitrary<bool>();
                const auto shift = [&] {
                    return on_lattice ? static_cast<float>(*rc::gen::inRange(-8, 9)) / 4
                                      : static_cast<float>(uniform(-2, 2));
                };
                const bool is_open = *rc::gen::inRange(0, 8) == 0;
                parts.push_back(
                    scaled(is_open ? without_triangle(shape, 2) : shape, size, {shift(), shift(), shift()}));
            }
        };
        std::vector<mesh> parts_a, parts_b;
        make(-1, parts_a);
        make(2, parts_b);
        if (*rc::gen::arbitrary<bool>())
            parts_a.push_back(touching_copy(parts_b[*rc::gen::inRange<std::size_t>(0, parts_b.size())],
                                            *rc::gen::element(0, 1, 1, 1, 2, 2, 2, 3)));
        mesh a, b;
        for (const mesh& part : parts_a) append(a, part, 1, {0, 0, 0});
        for (const mesh& part : parts_b) append(b, part, 1, {0, 0, 0});
        pose pose_a, pose_b;
        switch (*rc::gen::element(0, 1, 2, 3)) {
            case 0: break;
            case 1: pose_a.translation = any_vector(1); break;
            case 2: pose_a = pose_b = any_turned(any_vector(1e3)); break;
            default: pose_a = any_turned(any_vector(1)); pose_b = any_turned({0, 0, 0});
        }
        const solid of_a = solid_of(a), of_b = solid_of(b);
        const std::vector<index_pair> hits = hits_of(a, pose_a, b, pose_b);
        const std::vector<index_pair> meeting = meeting_components(of_a, of_b, hits);
        std::vector<index_pair> meeting_b;
        for (const auto [i, j] : meeting) meeting_b.push_back({j, i});
        std::ranges::sort(meeting_b);
        const judgement a_in_b = judge(of_a, pose_a, of_b, pose_b, meeting);
        const judgement b_in_a = judge(of_b, pose_b, of_a, pose_a, meeting_b);
        RC_ASSERT(a_in_b.wrong + b_in_a.wrong == 0U);
        judge_contacts(of_a, pose_a, of_b, pose_b, hits, contacts);
        RC_ASSERT(contacts.wrong == 0U);
        RC_ASSERT(contacts.unexplained == 0U);
        const posed_meshes both{a, b, pose_a, pose_b, hits};
        const aabb::composition composition = *rc::gen::elementOf(compositions);
        RC_LOG(text_of_local(composition));
        RC_ASSERT(both.relations(composition) == both.relations(aabb::canonical_tree{}, aabb::median_build{}));
        ++pairs;
        inside += a_in_b.inside + b_in_a.inside;
        outside += a_in_b.outside + b_in_a.outside;
        rejected += a_in_b.rejected + b_in_a.rejected;
        several += of_a.parts().size() > 1 && of_b.parts().size() > 1;
        open += !of_a.is_closed() || !of_b.is_closed();
    };
    // Some classes are rare: a hundred draws may have none.
    for (int round = 0; round < 3; ++round) REQUIRE(rc::check(property));
    CAPTURE(pairs, inside, outside, rejected, several, open);
    CAPTURE(contacts.counts[contact_relation::touching], contacts.counts[contact_relation::a_inside_b],
            contacts.counts[contact_relation::b_inside_a], contacts.counts[contact_relation::equal],
            contacts.counts[contact_relation::crossing], contacts.counts[contact_relation::undecided],
            contacts.rejected);
    CHECK(inside > 5);
    CHECK(outside > 20);
    CHECK(several > 5);
    CHECK(open > 5);
    CHECK(contacts.touching_from_inside() > 1);
    CHECK(contacts.counts[contact_relation::touching] > 1);
}

/// A slender copy of a mesh that shares a vertex with another one, and lies below or above it there.
std::optional<mesh> copy_at_vertex(const mesh& m, const mesh& other, double factor) {
    const auto corners = other.triangles[*rc::gen::inRange<std::size_t>(0, other.triangles.size())];
    const vec3d at = other.given_vertex(corners[0]);
    vec3d up{};
    for (std::uint32_t t = 0; t < other.triangle_count(); ++t) {
        const aabb::triangle3d s = other.given_triangle(t);
        if (s[0] != at && s[1] != at && s[2] != at) continue;
        const vec3d normal = cross(s[1] - s[0], s[2] - s[0]);
        for (int k = 0; k < 3; ++k) up[k] += normal[k];
    }
    const auto scaled_to_1 = [](vec3d v) {
        const double length = std::sqrt(dot(v, v));
        for (int k = 0; k < 3; ++k) v[k] /= length;
        return v;
    };
    // The vertex of the copy farthest along a direction, which is turned to the normal by half a turn about their sum.
    vec3d direction = scaled_to_1(any_vector(1)), middle{};
    up = scaled_to_1(up);
    const double sign = *rc::gen::inRange(0, 4) == 0 ? -1 : 1;
    for (int k = 0; k < 3; ++k) middle[k] = direction[k] + sign * up[k];
    if (!(dot(middle, middle) > 1e-3)) return std::nullopt;
    middle = scaled_to_1(middle);
    vec3d top = m.given_vertex(m.triangles[0][0]);
    for (const auto& triangle : m.triangles)
        for (const std::uint32_t v : triangle)
            if (dot(direction, m.given_vertex(v) - top) > 0) top = m.given_vertex(v);
    mesh copy = m;
    std::vector<vec3d> vertices;
    for (std::size_t v = 0; v < m.vertices.size(); ++v) {
        vec3d from_top = m.given_vertex(v) - top;
        const double height = dot(direction, from_top);
        for (int k = 0; k < 3; ++k) from_top[k] = 0.9 * height * direction[k] + 0.1 * from_top[k];
        const double along = 2 * dot(middle, from_top);
        vec3d moved{};
        for (int k = 0; k < 3; ++k) moved[k] = at[k] + factor * (along * middle[k] - from_top[k]);
        vertices.push_back(moved);
    }
    set_vertices(copy, vertices);
    return copy;
}

// With RC_PARAMS=max_success=200 in the environment, 200 pairs of meshes; -s prints the numbers.
TEST_CASE("what lies inside is what CGAL finds, for real meshes at any poses") {
    const char* const folder = std::getenv("AABBLAB_DATA");
    if (folder == nullptr) SKIP("AABBLAB_DATA is not set, where real meshes are");
    std::vector<mesh> meshes;
    std::vector<std::filesystem::path> files;
    for (const auto& entry : std::filesystem::directory_iterator(folder))
        if (entry.path().extension() == ".off" && entry.file_size() < 1'000'000) files.push_back(entry.path());
    std::ranges::sort(files);
    for (const auto& file : files) {
        if (!is_surface(file)) continue;
        meshes.push_back(aabblab::read_mesh(file).mesh);
        if (meshes.back().triangle_count() > 6'000) meshes.pop_back();
    }
    REQUIRE(meshes.size() > 50);
    std::size_t pairs = 0, without_hits = 0, inside = 0, outside = 0, rejected = 0, several = 0, open = 0;
    contact_judgement contacts;
    REQUIRE(rc::check([&] {
        mesh a = meshes[*rc::gen::inRange<std::size_t>(0, meshes.size())];
        const mesh& b = meshes[*rc::gen::inRange<std::size_t>(0, meshes.size())];
        const auto extent = [](const mesh& m) {
            const aabb::box bounds = bounds_of(m);
            const int k = longest_axis(bounds);
            return m.frame.scale * (double{bounds.max[k]} - double{bounds.min[k]});
        };
        const double factor = extent(b) / extent(a) * std::pow(10, uniform(-2.5, 0.3));
        pose pose_a, pose_b;
        if (*rc::gen::arbitrary<bool>()) {
            // A is scaled to a part of B and shares a vertex with it.
            std::optional<mesh> copy = copy_at_vertex(a, b, factor / 10);
            RC_PRE(copy.has_value());
            a = std::move(*copy);
            if (*rc::gen::arbitrary<bool>()) pose_a = pose_b = any_turned(any_vector(1));
        } else {
            // A is turned, scaled and placed in the box of B.
            pose_a = any_turned({0, 0, 0});
            for (double& r : pose_a.rotation) r *= factor;
            const aabb::box bounds = bounds_of(b);
            const vec3d low = b.frame.vertex(aabb::in_double(bounds.min));
            const vec3d high = b.frame.vertex(aabb::in_double(bounds.max));
            const vec3d at = a.given_vertex(a.triangles[0][0]);
            for (int i = 0; i < 3; ++i) {
                double turned = 0;
                for (int j = 0; j < 3; ++j) turned += pose_a.rotation[static_cast<std::size_t>(3 * i + j)] * at[j];
                pose_a.translation[i] = low[i] + uniform(0.1, 0.9) * (high[i] - low[i]) - turned;
            }
        }
        const solid of_a = solid_of(a), of_b = solid_of(b);
        const std::vector<index_pair> hits = hits_of(a, pose_a, b, pose_b);
        const std::vector<index_pair> meeting = meeting_components(of_a, of_b, hits);
        const judgement verdict = judge(of_a, pose_a, of_b, pose_b, meeting);
        RC_ASSERT(verdict.wrong == 0U);
        judge_contacts(of_a, pose_a, of_b, pose_b, hits, contacts);
        RC_ASSERT(contacts.wrong == 0U);
        ++pairs;
        without_hits += meeting.empty();
        inside += verdict.inside;
        outside += verdict.outside;
        rejected += verdict.rejected;
        several += of_a.parts().size() > 1 || of_b.parts().size() > 1;
        open += !of_a.is_closed() || !of_b.is_closed();
    }));
    CAPTURE(pairs, without_hits, inside, outside, rejected, several, open);
    CAPTURE(contacts.counts[contact_relation::touching], contacts.counts[contact_relation::a_inside_b],
            contacts.counts[contact_relation::b_inside_a], contacts.counts[contact_relation::equal],
            contacts.counts[contact_relation::crossing], contacts.counts[contact_relation::undecided],
            contacts.rejected, contacts.unexplained);
    CHECK(without_hits > 20);
    CHECK(inside > 5);
    CHECK(outside > 20);
    CHECK(contacts.touching_from_inside() > 0);
}
