#include <rapidcheck.h>

#include "mesh_bytes.hpp"

using Catch::Matchers::EndsWith;

namespace {

using polygon = std::vector<aabb::vec3f>;
using numbers = std::vector<std::uint32_t>;

std::string error_of(const std::string& name, const std::string& bytes) {
    return refusal_in<aabb::input_error>([&] { return read(name, bytes); });
}

/// A binary PLY file with a single face.
std::string ply(const polygon& vertices, const numbers& face) {
    std::string bytes = "ply\nformat binary_little_endian 1.0\nelement vertex " + std::to_string(vertices.size()) +
                        "\nproperty float x\nproperty float y\nproperty float z\nelement face 1\n"
                        "property list uint uint vertex_indices\nend_header\n";
    for (const aabb::vec3f& p : vertices)
        for (int k = 0; k < 3; ++k) bytes += raw(p[k]);
    bytes += raw(static_cast<std::uint32_t>(face.size()));
    for (const std::uint32_t corner : face) bytes += raw(corner);
    return bytes;
}

numbers consecutive(std::size_t count) {
    numbers face(count);
    std::iota(face.begin(), face.end(), 0U);
    return face;
}

aabblab::loaded_mesh mesh_of(const polygon& vertices, const numbers& face) {
    return read("a.ply", ply(vertices, face));
}
aabblab::loaded_mesh mesh_of(const polygon& vertices) {
    return mesh_of(vertices, consecutive(vertices.size()));
}
std::string rejection_of(const polygon& vertices) {
    return error_of("a.ply", ply(vertices, consecutive(vertices.size())));
}
const std::string crosses = "crosses itself";
const std::string no_normal = "has no normal, as its signed area is zero";

triangles fan(std::uint32_t corners) {
    triangles expected;
    for (std::uint32_t i = 2; i < corners; ++i) expected.push_back({0, i - 1, i});
    return expected;
}

triangles reversed(triangles list) {
    for (auto& [a, b, c] : list) std::swap(a, c);
    return list;
}

// Integer geometry in the plane.

struct point {
    std::int64_t u;
    std::int64_t v;
};
using flat_polygon = std::vector<point>;

std::int64_t twice_area(const point& a, const point& b, const point& c) {
    return (b.u - a.u) * (c.v - a.v) - (b.v - a.v) * (c.u - a.u);
}
std::int64_t twice_area(const flat_polygon& p) {
    std::int64_t sum = 0;
    for (std::size_t i = 0; i < p.size(); ++i) sum += twice_area({0, 0}, p[i], p[(i + 1) % p.size()]);
    return sum;
}

/// Whether the interiors of two counterclockwise triangles intersect.
bool overlap(const std::array<point, 3>& s, const std::array<point, 3>& t) {
    const auto separates = [](const std::array<point, 3>& a, const std::array<point, 3>& b) {
        for (std::size_t i = 0; i < 3; ++i)
            if (std::ranges::all_of(b, [&](const point& p) { return twice_area(a[i], a[(i + 1) % 3], p) <= 0; }))
                return true;
        return false;
    };
    return !separates(s, t) && !separates(t, s);
}

/// Requires a triangulation of the polygon: no triangle is flipped, none overlap, and their areas add up to its area.
void require_triangulation(const flat_polygon& p, const triangles& parts) {
    const std::int64_t area = twice_area(p);
    std::int64_t sum = 0;
    std::vector<std::array<point, 3>> filled;
    for (const auto& [a, b, c] : parts) {
        const std::int64_t part = twice_area(p[a], p[b], p[c]);
        RC_ASSERT(!(area > 0 ? part < 0 : part > 0));
        sum += part;
        if (part > 0) filled.push_back({p[a], p[b], p[c]});
        if (part < 0) filled.push_back({p[c], p[b], p[a]});
    }
    RC_ASSERT(sum == area);
    RC_ASSERT(parts.size() == p.size() - 2);
    for (std::size_t i = 0; i < filled.size(); ++i)
        for (std::size_t j = 0; j < i; ++j) RC_ASSERT_FALSE(overlap(filled[i], filled[j]));
}

/// Embeds the polygon in a random plane in which its coordinates are exact floats.
polygon embedded_in_space(const flat_polygon& p) {
    const int axis = *rc::gen::inRange(0, 3);
    const int slope_u = *rc::gen::inRange(-1, 2);
    const int slope_v = *rc::gen::inRange(-1, 2);
    const int scale = *rc::gen::element(0, -149, 100);
    polygon embedded;
    for (const point& q : p) {
        aabb::vec3f at{};
        at[(axis + 1) % 3] = std::ldexp(static_cast<float>(q.u), scale);
        at[(axis + 2) % 3] = std::ldexp(static_cast<float>(q.v), scale);
        at[axis] = std::ldexp(static_cast<float>(slope_u * q.u + slope_v * q.v), scale);
        embedded.push_back(at);
    }
    return embedded;
}

/// A star-shaped polygon: points sorted by their directions from the origin, of which no two are equal.
flat_polygon any_star() {
    flat_polygon p = {{40, 0}, {-40, 41}, {-40, -41}};
    for (int extra = *rc::gen::inRange(1, 20); extra > 0; --extra) {
        const point q{*rc::gen::inRange(-40, 41), *rc::gen::inRange(-40, 41)};
        const auto has_same_direction = [&](const point& r) {
            return twice_area({0, 0}, q, r) == 0 && q.u * r.u + q.v * r.v >= 0;
        };
        if (std::ranges::none_of(p, has_same_direction)) p.push_back(q);
    }
    const auto is_lower = [](const point& q) { return q.v < 0 || (q.v == 0 && q.u < 0); };
    std::ranges::sort(p, [&](const point& q, const point& r) {
        return is_lower(q) != is_lower(r) ? is_lower(r) : twice_area({0, 0}, q, r) > 0;
    });
    return p;
}

}  // namespace

TEST_CASE("polygons: a concave polygon is ear-clipped in the same way from any first corner") {
    const polygon notched = {{0, 0, 0}, {2, 0, 0}, {2, 1, 0}, {1, 1, 0}, {1, 2, 0}, {0, 2, 0}};
    const triangles ears = mesh_of(notched).mesh.triangles;
    CHECK(ears == triangles{{0, 1, 2}, {3, 4, 5}, {0, 2, 3}, {3, 5, 0}});
    numbers face = consecutive(6);
    for (int first = 0; first < 6; ++first) {
        CHECK(mesh_of(notched, face).mesh.triangles == ears);
        CHECK(mesh_of(notched, face).report.text() == "1 concave polygon ear-clipped");
        std::ranges::rotate(face, face.begin() + 1);
    }
    std::ranges::reverse(face);
    CHECK(mesh_of(notched, face).mesh.triangles == reversed(ears));
    // Its triangles take the place of the face.
    const std::string off =
        "OFF\n6 4 0\n0 0 0\n2 0 0\n2 1 0\n1 1 0\n1 2 0\n0 2 0\n3 0 1 2\n4 0 1 2 3\n"
        "6 0 1 2 3 4 5\n3 3 4 5\n";
    const aabblab::loaded_mesh loaded = read("a.off", off);
    CHECK(loaded.report.text() == "1 polygon fan-triangulated, 1 concave polygon ear-clipped");
    CHECK(loaded.mesh.triangles ==
          triangles{{0, 1, 2}, {0, 1, 2}, {0, 2, 3}, ears[0], ears[1], ears[2], ears[3], {3, 4, 5}});
}

TEST_CASE("polygons: a convex polygon is fan-triangulated from its first corner") {
    const polygon octagon = {{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {3, 1, 0}, {3, 2, 0}, {2, 3, 0}, {0, 3, 0}, {0, 1, 0}};
    CHECK(mesh_of(octagon).mesh.triangles == fan(8));
    CHECK(mesh_of(octagon).report.text() == "1 polygon fan-triangulated, 2 triangles of zero area kept");
    // It is not planar, but convex along its normal.
    CHECK(mesh_of({{0, 0, 0}, {1, 0, 1}, {1, 1, 0}, {0, 1, 1}}).mesh.triangles == fan(4));
}

TEST_CASE("polygons: a polygon that intersects itself or has no normal is rejected with its line") {
    const std::string bow = "0 0 0\n2 2 0\n2 0 0\n0 1 0\n";
    CHECK_THAT(error_of("a.off", "OFF\n4 2 0\n" + bow + "3 0 1 2\n4 0 1 2 3\n"),
               EndsWith("/a.off:8: the boundary of a face of 4 corners " + crosses));
    CHECK_THAT(error_of("a.obj", "v 0 0 0\nv 2 2 0\nv 2 0 0\nv 0 2 0\nf 1 2 3\nf 1 2 3 4\n"),
               EndsWith("/a.obj:6: the boundary of a face of 4 corners " + no_normal));
    CHECK_THAT(error_of("a.ply",
                        "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\n"
                        "property float z\nelement face 1\nproperty list uchar int vertex_indices\n"
                        "end_header\n" +
                            bow + "4 0 1 2 3\n"),
               EndsWith("/a.ply:14: the boundary of a face of 4 corners " + crosses));
    CHECK_THAT(rejection_of({{0, 0, 0}, {2, 2, 0}, {2, 0, 0}, {0, 1, 0}}),
               EndsWith("/a.ply: face 0: the boundary of a face of 4 corners " + crosses));

    CHECK_THAT(rejection_of({{0, 0, 0}, {1, 1, 1}, {2, 2, 2}, {3, 3, 3}}), EndsWith(no_normal));
    // These turn only left: a pentagram, a doubly traversed square, and a loop that overlaps itself.
    CHECK_THAT(rejection_of({{0, 3, 0}, {-2, -3, 0}, {3, 1, 0}, {-3, 1, 0}, {2, -3, 0}}), EndsWith(crosses));
    CHECK_THAT(rejection_of({{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}}),
               EndsWith(crosses));
    CHECK_THAT(rejection_of({{0, 0, 0}, {4, 0, 0}, {4, 4, 0}, {1, 4, 0}, {1, -1, 0}, {2, -1, 0}, {2, 3, 0}, {0, 3, 0}}),
               EndsWith(crosses));
}

TEST_CASE("polygons: repeated corners count once") {
    const polygon p = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {1, 0, 0}};
    CHECK(mesh_of(p, {0, 1, 1, 2}).mesh.triangles == triangles{{0, 1, 1}, {0, 1, 2}});
    CHECK(mesh_of(p, {0, 1, 4, 2, 3}).mesh.triangles == triangles{{0, 1, 4}, {0, 4, 2}, {0, 2, 3}});
    // The rest is a triangle, a segment or a point, and is kept.
    CHECK(mesh_of({{0, 0, 0}, {1, 1, 1}, {2, 2, 2}}, {0, 1, 1, 2}).mesh.triangles.size() == 2);
    CHECK(mesh_of(p, {0, 0, 1, 1}).mesh.triangles.size() == 2);
    CHECK(mesh_of(p, {2, 2, 2, 2}).report.text() == "1 polygon fan-triangulated, 2 triangles of zero area kept");
    // It is concave and repeats a corner.
    CHECK(mesh_of({{0, 0, 0}, {4, 0, 0}, {1, 1, 0}, {1, 1, 0}, {0, 4, 0}}).report.concave == 1);
}

TEST_CASE("polygons: a boundary may touch itself and retrace edges") {
    // The two digits of a corner are its coordinates.
    const auto check_polygon = [](std::string_view corners) {
        flat_polygon flat;
        polygon p;
        for (std::size_t i = 0; i < corners.size(); i += 3) {
            const point& q = flat.emplace_back(point{corners[i] - '0', corners[i + 1] - '0'});
            p.push_back({static_cast<float>(q.u), static_cast<float>(q.v), 0});
        }
        const aabblab::loaded_mesh loaded = mesh_of(p);
        CHECK(loaded.report.concave == 1);
        require_triangulation(flat, loaded.mesh.triangles);
    };
    // A hole, two holes, and a hole with a bent bridge.
    check_polygon("00 90 99 09 00 34 36 66 63 34");
    check_polygon("00 90 99 09 00 11 12 22 11 33 34 44 33 11");
    check_polygon("00 90 99 09 00 25 33 36 66 63 33 25");
    // Two squares that share a corner, and two squares with a bent bridge.
    check_polygon("00 10 11 21 22 12 11 01");
    check_polygon("00 10 11 23 42 52 53 43 42 23 11 01");
    // Spikes outwards and inwards, the latter bent.
    check_polygon("00 40 42 62 42 44 04");
    check_polygon("00 40 42 22 23 22 42 44 04");
    // A corner touches an edge.
    check_polygon("00 40 44 20 04");
}

TEST_CASE("polygons: predicates are exact") {
    // A corner lies on the diagonal, or one unit in the last place from it, far from the origin.
    const auto cut_at = [](float x) {
        const polygon p = {{16777214, 16777214, 5}, {16777216, 16777214, 5}, {x, x, 5}, {16777214, 16777216, 5}};
        return mesh_of(p).report.concave;
    };
    CHECK(cut_at(16777215) == 0);
    CHECK(cut_at(16777216) == 0);
    const auto bent = [](float inwards, float s) {
        return mesh_of({{0, 0, s}, {3 * s, 0, s}, {3 * s, 3 * s, s}, {2 * s, 2 * s - inwards, s}});
    };
    CHECK(bent(0, 1).report.concave == 0);
    CHECK(bent(0x1p-22F, 1).report.concave == 1);
    CHECK(bent(-0x1p-22F, 1).report.concave == 0);
    CHECK(bent(0, 1e38F).report.concave == 0);
    CHECK(bent(0x1p104F, 0x1p126F).report.concave == 1);
    CHECK(bent(0x1p-149F, 0x1p-149F).report.concave == 1);
    CHECK(bent(0x1p-149F, 0x1p-140F).report.concave == 1);
    // The x component of the normal is the largest by its last bit; projected along z the boundary crosses itself.
    const float largest = std::numeric_limits<float>::max();
    CHECK(mesh_of({{-largest, -largest, 0}, {largest, -largest, 0}, {largest, largest, 0}, {-largest, largest, 0}})
              .report.concave == 0);
    CHECK(mesh_of({{-largest, 0, 1}, {0, -0x1p-149F, 1}, {largest, 0, 1}, {0, -0x1p-148F, 1}}).report.concave == 1);
}

TEST_CASE("polygons: a star-shaped polygon is triangulated from any first corner in either direction") {
    REQUIRE(rc::check([] {
        const flat_polygon flat = any_star();
        const polygon p = embedded_in_space(flat);
        numbers face = consecutive(p.size());
        const aabblab::loaded_mesh loaded = mesh_of(p, face);
        require_triangulation(flat, loaded.mesh.triangles);
        std::ranges::rotate(face, face.begin() + *rc::gen::inRange<std::ptrdiff_t>(0, std::ssize(face)));
        const aabblab::loaded_mesh rotated = mesh_of(p, face);
        RC_ASSERT(rotated.report.concave == loaded.report.concave);
        require_triangulation(flat, rotated.mesh.triangles);
        if (loaded.report.concave == 0) return;
        RC_ASSERT(rotated.mesh.triangles == loaded.mesh.triangles);
        std::ranges::reverse(face);
        RC_ASSERT(mesh_of(p, face).mesh.triangles == reversed(loaded.mesh.triangles));
    }));
}

TEST_CASE("polygons: every accepted polygon is triangulated") {
    REQUIRE(rc::check([] {
        const int size = *rc::gen::inRange(2, 7);
        flat_polygon flat;
        for (int corners = *rc::gen::inRange(4, 10); corners > 0; --corners)
            flat.push_back({*rc::gen::inRange(0, size), *rc::gen::inRange(0, size)});
        // Some have a spike at the end.
        if (*rc::gen::arbitrary<bool>())
            flat.insert(flat.end(), {{*rc::gen::inRange(0, size), *rc::gen::inRange(0, size)}, flat.back()});
        const polygon p = embedded_in_space(flat);
        const std::string rejection = rejection_of(p);
        const std::int64_t area = twice_area(flat);
        // A point or a retraced path may be kept with zero area.
        if (rejection == "accepted" && area != 0) require_triangulation(flat, mesh_of(p).mesh.triangles);
        RC_ASSERT(rejection.ends_with(no_normal) <= (area == 0));
    }));
}

TEST_CASE("polygons: a polygon of ten thousand corners is triangulated") {
    polygon comb;
    for (int tooth = 0; tooth < 5000; ++tooth) {
        comb.push_back({static_cast<float>(tooth), 1, 0});
        comb.push_back({static_cast<float>(tooth), 9, 0});
    }
    comb.push_back({5000, 0, 0});
    comb.push_back({-1, 0, 0});
    const aabblab::loaded_mesh loaded = mesh_of(comb);
    CHECK(loaded.report.text() == "1 concave polygon ear-clipped");
    CHECK(loaded.mesh.triangle_count() == 10'000);
}
