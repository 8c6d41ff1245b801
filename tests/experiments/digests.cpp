// FORMATS.md defines the input of each digest; these tests recompute them from the rows of the files.

#include "program_json.hpp"

#include "csv_rows.hpp"

namespace {

using rows = std::vector<std::vector<std::uint32_t>>;

std::string digest_of(const rows& table) {
    aabb::digest digest;
    for (const std::vector<std::uint32_t>& row : table) digest.add(row);
    return digest.text();
}

/// The pairs of triangles that `collide` writes, as rows of frame 0.
rows in_frame_0(const rows& pairs) {
    rows contacts;
    for (const std::vector<std::uint32_t>& row : pairs) contacts.push_back({0, row.at(0), row.at(1)});
    return contacts;
}

/// Runs a command with --json and --out.
struct outcome {
    outcome(const temporary_folder& folder, std::vector<std::string> arguments) {
        const std::string out = folder / "out.csv";
        digest = json_of(joined(std::move(arguments), {"--json", "--out", out}))["digest"];
        written = numbers_of(bytes_of_file(out));
        REQUIRE(written.size() > 3);
    }

    std::string digest;
    rows written;
};

/// The column `digest` of `run`, the same in every row.
std::string digest_of_run(const temporary_folder& folder, const std::string& scene) {
    const std::string config = folder.write("digests.toml", "name = \"digests\"\nseed = 7\n[[scene]]\n" + scene +
                                                                "[measure]\nrepeats = 1\nmetrics = [\"counts\"]\n");
    run_well({"run", config, "--out", folder / "results"});
    return aabblab::read_rows(folder / "results" / "results.csv").at(0).digest;
}

}  // namespace

TEST_CASE_METHOD(in_folder, "pairs and run on boxes hash the rows frame,a,b") {
    const std::string scene = folder / "scene.aabbs";
    run_well({"scene", "brownian", "--n", "80", "--frames", "3", "--seed", "7", "--density", "1", "--out", scene});
    const outcome pairs(folder, {"pairs", scene});
    CHECK(pairs.digest == digest_of(pairs.written));
    CHECK(digest_of_run(folder, "kind = \"brownian\"\nobjects = 80\nframes = 3\ndensity = 1\n") == pairs.digest);
}

TEST_CASE_METHOD(in_folder, "collide hashes 0,a,b for each row, with --self=all too") {
    const std::string knot = "torus_knot:triangles=600";
    const outcome both(folder, {"collide", knot, "icosphere:triangles=320"});
    CHECK(both.digest == digest_of(in_frame_0(both.written)));
    const outcome self(folder, {"collide", knot, "--self=all"});
    CHECK(self.written[0].size() == 3);
    CHECK(self.digest == digest_of(in_frame_0(self.written)));
}

TEST_CASE_METHOD(in_folder, "contacts and run on meshes hash the rows frame,object_a,object_b,triangle_a,triangle_b") {
    const std::string motion = folder / "swarm.txt";
    run_well({"scene", "mesh_swarm", "--n", "8", "--frames", "3", "--density", "3", "--seed", "7", "--mesh",
              "icosphere:triangles=80", "--normalise", "no", "--motion", motion});
    const outcome contacts(folder, {"contacts", motion, "icosphere:triangles=80"});
    CHECK(contacts.digest == digest_of(contacts.written));
    CHECK(digest_of_run(folder,
                        "kind = \"mesh_swarm\"\nobjects = 8\nframes = 3\ndensity = 3\nnormalise = \"no\"\n"
                        "meshes = [\"icosphere:triangles=80\"]\n") == contacts.digest);
}
