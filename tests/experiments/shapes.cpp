#include "mesh_bytes.hpp"

import aabb.triangle.exact;
import aabblab.scenes;

namespace {

/// Whether every edge occurs once in each direction: the mesh is closed and consistently oriented.
bool is_closed(const aabb::mesh& m) {
    std::set<std::pair<std::uint32_t, std::uint32_t>> edges;
    for (const auto& t : m.triangles)
        for (std::size_t i = 0; i < 3; ++i)
            if (!edges.insert({t[i], t[(i + 1) % 3]}).second) return false;
    for (const auto& [a, b] : edges)
        if (!edges.contains({b, a})) return false;
    return true;
}

/// Six times the enclosed volume; positive if triangles face outwards.
double volume(const aabb::mesh& m) {
    double sum = 0;
    for (std::uint32_t i = 0; i < m.triangle_count(); ++i) {
        const aabb::triangle3f t = m.triangle(i);
        aabb::triangle3d d{};
        for (int c = 0; c < 3; ++c)
            for (int k = 0; k < 3; ++k) d[c][k] = t[c][k];
        sum += aabb::dot(d[0], aabb::cross(d[1], d[2]));
    }
    return sum;
}

std::string error_of(const std::string& name) {
    return refusal_in<aabb::input_error>([&] { return aabblab::make_mesh(name); });
}

/// Sets AABBLAB_DATA during its lifetime.
class data_folder_at {
public:
    explicit data_folder_at(const std::filesystem::path& folder) { setenv("AABBLAB_DATA", folder.c_str(), 1); }
    data_folder_at(const data_folder_at&) = delete;
    data_folder_at& operator=(const data_folder_at&) = delete;
    ~data_folder_at() { unsetenv("AABBLAB_DATA"); }
};

}  // namespace

TEST_CASE("shapes have the requested number of triangles, and all but square and slivers are closed") {
    const temporary_folder folder;
    for (const auto& [shape, summary, parameters] : aabblab::shapes())
        for (const std::uint32_t requested : {100U, 1000U, 1234U, 5000U, 20000U, 100000U}) {
            CAPTURE(shape, requested);
            const aabb::mesh m = aabblab::make_mesh(shape + ":triangles=" + std::to_string(requested)).mesh;
            const bool closed = shape != "square" && shape != "slivers";
            REQUIRE(is_closed(m) == closed);
            if (closed) REQUIRE(volume(m) > 0);
            REQUIRE_NOTHROW(aabb::require_valid(m));
            aabblab::write_off(m, folder / "m.off");
            REQUIRE(aabblab::read_mesh(folder / "m.off").report.zero_area == 0);
            // An icosphere has 20 n² triangles, so the nearest is up to half a step of n away.
            const double tolerance = shape == "icosphere" ? std::max(20.0, 1.1 * std::sqrt(20.0 * requested))
                                     : shape == "square"  ? 2 * std::sqrt(2.0 * requested)
                                     : requested < 200    ? 8
                                                          : 2;
            REQUIRE(std::abs(static_cast<double>(m.triangle_count()) - requested) <= tolerance);
        }
    REQUIRE(aabblab::make_mesh("icosphere").mesh.triangle_count() == 5120);
    REQUIRE(aabblab::make_mesh("torus_knot:triangles=20000").mesh.triangle_count() == 20000);
}

TEST_CASE("slivers in the gaps of others have overlapping boxes, but do not intersect") {
    constexpr std::uint32_t n = 300;
    const aabb::mesh m = aabblab::make_mesh("slivers:triangles=" + std::to_string(n)).mesh;
    const double gap = 10 * std::sqrt(0.5) / n;
    for (const double shift : {0.0, gap / 2}) {
        std::uint64_t boxes = 0, hits = 0;
        for (std::uint32_t i = 0; i < n; ++i)
            for (std::uint32_t j = 0; j < n; ++j) {
                aabb::triangle3f other = m.triangle(j);
                for (int c = 0; c < 3; ++c) {
                    other[c][0] += static_cast<float>(shift);
                    other[c][1] -= static_cast<float>(shift);
                }
                boxes += aabb::overlaps(aabb::bounds_of(m.triangle(i)), aabb::bounds_of(other));
                hits += aabb::exact_triangle::intersects(m.triangle(i), other);
            }
        CHECK(boxes == std::uint64_t{n} * n);
        CHECK(hits == (shift == 0 ? n : 0));
    }
}

TEST_CASE("shapes are the same on every platform, in any order of triangles") {
    const auto digest_of = [](const std::string& name) {
        const aabb::mesh m = aabblab::make_mesh(name).mesh;
        aabb::digest digest;
        for (const aabb::vec3f& v : m.vertices) digest.add(std::bit_cast<std::array<std::uint32_t, 3>>(v));
        for (const auto& t : m.triangles) digest.add(t);
        return digest.text();
    };
    CHECK(digest_of("icosphere:triangles=1000") == "d755fdaa678cfdc0");
    CHECK(digest_of("noise_sphere:triangles=1000") == "dcf74046466fc0c4");
    CHECK(digest_of("torus_knot:triangles=1000") == "ffebf8a1a850ed68");
    CHECK(digest_of("slivers:triangles=1000") == "c9b2b687bdd3937c");
    CHECK(digest_of("torus_knot:triangles=20000,order=sah") == "6c5d77a09de53bdd");
    CHECK(digest_of("torus_knot:triangles=20000,order=median") == "e02228f01ba3f345");
}

TEST_CASE("a mesh in the order of a build keeps its triangles") {
    const auto corners_of = [](const aabb::mesh& m) {
        std::vector<std::array<float, 9>> xyz(m.triangles.size());
        for (std::size_t t = 0; t < xyz.size(); ++t)
            for (std::size_t k = 0; k < 9; ++k) xyz[t][k] = m.vertices[m.triangles[t][k / 3]][static_cast<int>(k % 3)];
        return sorted(xyz);
    };
    const aabb::mesh plain = aabblab::make_mesh("torus_knot:triangles=2000").mesh;
    for (const char* build : {"median", "sah"}) {
        const aabb::mesh ordered = aabblab::make_mesh(std::string("torus_knot:triangles=2000,order=") + build).mesh;
        CHECK(corners_of(ordered) == corners_of(plain));
        CHECK(ordered.triangles != plain.triangles);
    }
}

TEST_CASE_METHOD(in_folder, "a mesh is named by a file, a file in the data folder or a shape") {
    const data_folder_at here(folder.path());
    REQUIRE(aabblab::data_folder() == folder.path());
    folder.write("elephant.off", "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n4 0 1 2 0\n");
    REQUIRE(aabblab::make_mesh("elephant.off").report.polygons == 1);
    REQUIRE(aabblab::make_mesh((folder / "elephant.off").string()).mesh.triangle_count() == 2);
    const std::string where =
        " (a mesh is a file, here or in " + folder.path().string() + ", where ./aabblab data puts some, or a shape)";
    REQUIRE(error_of("elefant.off") == "unknown mesh 'elefant.off'; did you mean 'elephant.off'?" + where);
    REQUIRE(error_of("ikosphere") == "unknown mesh 'ikosphere'; did you mean 'icosphere'?" + where);
    REQUIRE(error_of("").starts_with("unknown mesh ''"));
    REQUIRE(error_of("").ends_with(where));
    REQUIRE_FALSE(holds(error_of(""), "did you mean"));
    REQUIRE(error_of(folder.path().string()) == folder.path().string() + ": is a folder, not a file");
    REQUIRE(error_of("icosphere:triangle=7") == "unknown parameter of icosphere 'triangle'; did you mean 'triangles'?");
    REQUIRE(error_of("icosphere:triangles=1e9") ==
            "icosphere: triangles must be a whole number from 20 to 100000000, not '1e9'");
    REQUIRE(aabblab::is_mesh("elephant.off:order=sah", {}));
    REQUIRE_FALSE(aabblab::is_mesh("elefant.off:order=sah", {}));
    REQUIRE(aabblab::make_mesh("elephant.off:order=sah").mesh.triangle_count() == 2);
    REQUIRE(aabblab::make_mesh("elephant.off:order=sah").report.polygons == 1);
    REQUIRE(error_of("elephant.off:order=sag") == "unknown build 'sag'; did you mean 'sah'?");
    REQUIRE(error_of("icosphere:order=").starts_with("unknown build ''"));
    REQUIRE(error_of("icosphere:order=sah,triangles=80") ==
            "order=BUILD must end the name of a mesh and takes no parameters, as in "
            "torus_knot:triangles=5000,order=sah, not as in 'icosphere:order=sah,triangles=80'");
    folder.write("x:order=sah.off", "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n");
    REQUIRE(aabblab::make_mesh("x:order=sah.off").mesh.triangle_count() == 1);
    REQUIRE(error_of("icosphere:order=sah:order=sah").starts_with("order=BUILD must end the name of a mesh"));
    REQUIRE(error_of("icosphere,order=sah").starts_with("unknown mesh 'icosphere,order=sah'"));
    REQUIRE(aabblab::name_without_order("icosphere:triangles=80,order=sah") == "icosphere:triangles=80");
    REQUIRE(error_of("torus_knot:5000") == "'5000' after 'torus_knot:' is not of the form name=value");
}
