module aabb.engines;

import :engine;

namespace aabb {

namespace {

const std::vector<engine>& all_engines() {
    static const std::vector<engine> engines_of_build = built_engines();
    return engines_of_build;
}

/// @throws input_error if there is no such engine.
const engine& engine_named(std::string_view name) {
    const auto position = std::ranges::find(all_engines(), name, &engine::name);
    if (position == all_engines().end()) throw input_error(rejection_of_engine(name));
    return *position;
}

}  // namespace

/// What users may know of the engines in this build, without the functions that make them.
std::span<const engine_info> engines() {
    static const std::vector<engine_info> infos = [] {
        std::vector<engine_info> list;
        for (const engine& e : all_engines())
            list.push_back({e.name, e.summary, e.boxes != nullptr, e.meshes != nullptr, e.exact});
        return list;
    }();
    return infos;
}

/// The triangle tests of the engines' libraries, each with the name of its engine.
std::span<const library_test_info> library_tests() {
    static const std::vector<library_test_info> infos = [] {
        std::vector<library_test_info> list;
        for (const engine& e : all_engines())
            for (const library_test& t : e.triangles)
                list.push_back({t.name, t.summary, e.name, t.exact, t.parameters});
        return list;
    }();
    return infos;
}

/// Makes the test of this name with these settings; an unknown name is rejected with the nearest one.
std::unique_ptr<triangle_test> make_library_test(const strategy_choice& choice) {
    std::vector<std::string> names;
    for (const engine& e : all_engines())
        for (const library_test& t : e.triangles) {
            if (t.name == choice.name) return t.make(choice.settings);
            names.push_back(t.name);
        }
    throw input_error(unknown_name("triangle test", choice.name, names));
}

/// Empty if the engine is built; otherwise says that it was left out, or that its name is unknown.
std::string rejection_of_engine(std::string_view name, std::span<const engine_info> built,
                                std::span<const left_out_engine> left_out) {
    std::vector<std::string> names;
    for (const engine_info& e : built) {
        if (e.name == name) return {};
        names.push_back(e.name);
    }
    for (const left_out_engine& e : left_out) {
        if (e.name == name) return "the engine '" + e.name + "' is not in this build: " + e.library + " was not found";
        names.push_back(e.name);
    }
    return unknown_name("engine", name, names, "aabblab list engines");
}

bool is_exact_engine(std::string_view name) {
    return engine_named(name).exact;
}

std::unique_ptr<global_stage> make_box_engine(std::string_view name) {
    const engine& e = engine_named(name);
    if (e.boxes) return e.boxes();
    throw input_error("the engine '" + e.name +
                      "' has no broad phase, so it cannot search boxes; it only collides meshes");
}

std::unique_ptr<local_stage> make_mesh_engine(std::string_view name) {
    const engine& e = engine_named(name);
    if (e.meshes) return e.meshes();
    throw input_error("the engine '" + e.name +
                      "' has no narrow phase, so it cannot collide meshes; it only searches boxes");
}

}  // namespace aabb
