/// Reference systems in place of our pipeline. Behind plain types: no header of any library reaches an importer.
export module aabb.engines;

export import aabb.exact_intersection;
import aabb.pipeline;
import aabb.std;

export namespace aabb {

/// A whole reference system, by the name it has in configs and tables.
struct engine_info {
    std::string name;
    std::string summary;
    bool searches_boxes;   ///< can stand in for global search
    bool collides_meshes;  ///< can stand in for local detection
    bool exact;  ///< its pair sets equal the exact ones on every input; others' differences are listed by class
};

/// Those of this build.
[[nodiscard]] std::span<const engine_info> engines();

/// An engine that this build lacks, because its library was not there.
struct left_out_engine {
    std::string name;
    std::string library;
};
[[nodiscard]] std::span<const left_out_engine> left_out_engines();

/// Why there is no engine of this name: it was left out, or nobody knows it, which names the nearest. Empty where there
/// is one.
[[nodiscard]] std::string refusal_of_engine(std::string_view name, std::span<const engine_info> built = engines(),
                                            std::span<const left_out_engine> left_out = left_out_engines());

/// Whether this engine is exact.
/// @throws input_error where there is none of this name.
[[nodiscard]] bool is_exact_engine(std::string_view name);

/// The engine in place of a global search. Differs from a composed stage in nothing but speed and counters.
/// @throws input_error where there is none of this name, or it has no broad phase.
[[nodiscard]] std::unique_ptr<global_stage> make_box_engine(std::string_view name);

/// The engine in place of a local detection.
/// @throws input_error where there is none of this name, or it has no narrow phase.
[[nodiscard]] std::unique_ptr<local_stage> make_mesh_engine(std::string_view name);

/// A triangle test of an engine's library. It is chosen and configured like a strategy of the kind triangle, but is no
/// part of a composition.
struct library_test_info {
    std::string name;
    std::string summary;
    std::string engine;
    bool exact;
    std::vector<parameter_info> parameters;
};

[[nodiscard]] std::span<const library_test_info> library_tests();

/// @throws input_error where there is none of this name, and on settings that it has not.
[[nodiscard]] std::unique_ptr<triangle_test> make_library_test(const strategy_choice& choice);

/// Do two closed triangles share a point? By CGAL's exact kernel; zero-area ones as the segments or points they are.
[[nodiscard]] bool exactly_intersect(const triangle3f& s, const triangle3f& t);
[[nodiscard]] bool exactly_intersect(const triangle3d& s, const triangle3d& t);

}  // namespace aabb
