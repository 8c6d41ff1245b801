#include <rapidcheck.h>

#include "mesh_bytes.hpp"

namespace {

/// The first coordinate of an OFF file, given as this text.
double read_coordinate(const temporary_folder& folder, const std::string& text) {
    const auto file = folder.write("a.off", "OFF\n3 1 0\n" + text + " 0 0\n0 1 0\n0 0 1\n3 0 1 2\n");
    return aabblab::read_mesh(file).mesh.given_vertex(0)[0];
}

bool same_bits(double a, double b) {
    return std::bit_cast<std::uint64_t>(a) == std::bit_cast<std::uint64_t>(b);
}

}  // namespace

TEST_CASE_METHOD(in_folder, "text coordinates are correctly rounded") {
    std::istringstream texts(
        "0.1 -0 0.3 1e23 8388608.5 8388609.5 16777217 16777217.0000000000000000000000000001 "
        "16777216.999999999999999999999999999 1.00000005960464477539062499999 1.000000059604644775390625 "
        "1.00000005960464477539062500001 1.00000017881393432617187499999 1.000000178813934326171875 "
        "1.000000178813934326171875000000000000000000001 3.4028234663852886e38 3.4028235677973365e38 1.17549435e-38 "
        "1.1754942106924411e-38 1.4e-45 7.0064923216240853546186479164495806564013e-46 "
        "7.0064923216240853546186479164495806564014e-46 7.1e-46 7e-46 1e-60 -1e-999 0e999 "
        "0.00000000000000000000000000000000000000000000140129846432481707092372958328991613128026194187651577 "
        "9007199254740993 123456789012345678901234567890 .5 5. 0.000000000000000000000000000000000001 "
        "2.3509887016445750159374730744444913556373311135441750430175034126e-38");
    for (std::string text; texts >> text;) {
        CAPTURE(text);
        REQUIRE(same_bits(read_coordinate(folder, text), std::strtod(text.c_str(), nullptr)));
    }
}

TEST_CASE_METHOD(in_folder, "decimals near the midpoint of two doubles are correctly rounded") {
    REQUIRE(rc::check("agrees with strtod", [&](std::uint64_t bits, std::uint64_t digits, bool below) {
        const double low = std::fabs(std::bit_cast<double>(bits));
        const double high = std::nextafter(low, std::numeric_limits<double>::infinity());
        RC_PRE(std::isfinite(high));
        const long double midpoint = (static_cast<long double>(low) + static_cast<long double>(high)) / 2;
        // All digits of the midpoint, or of the last number of 64 bits before it, and then some more.
        std::array<char, 1024> text{};
        std::snprintf(text.data(), text.size(), "%.800Le", below ? std::nextafter(midpoint, 0) : midpoint);
        std::string decimal = text.data();
        decimal.insert(decimal.find('e'), std::to_string(digits));
        RC_ASSERT(same_bits(read_coordinate(folder, decimal), std::strtod(decimal.c_str(), nullptr)));
    }));
}

TEST_CASE_METHOD(in_folder, "a mesh round-trips through OFF bit for bit") {
    REQUIRE(rc::check("round trip", [&](const std::vector<std::array<std::uint64_t, 3>>& points, bool are_floats) {
        std::vector<aabb::vec3d> vertices;
        for (const auto& bits : points) {
            aabb::vec3d p{};
            for (std::size_t k = 0; k < 3; ++k) {
                const double value = are_floats ? std::bit_cast<float>(static_cast<std::uint32_t>(bits[k]))
                                                : std::bit_cast<double>(bits[k]);
                p[static_cast<int>(k)] = std::isfinite(value) ? value : 0;
            }
            vertices.push_back(p);
        }
        const double tenth = are_floats ? 0.1F : 0.1;
        vertices.insert(vertices.end(), {{-0.0, 1e-45F, 3.4028235e38F}, {0, 1, 2}, {tenth, tenth, 0.5}});
        const auto last = static_cast<std::uint32_t>(vertices.size() - 1);
        aabb::mesh m;
        m.triangles = {{0, last, last - 1}, {last, last - 2, 0}};
        set_vertices(m, vertices);
        RC_ASSERT(m.given.empty() == are_floats);
        aabblab::write_off(m, folder / "a.off");
        const aabb::mesh read = aabblab::read_mesh(folder / "a.off").mesh;
        RC_ASSERT(read.triangles == m.triangles);
        RC_ASSERT(read.vertices.size() == vertices.size());
        RC_ASSERT(read.frame == m.frame);
        for (const auto& triangle : m.triangles)
            for (const std::uint32_t v : triangle)
                for (int k = 0; k < 3; ++k) RC_ASSERT(same_bits(read.given_vertex(v)[k], vertices[v][k]));
    }));
    REQUIRE(folder.files() == 1);
}
