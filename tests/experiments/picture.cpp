#include <catch2/generators/catch_generators.hpp>

#include "program.hpp"

import aabblab.picture;

TEST_CASE("displacement is measured relative to the mean extent and the mean spacing") {
    aabblab::picture_data data(4, 3);
    const std::vector<std::uint8_t> all_present(4, 1);
    data.add_frame(std::vector<aabb::box>{cube(0, 0, 0), cube(7, 0, 0), cube(0, 7, 0), cube(7, 7, 0)}, all_present);
    REQUIRE_FALSE(data.displacement_over_extent());
    // The third object is absent, so its displacement does not count.
    data.add_frame(std::vector<aabb::box>{cube(1, 0, 0), cube(6, 0, 0), cube(99, 99, 99), cube(7, 6, 0)},
                   std::vector<std::uint8_t>{1, 1, 0, 1});
    REQUIRE(data.frames() == 2);
    REQUIRE(*data.displacement_over_extent() == 1);
    REQUIRE(data.sides() == aabb::vec3d{8, 8, 0});
    REQUIRE(*data.displacement_over_spacing() == 1 / 4.0);
    REQUIRE(aabblab::displacement_text(data) ==
            "mean displacement per frame: 1 of the mean extent, 0.25 of the mean spacing");
    REQUIRE(data.paths().size() == 4);
    REQUIRE_FALSE(data.paths()[2][1]);
    // It returns, which is no displacement either.
    data.add_frame(std::vector<aabb::box>{cube(1, 0, 0), cube(6, 0, 0), cube(0, 0, 0), cube(7, 6, 0)}, all_present);
    REQUIRE(*data.displacement_over_extent() == 0.5);
    REQUIRE(data.paths()[1][1].value() == aabb::vec3d{6.5, 0.5, 0.5});
}

TEST_CASE("a picture colours boxes by whether they overlap") {
    aabblab::picture_data data(5, 2);
    const std::vector<aabb::box> boxes = {cube(0, 0, 0), cube(0.5F, 0, 0), cube(5, 0, 5), cube(9, 0, 9), cube(9, 0, 9)};
    data.add_frame(boxes, std::vector<std::uint8_t>{1, 1, 1, 1, 0});
    data.add_frame(boxes, std::vector<std::uint8_t>{1, 0, 1, 1, 0});
    const std::string svg = aabblab::picture_of(data, {"a name", "a < b & c", "objects=5"});
    REQUIRE(svg.starts_with("<svg xmlns="));
    REQUIRE(svg.ends_with("</svg>\n"));
    for (const std::string part :
         {">a name<", ">a &lt; b &amp; c<", ">objects=5<", "5 objects, 2 frames",
          "first frame (0): boxes 4, overlapping pairs 1", "last frame (1): boxes 3, overlapping pairs 0",
          "seen along y: x across, z upwards<"})
        REQUIRE(holds(svg, part));
    const std::size_t last = svg.find("last frame");
    REQUIRE(count_of("class=\"overlapping\" x", svg.substr(0, last)) == 2 + 1);  // one in the legend
    REQUIRE(count_of("class=\"overlapping\" x", svg.substr(last)) == 0);
    REQUIRE(count_of("class=\"apart\" x", svg.substr(last)) == 3);
    // Every object that was ever present has a path in the last frame.
    REQUIRE(count_of("class=\"way\"", svg.substr(last)) == 4);
    REQUIRE(holds(svg, "paths of 5 objects"));
    REQUIRE_FALSE(holds(svg, "a sample"));
}

TEST_CASE("a picture of many boxes draws a sample that includes the largest") {
    aabblab::picture_data data(9003, 1);
    std::vector<aabb::box> boxes;
    for (int i = 0; i < 9000; ++i) boxes.push_back(cube(static_cast<float>(i % 100) * 3, 0, static_cast<float>(i)));
    for (int i = 0; i < 3; ++i) boxes.push_back({{-10, 0, 0}, {70, 60, 60}});
    data.add_frame(boxes, {});
    const std::string svg = aabblab::picture_of(data, {"many", "", ""});
    REQUIRE(holds(svg, "a sample of 4000 boxes is drawn, huge ones first"));
    const std::string first = svg.substr(0, svg.find("last frame"));
    REQUIRE(count_of("<rect class=\"apart\" x", first) + count_of("<rect class=\"overlapping\" x", first) ==
            4000 + 2);  // two in the legend
    // Each of the three huge boxes is outlined at its place.
    const std::string outline = first.substr(first.find("<rect class=\"huge\""));
    REQUIRE(count_of(outline.substr(0, outline.find('\n')), first) == 3);
    REQUIRE(holds(first, "longer than 5 mean extents"));
    REQUIRE(holds(first, "boxes 9003"));
}

TEST_CASE("a picture shows the most informative axes, with separate scales if one is much longer") {
    const auto [other, caption] = GENERATE(table<aabb::box, std::string>({
        {cube(9, 8, 7), "seen along y: x across, z upwards<"},
        {cube(8, 9, 1), "seen along z: x across, y upwards<"},
        {cube(9, 8, 2), "seen along y: x across, z upwards<"},
        {cube(50, 0, 0), "seen along z: x across, y upwards, each with a scale of its own<"},
        {cube(0, 0, 50), "seen along y: x across, z upwards, each with a scale of its own<"},
    }));
    aabblab::picture_data data(2, 1);
    data.add_frame(std::vector<aabb::box>{cube(0, 0, 0), other}, {});
    const std::string svg = aabblab::picture_of(data, {"two", "", ""});
    REQUIRE_THAT(svg, Catch::Matchers::ContainsSubstring(caption));
}

TEST_CASE("a picture of a box far from the origin has few ticks") {
    aabblab::picture_data data(1, 1);
    data.add_frame(std::vector<aabb::box>{{{1e30F, 0, 1e30F}, {1e30F, 0, 1e30F}}}, {});
    REQUIRE(count_of("class=\"tick\"", aabblab::picture_of(data, {"far", "", ""})) < 100);
}

TEST_CASE_METHOD(in_folder, "scene draws every kind without writing a recording") {
    const std::string kind =
        GENERATE("brownian", "clustered", "far", "flat", "free_fall", "hollow_sphere", "lattice", "line", "mixed_sizes",
                 "needles", "one_huge", "pile", "population", "still", "teleport", "mesh_swarm");
    const std::string objects = GENERATE("0", "1", "30");
    CAPTURE(kind, objects);
    const std::string file = folder / "scene.svg";
    const auto result = run_well({"scene", kind, "--n", objects, "--frames", "2", "--seed", "9", "--picture", file});
    REQUIRE(folder.files() == 1);
    REQUIRE(holds(result.out,
                  "wrote " + file + ": " + objects + (objects == "1" ? " object" : " objects") + ", 3 frames\n"));
    REQUIRE(holds(result.out, "mean displacement per frame: "));
    const std::string svg = bytes_of_file(file);
    for (const std::string& part : {">" + kind + "<", "objects=" + objects + " frames=2", std::string(" seed=9<")})
        REQUIRE(holds(svg, part));
    REQUIRE_FALSE(holds(svg, "nan"));
    REQUIRE_FALSE(holds(svg, "inf<"));
    REQUIRE(holds(svg, "first frame (0): boxes " + (kind == "population" && objects == "30" ? "15" : objects) + ","));
}

TEST_CASE_METHOD(in_folder, "a frame without objects is drawn") {
    run_well(
        {"scene", "population", "--n", "1", "--frames", "1", "--turnover", "1", "--picture", folder / "empty.svg"});
    REQUIRE(folder.files() == 1);
}

TEST_CASE_METHOD(in_folder, "scene writes the same recording with and without a picture") {
    const std::string alone = folder / "alone.aabbs";
    const std::string both = folder / "both.aabbs";
    run_well({"scene", "flat", "--n", "40", "--out", alone});
    const auto result = run_well({"scene", "flat", "--n", "40", "--out", both, "--picture", folder / "both.svg"});
    REQUIRE(holds(result.out, "both.aabbs: 40 objects, 21 frames"));
    REQUIRE(holds(result.out, "both.svg: 40 objects, 21 frames"));
    REQUIRE(bytes_of_file(alone) == bytes_of_file(both));
    REQUIRE(holds(bytes_of_file(folder / "both.svg"), "</svg>"));
}

TEST_CASE_METHOD(in_folder, "scene reports the requested displacement") {
    const std::string out = folder / "scene.aabbs";
    const auto output_in = [&](const std::string& unit) {
        return run_program({"scene", "line", "--displacement", "0.25", "--unit", unit, "--out", out}).out;
    };
    REQUIRE(holds(output_in("extent"), "mean displacement per frame: 0.25 of the mean extent, "));
    REQUIRE(holds(output_in("spacing"), " of the mean extent, 0.25 of the mean spacing\n"));
    REQUIRE(holds(run_program({"scene", "line", "--frames", "0", "--out", out}).out,
                  "mean displacement per frame: - of the mean extent, - of the mean spacing\n"));
}

TEST_CASE_METHOD(in_folder, "scene rejects pictures that it cannot write and leaves no file behind") {
    std::filesystem::create_directory(folder / "sub");
    const std::string file = folder / "scene.aabbs";
    const std::string same = folder / "sub" / ".." / "scene.aabbs";
    const std::string nowhere = folder / "missing" / "scene.svg";
    const auto rejected = [&](const std::vector<std::string>& outputs, const std::string& message) {
        check_refused({"scene", "brownian"}, {{outputs, message}});
        REQUIRE(folder.files() == 1);
    };
    rejected({}, "expected --out, --motion or --picture");
    rejected({"--out", file, "--picture", file}, "--out and --picture are the same file");
    rejected({"--out", file, "--picture", same}, "--out and --picture are the same file");
    rejected({"--out", file, "--picture", nowhere}, "scene.svg: cannot be written");
    rejected({"--picture", folder / "sub"}, "it is a folder");
    rejected({"--out", folder / "x.csv"},
             "--out must end in .aabbs, not '" + (folder / "x.csv").string() +
                 "': it writes a recording; aabblab pairs writes the pairs of a recording as CSV");
    rejected({"--picture", folder / "x.png"}, "--picture must end in .svg");
}
