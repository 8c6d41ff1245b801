module;
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

module aabb.validation;

import aabb;
import :parts;

namespace aabb {

namespace {

struct engine {
    engine_info info;
    std::unique_ptr<global_stage> (*boxes)();
    std::unique_ptr<local_stage> (*meshes)();
};

const std::vector<engine>& all_engines() {
    static const std::vector<engine> all = {
        {{"brute_force", "every pair of boxes; every pair of triangles whose boxes overlap, in CGAL's exact kernel",
          true, true, true},
         make_brute_force_boxes,
         [] { return make_pairwise_engine(candidates_by_double_loop, exactly_intersect); }},
        {{"cgal", "CGAL's intersection of box sequences, and its exact kernel for triangles", true, true, true},
         make_cgal_boxes,
         [] { return make_pairwise_engine(candidates_by_cgal, exactly_intersect); }},
        {{"fcl", "FCL's dynamic AABB tree for boxes, and its trees of oriented boxes in double for meshes", true, true,
          false},
         make_fcl_boxes,
         make_fcl_meshes},
        {{"libccd",
          "libccd's GJK in double on triangles whose boxes overlap; its tolerances are absolute, so small scales go "
          "wrong",
          false, true, false},
         nullptr,
         [] { return make_pairwise_engine(candidates_by_cgal, gjk_intersect); }}};
    return all;
}

/// @throws input_error on a name nobody knows.
const engine& engine_named(std::string_view name) {
    std::vector<std::string> names;
    for (const engine& e : all_engines()) {
        if (e.info.name == name) return e;
        names.push_back(e.info.name);
    }
    throw input_error(unknown_name("engine", name, names));
}

}  // namespace

std::span<const engine_info> engines() {
    static const std::vector<engine_info> infos = [] {
        std::vector<engine_info> all;
        for (const engine& e : all_engines()) all.push_back(e.info);
        return all;
    }();
    return infos;
}

bool is_exact_engine(std::string_view name) {
    return engine_named(name).info.exact;
}

std::unique_ptr<global_stage> make_box_engine(std::string_view name) {
    const engine& found = engine_named(name);
    if (!found.boxes)
        throw input_error("the engine '" + found.info.name +
                          "' has no broad phase, so it cannot search boxes; it only collides meshes");
    return found.boxes();
}

std::unique_ptr<local_stage> make_mesh_engine(std::string_view name) {
    const engine& found = engine_named(name);
    return found.meshes();
}

}  // namespace aabb
