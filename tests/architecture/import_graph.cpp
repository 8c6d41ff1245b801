#include <regex>

#include "../experiments/temporary_folder.hpp"

namespace {

/// The rooms in import order: each may import itself and those before it in this list.
const std::vector<std::string> rooms = {
    "modules/std",
    "modules/base",
    "modules/simd",
    "modules/counters",
    "modules/costs",
    "modules/policy",
    "modules/geometry",
    "modules/eigen",
    "modules/digest",
    "modules/global_search",
    "modules/distance_stage",
    "modules/local_detection",
    "modules/containment",
    "modules/pipeline",
    "modules/collision_filter",
    "strategies/segment_trees",
    "strategies/columns",
    "strategies/split_mesh",
    "strategies/wide_tree",
    "strategies/prepare",
    "strategies/sort",
    "strategies/partition",
    "strategies/sweep",
    "strategies/build",
    "strategies/tree",
    "strategies/triangle",
    "strategies/distance",
    "strategies/touching",
    "strategies/registry",
    "strategies/selection",
    "validation/engines",
    "validation/truth",
    "validation/extreme",
    "validation",
    "experiments/support",
    "experiments/files",
    "experiments/stepping",
    "experiments/scenes",
    "experiments/filters",
    "experiments/inputs",
    "experiments/results",
    "experiments/analysis/statistics",
    "experiments/analysis/metrics",
    "experiments/analysis/figures",
    "experiments/analysis/tables",
    "experiments/analysis/comparison",
    "experiments/analysis/conditions",
    "experiments/page",
    "experiments/configs",
    "experiments/trials",
    "experiments/queries",
    "experiments/checking",
    "experiments/measures",
    "experiments/race",
    "experiments/calibrate",
    "experiments/atlas",
    "experiments/errors",
    "experiments/stiff",
    "experiments/extreme",
    "experiments/suites",
    "experiments/explain",
    "experiments/benchmarks",
    "paper/claims",
    "paper/record",
    "paper/reproduce",
    "paper/measuring",
    "experiments/commands",
    "experiments",
    "modules",  // the module aabb, which is for users: nothing here imports the core whole
};

struct dependency {
    std::string from, to;  ///< rooms
    std::string file, module;
};

/// Rooms that expose one module, of their own name, and hide all others.
const std::set<std::string> hiding_rooms = {"strategies/columns",    "strategies/distance", "strategies/segment_trees",
                                            "strategies/split_mesh", "strategies/touching", "strategies/wide_tree"};

/// Whether the module is one that its room hides.
bool is_hidden(const dependency& d) {
    return hiding_rooms.contains(d.to) && d.module != "aabb." + d.to.substr(d.to.rfind('/') + 1);
}

/// Whether a dependency is forbidden although it follows the order of the rooms.
bool is_forbidden(const dependency& d) {
    const auto is_kind = [](const std::string& room) {
        return room.starts_with("strategies/") && room != "strategies/registry" && room != "strategies/selection" &&
               !hiding_rooms.contains(room);
    };
    const bool to_paper = d.to.starts_with("paper");
    // Other commands than `reproduce` read results that it has sealed.
    const bool knows_paper =
        d.file == "experiments/commands/reproduce.cpp" || (d.from == "experiments/commands" && d.to == "paper/record");
    const bool judges = d.from.starts_with("paper") && d.from != "paper/measuring";
    // Strategies of different kinds know nothing of each other, and configs nothing of results; one command knows the
    // paper, which measures in one room and reads results through their analysis in all others.
    return (is_kind(d.from) && is_kind(d.to)) || is_hidden(d) ||
           (d.from.starts_with("experiments") && to_paper && !knows_paper) ||
           (d.from == "experiments/configs" && d.to == "experiments/results") ||
           (judges && (d.to == "experiments/trials" || d.to == "experiments/configs" || d.to == "experiments/results"));
}

/// The room of a file: the longest name that its path begins with.
std::string room_of(const std::string& file) {
    std::string best;
    for (const std::string& room : rooms)
        if (file.starts_with(room + "/") && room.size() > best.size()) best = room;
    return best;
}

constexpr std::array folders{"modules", "strategies", "validation", "experiments", "paper"};

struct source {
    std::string file;
    std::string module;  ///< empty for a partition
    bool is_interface = false;
    std::vector<std::string> imports;
};

/// The module declarations and imports of the sources in a folder.
/// @param root the folder that file names are relative to
std::vector<source> sources_in(const std::filesystem::path& folder, const std::filesystem::path& root) {
    static const std::regex declaration(R"(^(export )?module ([a-z_.0-9]+);)");
    static const std::regex import_line(R"(^(?:export )?import ([a-z_.0-9:]+);)");
    std::vector<source> sources;
    for (const auto& entry : std::filesystem::recursive_directory_iterator(folder)) {
        const std::string ending = entry.path().extension().string();
        if (ending != ".cpp" && ending != ".cppm" && ending != ".hpp") continue;
        source& unit = sources.emplace_back();
        unit.file = std::filesystem::relative(entry.path(), root).generic_string();
        std::smatch match;
        std::ifstream in(entry.path());
        for (std::string line; std::getline(in, line);) {
            if (std::regex_search(line, match, declaration)) {
                unit.module = match[2];
                unit.is_interface = match[1].matched;
            }
            if (std::regex_search(line, match, import_line)) unit.imports.push_back(match[1]);
        }
    }
    std::ranges::sort(sources, {}, &source::file);
    return sources;
}

/// The dependencies of files on rooms, each once.
std::vector<dependency> dependencies_in(const std::filesystem::path& root) {
    std::map<std::string, std::string> home{{"aabb.strategies", "strategies/registry/strategies.cppm.in"}};
    std::vector<source> sources;
    for (const char* folder : folders)
        if (std::filesystem::exists(root / folder))
            for (const source& unit : sources_in(root / folder, root)) {
                if (unit.is_interface) home[unit.module] = unit.file;
                sources.push_back(unit);
            }
    std::vector<dependency> dependencies;
    std::set<std::pair<std::string, std::string>> known;
    for (const source& importing : sources)
        for (const std::string& module : importing.imports) {
            if (module.starts_with(':')) continue;
            const std::string& file = importing.file;
            INFO(file << " imports " << module);
            REQUIRE(home.contains(module));
            const dependency d{room_of(file), room_of(home.at(module)), file, module};
            REQUIRE(!d.from.empty());
            if (d.from != d.to && (known.emplace(file, d.to).second || is_hidden(d))) dependencies.push_back(d);
        }
    return dependencies;
}

/// Imports that repeat those of the interface of an implementation unit: a line "FILE imports MODULE" for each.
std::string repeated_imports(const std::filesystem::path& root) {
    const std::vector<source> sources = sources_in(root, root);
    std::map<std::string, std::set<std::string>> of_interface;  // by module
    for (const source& unit : sources)
        if (unit.is_interface) of_interface[unit.module].insert(unit.imports.begin(), unit.imports.end());
    std::string text;
    for (const source& unit : sources)
        for (const std::string& imported : unit.imports)
            if (!unit.is_interface && of_interface[unit.module].contains(imported))
                text += unit.file + " imports " + imported + "\n";
    return text;
}

/// Dependencies against the order: a line "experiments/trials -> paper/claims: FILE imports MODULE" for each.
std::string backward_dependencies(const std::vector<dependency>& dependencies) {
    std::string text;
    for (const dependency& d : dependencies)
        if (std::ranges::find(rooms, d.from) < std::ranges::find(rooms, d.to) || is_forbidden(d))
            text += d.from + " -> " + d.to + ": " + d.file + " imports " + d.module + "\n";
    return text;
}

/// Each room with the rooms that it imports, in import order.
std::string drawing_of(const std::vector<dependency>& dependencies) {
    std::string text;
    for (const std::string& room : rooms) {
        std::set<std::string> below;
        for (const dependency& d : dependencies)
            if (d.from == room) below.insert(d.to);
        text += room + (below.empty() ? "" : " <-");
        for (const std::string& other : below) text += " " + other;
        text += "\n";
    }
    return text;
}

}  // namespace

TEST_CASE("No room imports a room that follows it") {
    const std::vector<dependency> dependencies = dependencies_in(AABBLAB_SOURCE);
    std::ofstream(AABBLAB_DRAWING) << drawing_of(dependencies);
    REQUIRE(dependencies.size() > 40);
    CHECK(backward_dependencies(dependencies) == "");
}

TEST_CASE_METHOD(in_folder, "No implementation unit repeats an import of its interface") {
    for (const char* part : folders) CHECK(repeated_imports(std::filesystem::path(AABBLAB_SOURCE) / part) == "");
    std::ofstream(folder / "a.cppm") << "export module a;\nimport b;\nexport import :c;\n";
    std::ofstream(folder / "a.cpp") << "module a;\nimport :c;\nimport b;\nimport d;\n";
    CHECK(repeated_imports(folder.path()) == "a.cpp imports :c\na.cpp imports b\n");
}

TEST_CASE_METHOD(in_folder, "Imports against the order of the rooms are detected") {
    const auto write = [&](const std::string& file, const std::string& text) {
        const std::filesystem::path path = folder.path() / file;
        std::filesystem::create_directories(path.parent_path());
        std::ofstream(path) << text;
    };
    const auto back = [&] { return backward_dependencies(dependencies_in(folder.path())); };
    write("modules/geometry/geometry.cppm", "export module aabb.geometry;\n");
    write("strategies/sort/a.cppm", "export module aabb.sort.a;\nimport aabb.geometry;\n");
    write("strategies/tree/b.cppm", "export module aabb.tree.b;\nimport aabb.geometry;\n");
    write("paper/claims/claims.cppm", "export module aabblab.claims;\nimport aabb.geometry;\n");
    CHECK(back().empty());
    CHECK(holds(drawing_of(dependencies_in(folder.path())), "strategies/sort <- modules/geometry\n"));
    write("modules/geometry/mesh.cpp", "module aabb.geometry;\nimport aabb.sort.a;\n");
    CHECK(back() == "modules/geometry -> strategies/sort: modules/geometry/mesh.cpp imports aabb.sort.a\n");
    write("modules/geometry/mesh.cpp", "module aabb.geometry;\n");
    write("strategies/tree/b.cppm", "export module aabb.tree.b;\nimport aabb.sort.a;\n");
    CHECK(back().starts_with("strategies/tree -> strategies/sort: "));
    write("strategies/wide_tree/wide_tree.cppm",
          "export module aabb.wide_tree;\nexport import aabb.wide_tree.inner;\n");
    write("strategies/wide_tree/inner.cppm", "export module aabb.wide_tree.inner;\n");
    write("strategies/tree/b.cppm", "export module aabb.tree.b;\nimport aabb.wide_tree;\n");
    CHECK(back().empty());
    write("strategies/tree/b.cppm",
          "export module aabb.tree.b;\nimport aabb.wide_tree;\nimport aabb.wide_tree.inner;\n");
    CHECK(back() == "strategies/tree -> strategies/wide_tree: strategies/tree/b.cppm imports aabb.wide_tree.inner\n");
    write("strategies/tree/b.cppm", "export module aabb.tree.b;\n");
    write("experiments/analysis/tables/t.cpp", "import aabblab.claims;\n");
    CHECK(back().starts_with("experiments/analysis/tables -> paper/claims: "));
    write("modules/aabb.cppm", "export module aabb;\nexport import aabb.geometry;\n");
    write("experiments/analysis/tables/t.cpp", "import aabb;\n");
    CHECK(back().starts_with("experiments/analysis/tables -> modules: "));
    write("experiments/analysis/tables/t.cpp", "");
    write("experiments/commands/reproduce.cpp", "import aabblab.claims;\n");
    CHECK(back().empty());
    write("paper/record/record.cppm", "export module aabblab.record;\n");
    write("experiments/configs/configs.cppm", "export module aabblab.configs;\n");
    write("paper/measuring/measure.cpp", "import aabblab.configs;\nimport aabblab.claims;\n");
    write("experiments/commands/compare.cpp", "import aabblab.record;\n");
    CHECK(back().empty());
    write("experiments/results/results.cppm", "export module aabblab.results;\n");
    write("experiments/configs/costs.cpp", "import aabblab.results;\n");
    CHECK(back().starts_with("experiments/configs -> experiments/results: "));
    write("experiments/configs/costs.cpp", "");
    write("paper/claims/c1.cpp", "import aabblab.configs;\n");
    CHECK(back().starts_with("paper/claims -> experiments/configs: "));
    write("paper/claims/c1.cpp", "");
    write("experiments/commands/scene.cpp", "import aabblab.claims;\n");
    CHECK(back().starts_with("experiments/commands -> paper/claims: "));
}
