module aabb.extreme;

import :making;

namespace aabb {

namespace {

constexpr float not_a_number = std::numeric_limits<float>::quiet_NaN();
constexpr float infinity = std::numeric_limits<float>::infinity();

/// A scene that must be rejected with this message: a valid frame of 20 boxes, then one in which box 7 is `bad`.
extreme_scene with_box(const char* name, const char* summary, const box& bad, const char* rejection) {
    const auto make = [bad] {
        std::vector<box> boxes(20, {{0, 0, 0}, {1, 1, 1}});
        box_frames frames{boxes, boxes};
        frames[1][7] = bad;
        return frames;
    };
    return rejected(scene_of_boxes(name, summary, make), rejection);
}

/// A scene that must be rejected with this message: a cube, and a copy that `spoil` makes invalid.
template <class Spoil>
extreme_scene with_mesh(const char* name, const char* summary, Spoil spoil, const char* rejection) {
    const auto make = [spoil] {
        mesh bad = cube();
        spoil(bad);
        return posed(std::vector{cube(), bad}, {{{}, {}}});
    };
    return rejected(scene_of_meshes(name, summary, make), rejection);
}

/// @param rejection empty if the pose is valid
extreme_scene with_pose(const char* name, const char* summary, const pose& second, const std::string& rejection = {}) {
    const auto make = [second] { return posed(ball(4, 1), {{{}, second}}); };
    return rejected(scene_of_meshes(name, summary, make), rejection);
}

/// The identity pose with one entry of the rotation replaced.
pose with_entry(std::size_t entry, double value) {
    pose p = shifted(0, 0, 0);
    p.rotation[entry] = value;
    return p;
}

/// A pose that shears, so that an x is larger by `slope` of y.
pose sheared(double slope) {
    pose p = shifted(0.7, 0.2, 0.1);
    p.rotation[1] = slope;
    return p;
}

pose stretched(double scale) {
    pose p = shifted(0.7, 0.2, 0.1);
    for (const std::size_t i : {0, 4, 8}) p.rotation[i] = scale;
    return p;
}

/// Two valid scenes, of boxes and of meshes, that must be rejected since they are computed in this floating-point mode.
std::vector<extreme_scene> computed_in(arithmetic kind, const std::string& name, const std::string& summary,
                                       const std::string& rejection) {
    const auto boxes = [] {
        return box_frames{{{{0, 0, 0}, {1, 1, 1}}, {{1, 1, 1}, {2, 2, 2}}, {{3, 0, 0}, {4, 1, 1}}}};
    };
    const auto meshes = [] { return posed(cube(), {{{}, shifted(1, 1, 1)}}); };
    std::vector<extreme_scene> scenes = {rejected(scene_of_boxes(name + "_boxes", summary, boxes), rejection),
                                         rejected(scene_of_meshes(name + "_meshes", summary, meshes), rejection)};
    for (extreme_scene& scene : scenes) scene.computed_in = kind;
    return scenes;
}

}  // namespace

std::vector<extreme_scene> invalid_box_scenes() {
    return {
        with_box("box_nan", "a NaN coordinate", {{0, not_a_number, 0}, {1, 1, 1}},
                 "box 7 has a coordinate that is not finite"),
        with_box("box_infinite", "an infinite box", {{0, 0, 0}, {1, 1, infinity}},
                 "box 7 has a coordinate that is not finite"),
        with_box("box_inverted", "a minimum above its maximum", {{0, 2, 0}, {1, 1, 1}}, "box 7 is inverted"),
    };
}

/// Scenes of two meshes with a pose or mesh at the limit of what is valid: those with a message must be rejected with
/// it. Poses need not be rotations, so the ones without a message are valid.
std::vector<extreme_scene> invalid_mesh_scenes() {
    extreme_scene beyond_float =
        with_pose("beyond_float", "1e39 from the other mesh, beyond the greatest float", shifted(1e39, 0, 0),
                  "seen from one mesh, the other lies beyond the range of float");
    beyond_float.accepted_in_double = true;
    return {
        with_pose("skewed", "a rotation skewed by a millionth", sheared(1e-6)),
        with_pose("sheared", "a pose that shears", sheared(0.75)),
        with_pose("stretched", "a pose that scales by 1.7", stretched(1.7)),
        with_pose("reflection", "a pose with a reflection", with_entry(8, -1)),
        with_pose("singular", "a pose that flattens", with_entry(8, 0), "object 1: the pose is singular"),
        with_pose("matrix_infinite", "a matrix with an infinite entry", with_entry(4, double{infinity}),
                  "object 1: the pose has a matrix with an entry that is not finite"),
        with_pose("translation_nan", "a NaN translation", shifted(0, double{not_a_number}, 0),
                  "object 1: the pose has a translation that is not finite"),
        beyond_float,
        with_mesh(
            "vertex_nan", "a NaN coordinate", [](mesh& m) { m.vertices[5][1] = not_a_number; },
            "vertex 5 has a coordinate that is not finite"),
        with_mesh(
            "vertex_infinite", "an infinite coordinate", [](mesh& m) { m.vertices[6][2] = -infinity; },
            "vertex 6 has a coordinate that is not finite"),
        with_mesh(
            "no_such_vertex", "a triangle with an invalid vertex index",
            [](mesh& m) { m.triangles[3][1] = static_cast<std::uint32_t>(m.vertices.size()); },
            "triangle 3 uses vertex"),
        with_mesh(
            "no_triangles", "a mesh without triangles", [](mesh& m) { m.triangles.clear(); },
            "the mesh has no triangles"),
    };
}

/// Scenes to be rejected in threads that flush denormals, if this processor can do so, or round upward.
std::vector<extreme_scene> other_arithmetic_scenes() {
    std::vector<extreme_scene> scenes = computed_in(arithmetic::rounded_upward, "upward", "a thread that rounds upward",
                                                    "this thread does not round to nearest");
    if (!can_flush_denormals()) return scenes;
    const std::vector<extreme_scene> flushed =
        computed_in(arithmetic::denormals_flushed, "flushed", "a thread that flushes denormals to zero",
                    "this thread flushes denormal numbers to zero");
    scenes.insert(scenes.begin(), flushed.begin(), flushed.end());
    return scenes;
}

std::vector<extreme_scene> extreme_scenes(extreme_size size) {
    std::vector<extreme_scene> scenes;
    for (const std::vector<extreme_scene>& part :
         {box_scenes(), invalid_box_scenes(), mesh_scenes(size), invalid_mesh_scenes(), other_arithmetic_scenes()})
        scenes.insert(scenes.end(), part.begin(), part.end());
    return scenes;
}

}  // namespace aabb
