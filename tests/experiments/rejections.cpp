#include "mesh_bytes.hpp"

namespace {

/// Checks that each is rejected and leaves no file behind.
void check_all(const temporary_folder& folder, const std::vector<std::string>& before, const refusals& rejections) {
    const std::size_t files = folder.files();
    for (const auto& rejection : rejections) {
        CAPTURE(rejection.first);
        check_refused(before, {rejection});
        CHECK(folder.files() == files);
    }
}

}  // namespace

TEST_CASE("An invalid command line is rejected in one sentence with status 2") {
    check_all(
        temporary_folder(), {},
        {
            {{}, "expected a command"},
            {{"pairz", "x"}, "unknown command 'pairz'; did you mean 'pairs'?"},
            {{"dta"}, "did you mean 'data'?"},
            {{"data"}, "command of the script"},
            {{"benchmark"}, "command of the script"},
            {{"--verson"}, "did you mean '--version'?"},
            {{"pairs"}, "pairs: SCENE is required"},
            {{"pairs", "--sotr", "std"}, "pairs: unknown option '--sotr'; did you mean '--sort'?"},
            {{"pairs", "x", "--sotr=std"}, "pairs: unknown option '--sotr'; did you mean '--sort'?"},
            {{"pairs", "x", "y"}, "pairs: unexpected argument 'y'"},
            {{"pairs", "x", "--out"}, "pairs: --out takes one value"},
            {{"pairs", "x", "--sort", "std", "--sort", "std"}, "pairs: --sort takes one value"},
            {{"scene", "still", "--n", "5", "--n", "6"}, "scene: --n takes one value"},
            {{"collide", "icosphere"}, "collide: expected B, the other mesh, or --self"},
            {{"scene", "brownian"}, "scene: expected --out, --motion or --picture"},
            {{"list", "--jsn"}, "did you mean '--json'?"},
            {{"list", "sorts"}, "list: unknown kind 'sorts'; did you mean 'sort'?\n"},
            {{"list", "nothing"}, "list: unknown kind 'nothing'; see aabblab list --help\n"},
            {{"nothing_at_all"}, "unknown command 'nothing_at_all'; see aabblab --help\n"},
            {{"scene", "brownian", "--xyzzyq", "3"}, "scene: unknown option '--xyzzyq'; see aabblab scene --help\n"},
            {{"validate", "stiff", "a", "--xyzzyq"}, "'--xyzzyq'; expected one of --help, --out, --methods, --quick\n"},
            {{"validate", "stiff", "stak"}, "unknown study 'stak'; did you mean 'stack'?"},
            {{"scene", "xyzzyq", "--out", "a.aabbs"}, "unknown scene 'xyzzyq'; see aabblab list scenes\n"},
            {{"pairs", "x", "--engine", "xyzzyq"}, "unknown engine 'xyzzyq'; see aabblab list engines\n"},
            {{"list", "--threads"}, "list: unknown option '--threads'; expected one of --help, --json\n"},
            {{"pairs", "x", "--threads", "2"}, "a parameter of a strategy, as in --partition columns:threads=…\n"},
            {{"pairs", "x", "--partition", "bucket"}, "'bucket' is of the kind sort, not partition\n"},
        });
}

TEST_CASE_METHOD(in_folder, "pairs and scene reject invalid options and leave no file behind") {
    const std::string scene = folder / "scene.aabbs";
    run_well({"scene", "brownian", "--n", "60", "--frames", "3", "--out", scene});
    check_all(
        folder, {"pairs", scene, "--out", folder / "pairs.csv"},
        {
            {{"--sort", "insertoin"}, "did you mean 'insertion'?"},
            {{"--sort", "std:gaps=1"}, "takes no parameters"},
            {{"--partition", "uniform_grid:cell_size"}, "name=value"},
            {{"--engine", "brute_farce"}, "did you mean 'brute_force'?"},
            {{"--engine", "brute_force", "--sweep", "one_axis"},
             "--engine replaces --prepare, --sort, --partition and --sweep, so give it alone\n"},
            {{"--sort", "auto"}, "--sort auto: omit the option to have one selected"},
            {{"--split-large", "2"}, "'split_large' is a strategy; write --prepare split_large"},
            {{"--prepare", "split_large:size=0"}, "split_large: size must be a number above 0, not '0'"},
            {{"--prepare", "split_mesh"}, "split_mesh divides meshes, but the scene has only boxes"},
            {{"--sort", "std", "--sweep", "incremental"}, "combined with insertion only"},
            {{"--sort", "insertion", "--partition", "axial_cut", "--sweep", "incremental"}, "combined with none only"},
            {{"--partition", "axial_cut:axes=4"}, "axes must be a whole number from 1 to 3 or auto, not '4'"},
            {{"--partition", "axial_cut:segments=0"}, "segments must be a whole number from 1 to 65535 or auto"},
        });
    check_all(folder, {"scene", "--out", folder / "s.aabbs"},
              {
                  {{"browniann"}, "did you mean 'brownian'?"},
                  {{"brownian", "--seed", "-1"}, "--seed must be a whole number from 0 to 18446744073709551615"},
                  {{"brownian", "--n", "many"}, "objects must be"},
                  {{"brownian", "--n", ""}, "objects must be"},
                  {{"brownian", "--mesh", "icosphere"}, "no meshes"},
                  {{"mesh_swarm", "--mesh", "icospher"}, "did you mean 'icosphere'"},
                  {{"mesh_pair", "--motion", folder / "s.aabbs"}, "--out and --motion are the same file"},
              });
}

TEST_CASE_METHOD(with_mesh_file, "collide rejects invalid options and leaves no file behind") {
    check_all(
        folder, {"collide", mesh},
        {
            {{}, "collide: expected B, the other mesh, or --self"},
            {{mesh, "--self"}, "--self takes one mesh, so give no second one"},
            {{"--self=no_adjacent"}, "did you mean 'no-adjacent'?"},
            {{"--self", "--pose-a", "1,0,0,0,0,1,0,0,0,0,1,0"}, "which no pose changes"},
            {{"--self", "--poses", "poses.txt"}, "which no pose changes"},
            {{"--self=all", "--first"}, "--first works with plain --self only"},
            {{mesh, "--first", "--count"}, "--first and --count exclude each other"},
            {{mesh, "--count", "--out", folder / "x.csv"}, "--count stores no pairs"},
            {{mesh, "--geometry"}, "--geometry adds columns to the pairs, so give --out FILE, or --first for one pair"},
            {{mesh, "--geometry", "--count"}, "--count stores no pairs, so --geometry cannot be combined with it"},
            {{mesh, "--touching=maybe"}, "--touching is yes or no, not 'maybe'"},
            {{"--self=all", "--touching=no"}, "--self=all is about triangles that touch"},
        });
    check_all(
        folder, {"collide", mesh, mesh, "--out", folder / "pairs.csv"},
        {
            {{"--pose-a", "1,0,0"}, "--pose-a: a pose is 12 numbers"},
            {{"--pose-a", "1,0,0,0,0,1,0,0,0,0,1,0,"}, "--pose-a: a number is missing after the last comma"},
            {{"--pose-b", "1,0,0,x,0,1,0,0,0,0,1,0"}, "--pose-b: number 4 of 12: 'x' is not a number"},
            {{"--pose-b", "1,0,0,0,0,1,0,0,0,0,1,nan"}, "number 12 of 12: 'nan' is not finite"},
            {{"--pose-b", "1,0,0,1e39,0,1,0,0,0,0,1,0"}, "a.off: seen from one mesh, the other lies beyond"},
            {{"--pose-b", "0,0,0,0,0,1,0,0,0,0,1,0"}, "--pose-b: the pose is singular"},
            {{"--pose-b", "1,0,0,0,0,1,0,0,0,0,1,0", "--poses", "p.txt"},
             "--pose-b and --poses both set the pose of B"},
            {{"--poses", "nowhere.txt"}, "nowhere.txt"},
            {{"--repeat", "0"}, "--repeat is the number of searches: a whole number from 1 to 1,000,000, not '0'"},
            {{"--repeat", "-3"}, "a whole number from 1 to 1,000,000, not '-3'"},
            {{"--repeat", "99999999999999999999999"}, "from 1 to 1,000,000, not '99999999999999999999999'"},
            {{"--repeat", "1000001"}, "not '1000001'"},
            {{"--repeat", "1.5"}, "not '1.5'"},
            {{"--repeat", "x"}, "not 'x'"},
            {{"--tree", "canonicl"}, "did you mean 'canonical'?"},
            {{"--engine", "cgl"}, "did you mean 'cgal'?"},
            {{"--engine", "cgal", "--tree", "canonical"}, "--engine replaces --build, --tree and --triangle"},
        });
}

TEST_CASE_METHOD(with_mesh_file, "an invalid line of a file of poses is reported") {
    const std::string poses = folder.write("poses.txt", "");
    const std::vector<std::pair<std::string, std::string>> texts = {
        {"# nothing\n\n", "poses.txt: has no poses"},
        {"# 1\n1,0,0,0,0,1,0,0,0,0,1,0\n1,0,0,x,0,1,0,0,0,0,1,0\n", "poses.txt:3: number 4 of 12: 'x' is not a number"},
        {"0 0 1 0 0\n", "poses.txt:1: a pose is 12 numbers, the rows of [R t] with commas between, not 5"},
        {"0,0,0,0,0,1,0,0,0,0,1,0", "poses.txt:1: the pose is singular"},
        {"1,0,0,0,0,1,0,0,0,0,1,0\n\n1,0,0,1e39,0,1,0,0,0,0,1,0", "poses.txt:3: "},
        {"1,0,0,1e39,0,1,0,0,0,0,1,0", "a.off: seen from one mesh, the other lies beyond the range of float"},
    };
    for (const auto& [text, message] : texts) {
        folder.write("poses.txt", text);
        check_all(folder, {"collide", mesh, mesh, "--poses", poses, "--out", folder / "pairs.csv"}, {{{}, message}});
    }
}

TEST_CASE_METHOD(with_mesh_file, "contacts rejects an invalid motion with file and line and leaves no file behind") {
    const std::string motion = folder.write("m.txt", "");
    const std::string pose = "0 0 1 0 0 0 0 1 0 0 0 0 1 0\n";
    const std::vector<std::pair<std::string, std::string>> texts = {
        {"", ": is empty"},
        {"# nothing\n", ": ends before the first pose"},
        {"a 0\n", ":1: the header lacks a column of frame, object, and r00 to r22"},
        {pose + "a 0 1 0 0 0 0 1 0 0 0 0 1 0\n", ":2: expected the number of a frame, found 'a'"},
        {"0 b 1 0 0 0 0 1 0 0 0 0 1 0\n", ":1: expected the number of an object, found 'b'"},
        {"0\n", ":1: expected frame and object, then twelve numbers"},
        {"0 0 1 0 0 0 0 1 0 0 0 0 1\n", ":1: expected frame and object, then twelve numbers"},
        {pose + "1 0 1 0 0 0 0 1 0 0 0 0 1\n", ":2: expected 14 columns, found 13"},
        {"0 0 1 0 0 x 0 1 0 0 0 0 1 0\n", ":1: expected a number of a pose, found 'x'"},
        {"0 0 1 0 0 nan 0 1 0 0 0 0 1 0\n", ":1: 'nan' is not a finite number"},
        {"0 0 1 0 0 1e999 0 1 0 0 0 0 1 0\n", ":1: '1e999' is not a finite number"},
        {"0 0 0 0 0 0 0 1 0 0 0 0 1 0\n", ":1: the pose is singular"},
        {"0 0 1 0 0 0 0 1 0 0 0 0 1 0 7\n", ":1: expected frame and object, then twelve numbers"},
        {"0 0 1 2 3 0 0 0 0\n", ":1: the quaternion is 0"},
        {"1 0 1 0 0 0 0 1 0 0 0 0 1 0\n", ":1: frame 0 has no pose of object 0"},
        {pose + "99999999 0 1 0 0 0 0 1 0 0 0 0 1 0\n", ":2: a frame is a number below 10000000"},
        {pose + "1 0 1 0 0 0 0 1 0 0 0 0 1 0\n" + pose, ":3: frame 0 follows frame 1; frames must be in order"},
        {pose + pose, ":2: object 0 has two poses in frame 0"},
        {pose + "1 4 1 0 0 0 0 1 0 0 0 0 1 0\n", ":2: frame 0 has no pose of object 4"},
        {"0 2 1 0 0 0 0 1 0 0 0 0 1 0\n", ":1: frame 0 has no pose of object 0"},
        {"0 4000000000 1 0 0 0 0 1 0 0 0 0 1 0\n", ":1: an object is a number below 10000000"},
        {"0 0 1 0 0 1e39 0 1 0 0 0 0 1 0\n", ": frame 0: object 0 lies beyond the range of float"},
    };
    for (const auto& [text, message] : texts) {
        folder.write("m.txt", text);
        check_all(folder, {"contacts", motion, mesh, "--out", folder / "c.csv"}, {{{}, "m.txt" + message}});
    }
}

TEST_CASE_METHOD(with_mesh_file, "contacts and scene reject meshes and options that do not match") {
    const std::string motion = folder.write("m.txt", "0 0 1 0 0 0 0 1 0 0 0 0 1 0\n");
    check_all(folder, {"contacts", motion},
              {
                  {{}, "MESH is required"},
                  {{mesh, mesh}, "moves 1 objects, but there are 2 meshes"},
                  {{mesh, "--engine", "cgal", "--tree", "canonical"},
                   "--engine replaces --build, --tree and --triangle, so give it without them\n"},
                  {{mesh, "--tree", "compresed"}, "did you mean 'compressed'?"},
                  {{mesh, "--geometry"}, "--geometry adds columns to the contacts, so give --out FILE"},
                  {{mesh, "--out", motion}, "m.txt would overwrite "},
                  {{mesh, "--out", mesh}, "a.off would overwrite "},
              });
    check_all(folder, {"scene"},
              {
                  {{"mesh_pair", "--mesh", mesh, "--out", mesh}, "a.off would overwrite "},
                  {{"mesh_pair", "--mesh", mesh, "--picture", mesh}, "a.off would overwrite "},
                  {{"mesh_pair", "--mesh", mesh, "--normalise", "no", "--motion", mesh}, "a.off would overwrite "},
                  {{"brownian", "--motion", folder / "x"}, "brownian is a scene of boxes, which have no poses"},
                  {{"deforming", "--motion", folder / "x"},
                   "deforming deforms its meshes, which the poses that --motion writes"},
                  {{"mesh_pair", "--motion", folder / "x"}, "so give --normalise no with it"},
              });
}

TEST_CASE_METHOD(with_mesh_file, "order rejects invalid options and does not overwrite the mesh that it reads") {
    const std::string sorted = mesh + ":order=median";
    check_all(folder, {"order"},
              {
                  {{mesh}, "--out is required"},
                  {{mesh, "--build", "sha", "--out", folder / "b.off"}, "unknown build 'sha'; did you mean 'sah'?"},
                  {{mesh, "--out", folder / "b.ply"}, "order writes OFF, so --out must end in .off, not '.ply'"},
                  {{mesh, "--out", folder / "b.off", "--numbers", folder / "./b.off"}, "--numbers are the same file"},
                  {{mesh, "--out", mesh}, "a.off would overwrite "},
                  {{sorted, "--out", mesh}, "a.off would overwrite "},
                  {{mesh, "--out", folder / "b.off", "--numbers", mesh}, "a.off would overwrite "},
                  {{sorted, "--out", folder / "b.off", "--numbers", mesh}, "a.off would overwrite "},
              });
    for (const std::string& name : {mesh, sorted})
        check_all(folder, {"collide", name}, {{{"--self", "--out", mesh}, "a.off would overwrite "}});
    CHECK(bytes_of_file(mesh) == tetrahedron);
    run_well({"order", mesh, "--out", folder / "B.OFF"});
}
