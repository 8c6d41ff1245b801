module aabb.engines;

import :engine;

namespace aabb {

namespace {

const std::vector<engine>& all_engines() {
    static const std::vector<engine> all = built_engines();
    return all;
}

/// @throws input_error where there is none of this name.
const engine& engine_named(std::string_view name) {
    const auto found = std::ranges::find(all_engines(), name, &engine::name);
    if (found == all_engines().end()) throw input_error(refusal_of_engine(name));
    return *found;
}

}  // namespace

std::span<const engine_info> engines() {
    static const std::vector<engine_info> infos = [] {
        std::vector<engine_info> all;
        for (const engine& e : all_engines())
            all.push_back({e.name, e.summary, e.boxes != nullptr, e.meshes != nullptr, e.exact});
        return all;
    }();
    return infos;
}

std::span<const library_test_info> library_tests() {
    static const std::vector<library_test_info> infos = [] {
        std::vector<library_test_info> all;
        for (const engine& e : all_engines())
            for (const library_test& t : e.triangles) all.push_back({t.name, t.summary, e.name, t.exact, t.parameters});
        return all;
    }();
    return infos;
}

std::unique_ptr<triangle_test> make_library_test(const strategy_choice& choice) {
    std::vector<std::string> names;
    for (const engine& e : all_engines())
        for (const library_test& t : e.triangles) {
            if (t.name == choice.name) return t.make(choice.settings);
            names.push_back(t.name);
        }
    throw input_error(unknown_name("triangle test", choice.name, names));
}

std::string refusal_of_engine(std::string_view name, std::span<const engine_info> built,
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
    const engine& found = engine_named(name);
    if (!found.boxes)
        throw input_error("the engine '" + found.name +
                          "' has no broad phase, so it cannot search boxes; it only collides meshes");
    return found.boxes();
}

std::unique_ptr<local_stage> make_mesh_engine(std::string_view name) {
    const engine& found = engine_named(name);
    if (!found.meshes)
        throw input_error("the engine '" + found.name +
                          "' has no narrow phase, so it cannot collide meshes; it only searches boxes");
    return found.meshes();
}

}  // namespace aabb
