/// Reference systems as replacements for our stages, behind plain types: importers see no library header.
export module aabb.engines;

export import aabb.exact_intersection;
import aabb.pipeline;
import aabb.std;

export namespace aabb {

/// A reference system, with its name in configs and tables.
struct engine_info {
    std::string name;
    std::string summary;
    bool searches_boxes;   ///< has a broad phase
    bool collides_meshes;  ///< has a narrow phase
    bool exact;  ///< its pair sets equal the ground truth for all input; otherwise differences are listed by class
};

/// The engines of this build.
[[nodiscard]] std::span<const engine_info> engines();

/// An engine that this build lacks because its library was not found.
struct left_out_engine {
    std::string name;
    std::string library;
};
[[nodiscard]] std::span<const left_out_engine> left_out_engines();

/// Why there is no engine of this name: it was left out, or is unknown (with the nearest name). Empty if there is one.
[[nodiscard]] std::string rejection_of_engine(std::string_view name, std::span<const engine_info> built = engines(),
                                              std::span<const left_out_engine> left_out = left_out_engines());

/// @throws input_error if there is no such engine.
[[nodiscard]] bool is_exact_engine(std::string_view name);

/// The engine as a broad phase. It differs from a composed stage only in speed and counters.
/// @throws input_error if there is no such engine, or it has no broad phase.
[[nodiscard]] std::unique_ptr<global_stage> make_box_engine(std::string_view name);

/// The engine as a narrow phase.
/// @throws input_error if there is no such engine, or it has no narrow phase.
[[nodiscard]] std::unique_ptr<local_stage> make_mesh_engine(std::string_view name);

/// A triangle test of an engine's library; configured like a strategy, but cannot be part of a composition.
struct library_test_info {
    std::string name;
    std::string summary;
    std::string engine;
    bool exact;
    std::vector<parameter_info> parameters;
};

[[nodiscard]] std::span<const library_test_info> library_tests();

/// @throws input_error if there is no such test, or it does not have these settings.
[[nodiscard]] std::unique_ptr<triangle_test> make_library_test(const strategy_choice& choice);

/// Do two closed triangles share a point? By CGAL's exact kernel; zero-area ones count as segments or points.
[[nodiscard]] bool exactly_intersect(const triangle3d& s, const triangle3d& t);
[[nodiscard]] inline bool exactly_intersect(const triangle3f& s, const triangle3f& t) {
    return exactly_intersect(in_double(s), in_double(t));
}
/// The same for triangles of meshes at poses: in world coordinates R v + t, computed exactly.
[[nodiscard]] bool exactly_intersect(const pose_pair& poses, const triangle3d& s, const triangle3d& t);
/// The same by a judge that shares no code with CGAL or a strategy: separating axes in integers of any size.
/// @param s,t finite, as are the poses, whose matrices have full rank
[[nodiscard]] bool intersect_in_integers(const pose_pair& poses, const triangle3d& s, const triangle3d& t);

}  // namespace aabb
