#include <sys/stat.h>

#include "mesh_bytes.hpp"

namespace {

using arguments = std::vector<std::string>;
using command_with = std::function<arguments(const std::string& path)>;

/// Valid arguments of every command, but for the path under test.
class command_fixture : public in_folder {
public:
    command_fixture() { run_well(joined(scene_, {"--out", recording_})); }

    /// Commands that read a user's file.
    [[nodiscard]] std::vector<command_with> readers() const {
        return {
            [&](const std::string& path) { return arguments{"pairs", path}; },
            [&](const std::string& path) { return arguments{"collide", path, mesh_}; },
            [&](const std::string& path) { return arguments{"collide", mesh_, path}; },
            [&](const std::string& path) { return arguments{"contacts", path, mesh_}; },
            [&](const std::string& path) { return arguments{"contacts", motion_, path}; },
            [&](const std::string& path) { return arguments{"classify", path}; },
            [&](const std::string& path) { return arguments{"collide", mesh_, mesh_, "--poses", path}; },
            [&](const std::string& path) { return arguments{"compare", path, folder.path()}; },
            [&](const std::string& path) { return arguments{"explain", path}; },
            [&](const std::string& path) { return arguments{"validate", path}; },
            [&](const std::string& path) {
                return arguments{"validate", "extreme", "--cases", path, "--out", folder / "x"};
            },
            [&](const std::string& path) { return arguments{"run", path}; },
            [&](const std::string& path) { return arguments{"reproduce", "--judge", "--out", path}; },
            [&](const std::string& path) {
                return arguments{"scene", "mesh_pair", "--mesh", path, "--out", folder / "x.aabbs"};
            },
            [&](const std::string& path) {
                return arguments{"explain", folder.write("p.toml", config_of("mesh_pair", path))};
            },
        };
    }

    /// Commands that write a file.
    [[nodiscard]] std::vector<command_with> writers() const {
        return {
            [&](const std::string& path) { return arguments{"pairs", recording_, "--out", path}; },
            [&](const std::string& path) { return arguments{"collide", mesh_, mesh_, "--out", path}; },
            [&](const std::string& path) { return arguments{"contacts", motion_, mesh_, "--out", path}; },
            [&](const std::string& path) { return joined(scene_, {"--out", path}); },
            [&](const std::string& path) { return joined(scene_, {"--picture", path}); },
            [&](const std::string& path) {
                return arguments{"scene", "mesh_pair", "--frames", "1",        "--normalise",
                                 "no",    "--mesh",    mesh_,      "--motion", path};
            },
        };
    }

    /// Commands that fill a folder.
    [[nodiscard]] std::vector<command_with> folder_writers() const {
        return {
            [&](const std::string& path) { return arguments{"run", config_, "--out", path}; },
            [&](const std::string& path) { return arguments{"run", config_, "--resume", "--out", path}; },
            [&](const std::string& path) { return arguments{"reproduce", "--quick", "--out", path}; },
        };
    }

    [[nodiscard]] static std::string config_of(const std::string& kind, const std::string& mesh) {
        return "name = \"c\"\n[[scene]]\nkind = \"" + kind + "\"\nframes = 1\n" +
               (kind == "brownian" ? "objects = 20" : "meshes = [\"" + mesh + "\"]") + "\n[measure]\nrepeats = 1\n";
    }

private:
    std::string mesh_ = folder.write("a.off", tetrahedron);
    std::string motion_ = folder.write("m.txt", "0 0 1 0 0 0 0 1 0 0 0 0 1 0\n");
    std::string config_ = folder.write("c.toml", config_of("brownian", ""));
    std::string recording_ = folder / "s.aabbs";
    const arguments scene_ = {"scene", "brownian", "--n", "20", "--frames", "1"};
};

void require_rejected(const arguments& command, const std::string& path) {
    check_refused(command, {{{}, path}});
}

}  // namespace

TEST_CASE_METHOD(command_fixture, "Every command rejects an unusable path in one sentence that names it") {
    std::filesystem::create_directory(folder / "folder.off");
    std::filesystem::create_symlink("absent", folder / "dangling");
    std::filesystem::create_symlink("loop", folder / "loop");
    const std::string too_long(300, 'n');
    std::vector<std::string> unreadable = {repeated("long/", 1000) + "n"};
    std::vector<std::string> unwritable = {unreadable[0], "/proc/self/b"};
    for (const std::string& name : {too_long, std::string("a.off/b"), std::string("loop"), std::string("loop/b")})
        for (auto* paths : {&unreadable, &unwritable}) paths->push_back(folder / name);
    for (const char* name : {"absent", "dangling"}) unreadable.push_back(folder / name);
    for (const command_with& command : readers())
        for (const std::string& path : unreadable) require_rejected(command(path), path);
    for (const std::string& path : unwritable) {
        for (const command_with& command : writers()) require_rejected(command(path), path);
        for (const command_with& command : folder_writers()) require_rejected(command(path), path);
    }
    for (const command_with& command : writers()) {
        for (const std::filesystem::path& path : {folder / "folder.off", folder / "absent" / "b", folder / "dangling"})
            require_rejected(command(path), path);
        require_rejected(command(""), "");
    }
    for (const command_with& command : folder_writers()) {
        require_rejected(command(folder / "a.off"), "a.off");
        require_rejected(command(""), "");
    }
    for (const command_with& command : readers()) {
        require_rejected(command(folder / "folder.off"), "folder.off");
        require_rejected(command(""), "");
    }
}

TEST_CASE_METHOD(command_fixture, "A pipe or device in place of a file is rejected without blocking") {
    const std::string pipe = folder / "pipe.off";
    REQUIRE(mkfifo(pipe.c_str(), 0600) == 0);
    for (const std::string& path : {pipe, std::string("/dev/null")})
        for (const arguments& command : {arguments{"pairs", path},
                                         {"collide", path, "icosphere"},
                                         {"contacts", path, "icosphere"},
                                         {"compare", path, path},
                                         {"scene", "mesh_pair", "--mesh", path, "--out", folder / "x"}})
            require_rejected(command, path);
}

TEST_CASE_METHOD(command_fixture, "A named pipe without a writer is rejected") {
    const std::string pipe = folder / "pipe.toml";
    REQUIRE(mkfifo(pipe.c_str(), 0600) == 0);
    const std::string mesh = folder / "a.off";
    for (const arguments& command :
         {arguments{"classify", pipe}, {"run", pipe}, {"collide", mesh, mesh, "--poses", pipe}}) {
        require_rejected(command, pipe);
        CHECK(run_program(command).err.ends_with("pipe.toml: is a named pipe with no writer\n"));
    }
    for (const char* command : {"reproduce", "atlas"}) {
        const program_result rejected = run_program({command, "--judge", pipe, "--out", folder / "judged"});
        CHECK(rejected.status == 2);
        CHECK(rejected.err.ends_with("pipe.toml is not a regular file\n"));
    }
    // Every command reads the costs at its start, and must not block on a pipe.
    const std::filesystem::path costs = folder / "aabblab/costs.toml";
    std::filesystem::create_directory(folder / "aabblab");
    REQUIRE(mkfifo(costs.c_str(), 0600) == 0);
    const program_result listed =
        as_refused(run_command({"env", "XDG_CONFIG_HOME=" + folder.path().string(), AABBLAB_UNDER_TEST, "list"}));
    CHECK(holds(listed.err, "costs.toml: is not a regular file; aabblab calibrate --reset removes it"));
}

TEST_CASE_METHOD(command_fixture, "A pipe is read like a file, however late its writer starts") {
    const std::string pipe = folder / "pipe.txt";
    REQUIRE(mkfifo(pipe.c_str(), 0600) == 0);
    const auto shell = [&](const std::string& line) {
        return run_command({"bash", "-c", line, AABBLAB_UNDER_TEST, pipe, folder / "a.off"});
    };
    const std::string pair = "echo 0 0 0 1 0 0 0 1 0 .2 .2 -1 .2 .2 1 .3 .3 1";
    CHECK(shell("(sleep 0.5; " + pair + " > \"$1\") & \"$0\" classify \"$1\"").out == "1\n");
    CHECK(shell("(" + pair + " > \"$1\") & \"$0\" classify \"$1\"").out == "1\n");
    CHECK(shell("(sleep 0.2; " + pair + "; sleep 0.2; " + pair + ") | \"$0\" classify -").out == "1\n1\n");
    CHECK(shell("\"$0\" classify <(sleep 0.2; " + pair + ")").out == "1\n");
    const program_result no_input = shell("\"$0\" classify <(true)");
    CHECK(no_input.status == 0);
    CHECK(no_input.out.empty());
    CHECK(shell("\"$0\" collide \"$2\" \"$2\" --poses <(echo 1 0 0 0 0 1 0 0 0 0 1 0)").status == 0);
}

TEST_CASE_METHOD(command_fixture, "An unreadable file is rejected in one sentence") {
    const std::string unreadable = folder / "unreadable.toml";
    std::filesystem::create_symlink("/proc/self/mem", unreadable);
    const std::string mesh = folder / "a.off";
    for (const arguments& command : {arguments{"classify", unreadable},
                                     {"run", unreadable},
                                     {"validate", unreadable},
                                     {"collide", mesh, mesh, "--poses", unreadable}})
        require_rejected(command, "unreadable.toml");
}

TEST_CASE_METHOD(command_fixture, "A folder in place of a results file is rejected in one sentence") {
    const std::string config = folder / "c.toml";
    const std::string out = folder / "out";
    run_well({"run", config, "--out", out});
    for (const std::string name : {"results.csv", "manifest.json", "differences.csv"}) {
        INFO(name);
        const std::filesystem::path file = std::filesystem::path(out) / name;
        const std::filesystem::path backup = folder / "aside";
        const bool existed = std::filesystem::exists(file);
        if (existed) std::filesystem::rename(file, backup);
        std::filesystem::create_directory(file);
        require_rejected({"run", config, "--resume", "--out", out}, name);
        if (name == "manifest.json") require_rejected({"compare", out, out}, name);
        std::filesystem::remove(file);
        if (existed) std::filesystem::rename(backup, file);
    }
}

TEST_CASE_METHOD(command_fixture, "File names that are not UTF-8 work, and their bytes are shown escaped") {
    const std::string out = folder / "x\xff";
    for (const command_with& command : writers()) {
        run_well(command(out));
        CHECK(std::filesystem::is_regular_file(out));
        std::filesystem::remove(out);
    }
    const std::string mesh = folder.write("m\xff.off", tetrahedron);
    run_well({"collide", mesh, mesh, "--json"});
    CHECK(holds(run_program({"collide", mesh, mesh}).out, "m\\xff.off (4 triangles)"));
    const std::string picture = folder / "p.svg";
    run_well({"scene", "mesh_pair", "--frames", "1", "--mesh", mesh, "--picture", picture});
    CHECK(holds(bytes_of_file(picture), "m\\xff.off"));

    const std::string config = folder.write("c\xff.toml", config_of("brownian", ""));
    run_well({"run", config, "--out", folder / "r\xff"});
    CHECK(holds(bytes_of_file(folder / "r\xff/manifest.json"), "\"file\": \"c\xef\xbf\xbd.toml\""));
    run_well({"run", config, "--resume", "--out", folder / "r\xff"});
    run_well({"compare", folder / "r\xff", folder / "r\xff"});
    require_rejected({"pairs", folder / "absent\xff"}, "/absent\\xff: no such file");
}

TEST_CASE_METHOD(command_fixture, "Control characters in names and files are shown escaped") {
    const std::string name = "a\x1b[31m\nb\x7f\xc2\x9bz\xc3\xa9.off";  // the last letter is é
    const std::string shown = "a\\x1b[31m\\x0ab\\x7f\\xc2\\x9bz\xc3\xa9.off";
    std::vector<command_with> reading = readers();
    reading.pop_back();  // TOML cannot contain such names unescaped
    for (const command_with& command : reading) require_rejected(command(folder / name), shown);
    require_rejected({"collide", folder.write("b.off", "OFF\n\x1b[2J 1 0\n"), "icosphere"}, "found '\\x1b[2J'");
    require_rejected({"explain", folder.write("c.toml", config_of("mesh_pair", "x\\u001b\\n.off"))},
                     "'x\\x1b\\x0a.off'");

    const std::string mesh = folder.write(name, tetrahedron);
    const arguments printed[] = {{"collide", mesh, mesh},
                                 {"scene", "mesh_pair", "--frames", "1", "--mesh", mesh, "--out", folder / name},
                                 {"contacts", folder.write("\x1b.txt", "0 0 1 0 0 0 0 1 0 0 0 0 1 0\n"), mesh}};
    CHECK(holds(run_program(printed[0]).out, shown + " (4 triangles) against"));
    CHECK(holds(run_program(printed[2]).out, "/\\x1b.txt: 1 object, "));
    require_rejected(printed[1], shown);  // it would overwrite the mesh
}
