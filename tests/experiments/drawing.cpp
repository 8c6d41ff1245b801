#include <set>
#include <sstream>

#include "program_json.hpp"

#include "csv_rows.hpp"
#include "mesh_bytes.hpp"

import aabblab.files;

// Drawings are read by the program's own readers, and by parsers here that know nothing of how they are written.

namespace {

using point = std::array<double, 3>;
using colour = std::array<int, 3>;
constexpr colour red{220, 40, 40}, black{0, 0, 0};

struct parsed_drawing {
    std::vector<point> vertices;
    std::vector<colour> colours;
    std::vector<std::array<std::size_t, 3>> faces;
    std::vector<std::array<std::size_t, 2>> edges;
    std::vector<std::size_t> points;  ///< of OBJ

    /// Whether all corners of a face are red.
    [[nodiscard]] bool is_red(std::size_t face) const {
        return std::ranges::all_of(faces[face], [&](std::size_t v) { return colours[v] == red; });
    }
    [[nodiscard]] std::vector<std::size_t> red_faces() const {
        std::vector<std::size_t> result;
        for (std::size_t face = 0; face < faces.size(); ++face)
            if (is_red(face)) result.push_back(face);
        return result;
    }
    /// The black vertices, which are those of the curve.
    [[nodiscard]] std::set<point> curve() const {
        std::set<point> result;
        for (std::size_t v = 0; v < vertices.size(); ++v)
            if (colours[v] == black) result.insert(vertices[v]);
        return result;
    }
};

/// Reads text PLY by its header, element by element and property by property (Turk, "The PLY polygon file format").
parsed_drawing parse_ply(const std::string& text) {
    std::istringstream in(text);
    std::string line;
    REQUIRE((std::getline(in, line) && line == "ply"));
    REQUIRE((std::getline(in, line) && line == "format ascii 1.0"));
    struct element {
        std::string name;
        std::size_t count;
        std::vector<std::string> properties;  ///< the words after "property"
    };
    std::vector<element> elements;
    while (std::getline(in, line) && line != "end_header") {
        std::istringstream words(line);
        std::string word;
        words >> word;
        if (word == "element") {
            element& e = elements.emplace_back();
            words >> e.name >> e.count;
        } else if (word == "property") {
            REQUIRE(!elements.empty());
            elements.back().properties.push_back(line.substr(9));
        } else {
            REQUIRE(word == "comment");
        }
    }
    REQUIRE(line == "end_header");
    parsed_drawing drawing;
    for (const element& e : elements)
        for (std::size_t i = 0; i < e.count; ++i) {
            REQUIRE(std::getline(in, line));
            std::istringstream words(line);
            std::map<std::string, double> values;
            std::vector<std::size_t> list;
            for (const std::string& property : e.properties) {
                const std::string name = property.substr(property.rfind(' ') + 1);
                if (property.starts_with("list ")) {
                    std::size_t size = 0;
                    REQUIRE(words >> size);
                    for (std::size_t k = 0; k < size; ++k) {
                        std::size_t value = 0;
                        REQUIRE(words >> value);
                        list.push_back(value);
                    }
                } else {
                    std::string value;  // a stream would not round to the nearest double everywhere
                    REQUIRE(words >> value);
                    values[name] = std::strtod(value.c_str(), nullptr);
                }
            }
            std::string rest;
            REQUIRE_FALSE(words >> rest);
            if (e.name == "vertex") {
                drawing.vertices.push_back({values.at("x"), values.at("y"), values.at("z")});
                drawing.colours.push_back({static_cast<int>(values.at("red")), static_cast<int>(values.at("green")),
                                           static_cast<int>(values.at("blue"))});
            } else if (e.name == "face") {
                REQUIRE(list.size() == 3);
                for (const std::size_t v : list) REQUIRE(v < drawing.vertices.size());
                drawing.faces.push_back({list[0], list[1], list[2]});
            } else {
                REQUIRE(e.name == "edge");
                drawing.edges.push_back(
                    {static_cast<std::size_t>(values.at("vertex1")), static_cast<std::size_t>(values.at("vertex2"))});
                for (const std::size_t v : drawing.edges.back()) REQUIRE(v < drawing.vertices.size());
            }
        }
    REQUIRE_FALSE(std::getline(in, line));
    return drawing;
}

/// Reads OBJ with colours after coordinates; of points, checks that they exist.
parsed_drawing parse_obj(const std::string& text) {
    parsed_drawing drawing;
    for (const std::string& line : lines_of(text)) {
        std::istringstream words(line);
        std::string statement;
        words >> statement;
        if (statement == "#") continue;
        std::vector<double> numbers;
        for (std::string word; words >> word;) numbers.push_back(std::strtod(word.c_str(), nullptr));
        const auto index = [&](std::size_t i) {
            REQUIRE(numbers.at(i) >= 1);
            REQUIRE(numbers.at(i) <= static_cast<double>(drawing.vertices.size()));
            return static_cast<std::size_t>(numbers[i]) - 1;
        };
        if (statement == "v") {
            REQUIRE(numbers.size() == 6);
            drawing.vertices.push_back({numbers[0], numbers[1], numbers[2]});
            colour& painted = drawing.colours.emplace_back();
            for (std::size_t k = 0; k < 3; ++k) painted[k] = static_cast<int>(std::lround(255 * numbers[3 + k]));
        } else if (statement == "f") {
            REQUIRE(numbers.size() == 3);
            drawing.faces.push_back({index(0), index(1), index(2)});
        } else if (statement == "l") {
            REQUIRE(numbers.size() == 2);
            drawing.edges.push_back({index(0), index(1)});
        } else {
            REQUIRE(statement == "p");
            REQUIRE(drawing.colours[index(0)] == black);
            drawing.points.push_back(index(0));
        }
    }
    return drawing;
}

/// The positions of a face's corners.
std::array<point, 3> corners_of(const parsed_drawing& drawing, std::size_t face) {
    const auto& [p, q, r] = drawing.faces[face];
    return {drawing.vertices[p], drawing.vertices[q], drawing.vertices[r]};
}

/// Two tetrahedra, of which the second is moved by (1/4, 1/4, 0): they pass through each other, touch and overlap.
struct two_tetrahedra : in_folder {
    std::string mesh = folder.write("t.off", tetrahedron);
    std::string pose = "1,0,0,0.25, 0,1,0,0.25, 0,0,1,0";
};

/// What the rows of `--out --geometry` say.
struct written_hits {
    std::set<std::size_t> of_a, of_b;  ///< triangles
    std::set<point> corners;           ///< of the intersections
    std::size_t lines = 0;             ///< between them
};
/// @param first the number of columns before the two triangles
written_hits hits_in(const std::string& rows, std::size_t first = 0) {
    written_hits hits;
    const std::vector<std::string> lines = lines_of(rows);
    for (std::size_t row = 1; row < lines.size(); ++row) {
        std::vector<std::string> cells;
        std::istringstream in(lines[row]);
        for (std::string cell; std::getline(in, cell, ',');) cells.push_back(cell);
        hits.of_a.insert(std::stoul(cells.at(first)));
        hits.of_b.insert(std::stoul(cells.at(first + 1)));
        const std::size_t size = std::stoul(cells.at(first + 3));  // after the kind
        hits.lines += size == 1 ? 0 : size == 2 ? 1 : size;
        for (std::size_t corner = 0; corner < size; ++corner) {
            point p{};
            for (std::size_t k = 0; k < 3; ++k)
                p[k] = std::strtod(cells.at(first + 7 + 3 * corner + k).c_str(), nullptr);
            hits.corners.insert(p);
        }
    }
    return hits;
}

/// Checks a drawing of two tetrahedra, the second moved as in `two_tetrahedra`.
void check_drawing(const parsed_drawing& drawing, const written_hits& hits, const aabb::mesh& mesh) {
    const std::size_t triangles = mesh.triangles.size();
    REQUIRE(drawing.faces.size() == 2 * triangles);
    for (std::size_t face = 0; face < drawing.faces.size(); ++face) {
        const auto triangle = static_cast<std::uint32_t>(face % triangles);
        const double shift = face < triangles ? 0 : 0.25;
        const auto corners = corners_of(drawing, face);
        for (int i = 0; i < 3; ++i) {
            const aabb::vec3d v = mesh.given_triangle(triangle)[i];
            CHECK(corners[static_cast<std::size_t>(i)] == point{v[0] + shift, v[1] + shift, v[2]});
        }
        CHECK(drawing.is_red(face) == (face < triangles ? hits.of_a : hits.of_b).contains(triangle));
    }
    CHECK(drawing.curve() == hits.corners);
    CHECK(drawing.edges.size() == hits.lines);
    for (const auto& [p, q] : drawing.edges) {
        CHECK(drawing.colours[p] == black);
        CHECK(drawing.colours[q] == black);
        CHECK(p != q);
    }
}

}  // namespace

TEST_CASE_METHOD(two_tetrahedra, "collide --draw writes both meshes, red where they intersect, and the curve") {
    const std::vector<std::string> base{"collide", mesh,         mesh,    "--pose-b",
                                        pose,      "--geometry", "--out", folder / "h.csv"};
    run_well(joined(base, {"--draw", folder / "d.ply"}));
    const written_hits hits = hits_in(bytes_of_file(folder / "h.csv"));
    CHECK(hits.of_a.size() > 1);
    CHECK(hits.of_a.size() < 4);
    CHECK(hits.lines > 3);
    const parsed_drawing ply = parse_ply(bytes_of_file(folder / "d.ply"));
    const aabb::mesh given = aabblab::read_mesh(mesh).mesh;
    check_drawing(ply, hits, given);
    run_well(joined(base, {"--draw", folder / "d.obj"}));
    const parsed_drawing obj = parse_obj(bytes_of_file(folder / "d.obj"));
    check_drawing(obj, hits, given);
    CHECK(obj.vertices == ply.vertices);
    CHECK(obj.colours == ply.colours);
    CHECK(obj.faces == ply.faces);
    CHECK(obj.edges == ply.edges);
    // The program's own readers.
    for (const char* file : {"d.ply", "d.obj"}) {
        const aabb::mesh read = aabblab::read_mesh(folder / file).mesh;
        REQUIRE(read.triangles.size() == ply.faces.size());
        for (std::uint32_t t = 0; t < read.triangles.size(); ++t)
            for (int i = 0; i < 3; ++i) {
                const aabb::vec3d v = read.given_triangle(t)[i];
                CHECK(point{v[0], v[1], v[2]} == corners_of(ply, t)[static_cast<std::size_t>(i)]);
            }
    }
    // One pair of --first.
    run_well({"collide", mesh, mesh, "--pose-b", pose, "--first", "--draw", folder / "d.ply"});
    CHECK(parse_ply(bytes_of_file(folder / "d.ply")).red_faces().size() == 2);
    // Without hits, nothing is red, and there are no lines.
    run_well({"collide", mesh, mesh, "--pose-b", "1,0,0,9, 0,1,0,0, 0,0,1,0", "--draw", folder / "d.ply"});
    const parsed_drawing apart = parse_ply(bytes_of_file(folder / "d.ply"));
    CHECK(apart.faces.size() == 8);
    CHECK(apart.vertices.size() == 8);
    CHECK(apart.red_faces().empty());
    CHECK(apart.edges.empty());
}

TEST_CASE_METHOD(two_tetrahedra, "collide --draw moves meshes far from the origin to it, and says where they were") {
    const std::vector<std::string> at_origin{"collide", mesh, mesh, "--pose-b", pose};
    const std::vector<std::string> far_off{"collide",
                                           mesh,
                                           mesh,
                                           "--pose-a",
                                           "1,0,0,500000,0,1,0,-5000000,0,0,1,0",
                                           "--pose-b",
                                           "1,0,0,500000.25,0,1,0,-4999999.75,0,0,1,0"};
    run_well(joined(at_origin, {"--draw", folder / "near.ply"}));
    const program_result result = run_well(joined(far_off, {"--draw", folder / "far.ply"}));
    const parsed_drawing near = parse_ply(bytes_of_file(folder / "near.ply"));
    const std::string text = bytes_of_file(folder / "far.ply");
    const parsed_drawing far = parse_ply(text);
    const std::string origin = "relative to 500000.625 -4999999.375 0\n";
    CHECK(holds(text, "\ncomment " + origin));
    CHECK(holds(result.err, "far.ply has coordinates " + origin));
    CHECK(far.faces == near.faces);
    CHECK(far.red_faces() == near.red_faces());
    CHECK(far.edges == near.edges);
    REQUIRE(far.vertices.size() == near.vertices.size());
    for (std::size_t v = 0; v < near.vertices.size(); ++v) {
        const point expected{near.vertices[v][0] - 0.625, near.vertices[v][1] - 0.625, near.vertices[v][2]};
        for (std::size_t k = 0; k < 3; ++k) CHECK(std::abs(far.vertices[v][k] - expected[k]) < 1e-9);
    }
    run_well(joined(far_off, {"--draw", folder / "far.obj"}));
    CHECK(bytes_of_file(folder / "far.obj").starts_with("# " + origin));
    CHECK(parse_obj(bytes_of_file(folder / "far.obj")).vertices == far.vertices);
    // Not where they lie beside the origin.
    CHECK(!holds(bytes_of_file(folder / "near.ply"), "relative"));
}

TEST_CASE_METHOD(two_tetrahedra, "collide --draw shows as points what is too short to have two ends in double") {
    const std::string far = ",0,1,0,1e16,0,0,1,1e16";
    run_well({"collide", mesh, mesh, "--pose-a", "1,0,0,1e16" + far, "--pose-b",
              "0.5,0,0,1e16,0,0.5,0,1e16,0,0,0.5,1e16", "--draw", folder / "d.obj"});
    const parsed_drawing drawing = parse_obj(bytes_of_file(folder / "d.obj"));
    CHECK(!drawing.points.empty());
    CHECK(!drawing.red_faces().empty());
    for (const auto& [p, q] : drawing.edges) CHECK(drawing.vertices[p] != drawing.vertices[q]);
}

TEST_CASE_METHOD(two_tetrahedra, "collide --draw leaves out what --touching=no does, and draws one mesh with --self") {
    run_well({"collide", mesh, mesh, "--pose-b", "1,0,0,1, 0,1,0,0, 0,0,1,0", "--draw", folder / "d.obj"});
    const parsed_drawing touching = parse_obj(bytes_of_file(folder / "d.obj"));
    CHECK(touching.red_faces().size() > 1);
    CHECK(touching.curve() == std::set<point>{{1, 0, 0}});
    CHECK(touching.edges.empty());
    run_well(
        {"collide", mesh, mesh, "--pose-b", "1,0,0,1, 0,1,0,0, 0,0,1,0", "--touching=no", "--draw", folder / "d.obj"});
    CHECK(parse_obj(bytes_of_file(folder / "d.obj")).red_faces().empty());
    const std::string bow_tie =
        folder.write("b.off", "OFF\n6 3 0\n0 0 0\n6 0 0\n6 3 0\n4 1 -2\n4 1 2\n9 9 9\n3 0 1 2\n3 0 3 4\n3 1 2 5\n");
    run_well({"collide", bow_tie, "--self", "--draw", folder / "d.ply"});
    const parsed_drawing self = parse_ply(bytes_of_file(folder / "d.ply"));
    CHECK(self.faces.size() == 3);
    CHECK(self.red_faces() == std::vector<std::size_t>{0, 1});
    CHECK(self.curve() == std::set<point>{{0, 0, 0}, {4, 1, 0}});
    CHECK(self.edges.size() == 1);
}

TEST_CASE_METHOD(two_tetrahedra, "contacts --draw shows the objects of one frame") {
    const std::string motion = folder.write("m.txt",
                                            "0 0 1 0 0 0 0 1 0 0 0 0 1 0\n0 1 1 0 0 9 0 1 0 0 0 0 1 0\n"
                                            "0 2 1 0 0 90 0 1 0 0 0 0 1 0\n1 1 1 0 0 0.25 0 1 0 0.25 0 0 1 0\n"
                                            "3 1 1 0 0 9 0 1 0 0 0 0 1 0\n");
    run_well({"collide", mesh, mesh, "--pose-b", pose, "--draw", folder / "pair.ply"});
    const parsed_drawing pair = parse_ply(bytes_of_file(folder / "pair.ply"));
    for (const char* frame : {"1", "2"}) {
        run_well({"contacts", motion, mesh, "--draw", folder / "d.ply", "--frame", frame});
        const parsed_drawing drawing = parse_ply(bytes_of_file(folder / "d.ply"));
        REQUIRE(drawing.faces.size() == 12);
        CHECK(drawing.red_faces() == pair.red_faces());
        CHECK(drawing.curve() == pair.curve());
        CHECK(drawing.edges.size() == pair.edges.size());
        CHECK(corners_of(drawing, 5) == corners_of(pair, 5));
        CHECK(corners_of(drawing, 8)[0][0] == 90);
    }
    for (const std::vector<std::string>& frame : {std::vector<std::string>{}, {"--frame", "3"}}) {
        run_well(joined({"contacts", motion, mesh, "--draw", folder / "d.ply"}, frame));
        CHECK(parse_ply(bytes_of_file(folder / "d.ply")).red_faces().empty());
    }
    check_refused({"contacts", motion, mesh},
                  {{{"--frame", "1"}, "--frame is the frame that --draw shows, so give --draw FILE"},
                   {{"--draw", folder / "d.ply", "--frame", "4"}, "a whole number from 0 to 3"},
                   {{"--draw", folder / "d.ply", "--frame", "x"}, "a whole number from 0 to 3"},
                   {{"--draw", motion}, "would overwrite"},
                   {{"--draw", folder / "d.ply", "--out", folder / "d.ply"}, "--draw"}});
}

TEST_CASE_METHOD(two_tetrahedra, "collide --draw rejects what it cannot draw") {
    check_refused({"collide", mesh, mesh},
                  {{{"--draw", folder / "d.off"}, "--draw writes PLY or OBJ, so its file must end in .ply or .obj"},
                   {{"--draw", folder / "d.ply", "--count"}, "--count stores no pairs, so --draw has nothing to show"},
                   {{"--draw", folder / "d.ply", "--poses", mesh}, "--draw shows one pose of B"},
                   {{"--draw", folder / "none/d.ply"}, "cannot be written"},
                   {{"--draw", folder / "d.ply", "--out", folder / "d.ply"}, "--draw"}});
    CHECK(!std::filesystem::exists(folder / "d.ply"));
    const std::string ply = folder / "kept.ply";
    run_well({"collide", mesh, mesh, "--draw", ply});
    check_refused({"collide", ply, mesh}, {{{"--draw", ply}, "kept.ply"}});
}
